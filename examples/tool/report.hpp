// Results for people or for programs.
#pragma once

#include <cstdio>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "innersphere/geometry.hpp"

namespace innersphere::tool {

/// A list of results, printed as aligned lines or as one JSON object.
class Report {
 public:
  Report();
  Report(Report&&) noexcept;
  ~Report();

  /// `key` and `value` go to JSON, in SI units; `label` and `text` to people, who do not see lines without a
  /// label.
  void add(const std::string& key, const std::string& label, nlohmann::ordered_json value,
           const std::string& text);
  /// A text without special formatting, or a whole number.
  void add(const std::string& key, const std::string& label, const std::string& value);
  void add(const std::string& key, const std::string& label, std::size_t value);
  /// A line for people only.
  void addLine(const std::string& label, const std::string& text);

  void print(bool as_json, std::FILE* file = stdout) const;

 private:
  struct Line {
    std::string label;
    std::string text;
  };
  std::unique_ptr<nlohmann::ordered_json> json_;  ///< its header takes longer to compile than a command
  std::vector<Line> lines_;
};

std::string number(double value, const std::string& unit = "");  ///< four digits: "0.0123 m"
std::string percent(double fraction);                            ///< "85.02 %"
std::string vector(const Vec3d& v, const std::string& unit);     ///< "1.2 0.3 4 m"
/// With as many digits as tell 1e-4 of a size [m], wherever that is: "1000000.5 0.3 4 m".
std::string place(const Vec3d& at, double size);

}  // namespace innersphere::tool
