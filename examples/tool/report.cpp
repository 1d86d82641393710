#include "report.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace innersphere::tool {

Report::Report() : json_(std::make_unique<nlohmann::ordered_json>(nlohmann::ordered_json::object())) {}
Report::Report(Report&&) noexcept = default;
Report::~Report() = default;

void Report::add(const std::string& key, const std::string& label, nlohmann::ordered_json value,
                 const std::string& text) {
  (*json_)[key] = std::move(value);
  if (!label.empty()) addLine(label, text);
}

void Report::addLine(const std::string& label, const std::string& text) {
  lines_.push_back({label, text});
}

void Report::add(const std::string& key, const std::string& label, const std::string& value) {
  add(key, label, value, value);
}

void Report::add(const std::string& key, const std::string& label, std::size_t value) {
  add(key, label, value, std::to_string(value));
}

void Report::print(bool as_json, std::FILE* file) const {
  if (as_json) {
    // Names of files may hold bytes that are not UTF-8.
    std::fprintf(file, "%s\n", json_->dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
    return;
  }
  std::size_t width = 0;
  for (const Line& line : lines_) width = std::max(width, line.label.size());
  for (const Line& line : lines_) {
    std::fprintf(file, "%-*s  %s\n", static_cast<int>(width), line.label.c_str(), line.text.c_str());
  }
}

std::string number(double value, const std::string& unit) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value);
  return unit.empty() ? text : text + (" " + unit);
}

std::string percent(double fraction) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f %%", 100 * fraction);
  return text;
}

std::string vector(const Vec3d& v, const std::string& unit) {
  return number(v[0]) + " " + number(v[1]) + " " + number(v[2]) + " " + unit;
}

std::string place(const Vec3d& at, double size) {
  std::string numbers;
  for (const double x : at) {
    const double sizes_away = std::abs(x) / size;
    const int digits =
        4 + (sizes_away > 1 ? static_cast<int>(std::min(std::ceil(std::log10(sizes_away)), 12.0)) : 0);
    char text[40];
    std::snprintf(text, sizeof text, "%.*g ", digits, x);
    numbers += text;
  }
  return numbers + "m";
}

}  // namespace innersphere::tool
