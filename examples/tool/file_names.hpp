// What the name of a file says.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace innersphere::tool {

/// With its dot, in lower case.
inline std::string endingOf(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

/// True for "-", which stands for stdin or stdout, and for what is there and is no file: pipes and devices.
inline bool isStream(const std::string& path) {
  std::error_code ignored;
  return path == "-" || std::filesystem::is_other(path, ignored);
}

}  // namespace innersphere::tool
