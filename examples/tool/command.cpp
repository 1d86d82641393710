#include "command.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace innersphere::tool {
namespace {

std::string shown(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

bool holds(const Range& range, double value) {
  return std::isfinite(value) && value <= range.high &&
         (range.above_low ? value > range.low : value >= range.low);
}

std::string describe(const Range& range) {
  if (std::isfinite(range.high)) return " from " + shown(range.low) + " to " + shown(range.high);
  if (std::isfinite(range.low)) return (range.above_low ? " above " : " of at least ") + shown(range.low);
  return "";
}

// Reads a number from all of a text.
template <typename T>
bool parse(const std::string& text, T& value) {
  const char* end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, value);
  return failure == std::errc() && stop == end;
}

// Reads a whole number, also from "1e4", "10k" or "1.5M".
bool parseCount(std::string text, std::uint64_t& value) {
  if (parse(text, value)) return true;
  double factor = 1;
  if (!text.empty() && (text.back() == 'k' || text.back() == 'M')) {
    factor = text.back() == 'k' ? 1e3 : 1e6;
    text.pop_back();
  }
  constexpr double kExact = 9007199254740992;  // 2^53: larger ones have gaps
  double number = 0;
  if (!parse(text, number)) return false;
  number *= factor;
  if (!(number >= 0 && number <= kExact) || number != std::round(number)) return false;
  value = static_cast<std::uint64_t>(number);
  return true;
}

template <typename T>
std::function<std::string(const std::string&)> takeCount(T& value, const Range& range) {
  return [&value, range](const std::string& text) -> std::string {
    std::uint64_t number = 0;
    if (!parseCount(text, number) || !holds(range, static_cast<double>(number)) ||
        number > static_cast<std::uint64_t>(std::numeric_limits<T>::max())) {
      return text + " is not a whole number" + describe(range) + ", such as 10000, 1e4 or 10k";
    }
    value = static_cast<T>(number);
    return {};
  };
}

}  // namespace

std::vector<std::string> Option::spellings() const {
  std::vector<std::string> result;
  if (isArgument()) return result;
  for (std::size_t begin = 0; begin < name.size();) {
    const std::size_t end = std::min(name.find(',', begin), name.size());
    result.push_back(name.substr(begin, end - begin));
    begin = end + 1;
  }
  return result;
}

Option& Option::withDefault(const std::string& text) {
  default_text = text;
  return *this;
}

Option& Option::withFile() {
  takes_file = true;
  return *this;
}

Option& Option::withSuggestions(std::vector<std::string> names) {
  choices = std::move(names);
  return *this;
}

Option& Option::oneOf(std::vector<std::string> names) {
  only_choices = true;
  return withSuggestions(std::move(names));
}

Command::Command(std::string name_, std::string description_)
    : name(std::move(name_)), description(std::move(description_)) {}

Option& Command::add(const std::string& option, const std::string& value_name, const std::string& text) {
  Option& added = options.emplace_back();
  added.name = option;
  added.value_name = value_name;
  added.description = text;
  return added;
}

Option& Command::argument(const std::string& option, std::string& value, const std::string& text) {
  Option& added = this->text(option, value, text);
  added.required = true;
  return added;
}

Option& Command::arguments(const std::string& option, std::vector<std::string>& values,
                           const std::string& text) {
  return texts(option, values, text);
}

Option& Command::flag(const std::string& option, bool& value, const std::string& text) {
  Option& added = add(option, "", text);
  added.take = [&value](const std::string&) {
    value = true;
    return std::string();
  };
  return added;
}

Option& Command::text(const std::string& option, std::string& value, const std::string& text) {
  Option& added = add(option, "TEXT", text);
  added.default_text = value;
  added.take = [&value](const std::string& given) {
    value = given;
    return std::string();
  };
  return added;
}

Option& Command::texts(const std::string& option, std::vector<std::string>& values, const std::string& text) {
  Option& added = add(option, "TEXT", text);
  added.repeated = true;
  for (const std::string& value : values) {
    added.default_text += (added.default_text.empty() ? "" : " ") + value;
  }
  // The first one given takes the place of the defaults.
  added.take = [&values, given_before = false](const std::string& given) mutable {
    if (!given_before) values.clear();
    given_before = true;
    values.push_back(given);
    return std::string();
  };
  return added;
}

Option& Command::number(const std::string& option, double& value, Range range, const std::string& text) {
  Option& added = add(option, "NUMBER", text);
  added.default_text = shown(value);
  added.take = [&value, range](const std::string& given) -> std::string {
    double parsed = 0;
    if (!parse(given, parsed) || !holds(range, parsed)) return given + " is not a number" + describe(range);
    value = parsed;
    return {};
  };
  return added;
}

Option& Command::count(const std::string& option, std::uint64_t& value, Range range,
                       const std::string& text) {
  Option& added = add(option, "COUNT", text);
  added.default_text = std::to_string(value);
  added.take = takeCount(value, range);
  return added;
}

Option& Command::count(const std::string& option, int& value, Range range, const std::string& text) {
  Option& added = add(option, "COUNT", text);
  added.default_text = std::to_string(value);
  added.take = takeCount(value, range);
  return added;
}

const Command* Command::find(const std::string& wanted) const {
  for (const Command& command : commands) {
    if (command.name == wanted) return &command;
  }
  return nullptr;
}

std::vector<std::string> Command::namesOfCommands() const {
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.name);
  return names;
}

}  // namespace innersphere::tool
