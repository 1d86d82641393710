// What the tool can do, as data: its commands with their options. The command line is read with it, and help,
// the manual page and shell completion are written from it.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace innersphere::tool {

/// What a number may be.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool above_low = false;  ///< `low` itself is out of range
};
inline constexpr Range kPositive{0, std::numeric_limits<double>::infinity(), true};
inline constexpr Range kNotNegative{0};

/// An option, a flag (an option without a value), or an argument (a value without an option).
struct Option {
  std::string name;  ///< "-o,--output"; that of an argument is in capitals
  std::string description;
  std::string value_name;            ///< what help calls the value; empty: a flag
  std::string default_text;          ///< what help says that it is without the option; may be empty
  std::vector<std::string> choices;  ///< names that the value may be
  bool only_choices = false;         ///< it must be one of them
  bool takes_file = false;           ///< it may be the name of a file
  bool required = false;
  bool repeated = false;  ///< may be given any number of times
  /// Takes a value, an empty one for a flag; returns what is wrong with it, or nothing.
  std::function<std::string(const std::string&)> take;

  bool isArgument() const { return name[0] != '-'; }
  bool isFlag() const { return value_name.empty(); }
  /// The names with their dashes: "-o" and "--output".
  std::vector<std::string> spellings() const;

  Option& withDefault(const std::string& text);
  Option& withFile();
  /// Names that a shell offers; any other value is as good.
  Option& withSuggestions(std::vector<std::string> names);
  /// Names of which the value must be one.
  Option& oneOf(std::vector<std::string> names);
};

/// A command, or a group of commands. The functions that add options keep references to where the values go,
/// and show what is there as the default; the reference that they return is good until the next one is added.
struct Command {
  Command(std::string name, std::string description);

  std::string name;
  std::string description;
  std::string notes;                  ///< what help says below the options; may be empty
  std::string exit_status;            ///< a sentence; may be empty
  std::vector<std::string> examples;  ///< command lines
  std::vector<Option> options;
  std::vector<Command> commands;
  std::function<int()> run;  ///< returns the exit status; empty in a group

  /// A value that must be given.
  Option& argument(const std::string& name, std::string& value, const std::string& description);
  /// Any number of values.
  Option& arguments(const std::string& name, std::vector<std::string>& values,
                    const std::string& description);
  Option& flag(const std::string& name, bool& value, const std::string& description);
  Option& text(const std::string& name, std::string& value, const std::string& description);
  Option& texts(const std::string& name, std::vector<std::string>& values, const std::string& description);
  Option& number(const std::string& name, double& value, Range range, const std::string& description);
  /// A whole number; 10000 may also be written 1e4 or 10k.
  Option& count(const std::string& name, std::uint64_t& value, Range range, const std::string& description);
  Option& count(const std::string& name, int& value, Range range, const std::string& description);
  /// One of some names, each of which stands for a value.
  template <typename T>
  Option& choice(const std::string& name, T& value, const std::vector<std::pair<std::string, T>>& choices,
                 const std::string& description);

  /// The command of this name in this group, or null.
  const Command* find(const std::string& name) const;
  std::vector<std::string> namesOfCommands() const;

 private:
  Option& add(const std::string& name, const std::string& value_name, const std::string& description);
};

template <typename T>
Option& Command::choice(const std::string& name, T& value,
                        const std::vector<std::pair<std::string, T>>& choices,
                        const std::string& description) {
  Option& option = add(name, "NAME", description);
  option.only_choices = true;
  for (const auto& [text, choice] : choices) {
    option.choices.push_back(text);
    if (choice == value) option.default_text = text;
  }
  option.take = [&value, choices](const std::string& given) {
    for (const auto& [text, choice] : choices) {
      if (text == given) value = choice;
    }
    return std::string();
  };
  return option;
}

}  // namespace innersphere::tool
