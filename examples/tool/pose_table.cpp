#include "pose_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "innersphere/error.hpp"

namespace innersphere::tool {
namespace {

constexpr std::size_t kMissing = static_cast<std::size_t>(-1);
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";  // Excel writes one

std::vector<std::string> splitCells(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    const std::size_t first = cell.find_first_not_of(" \t\r\"");
    const std::size_t last = cell.find_last_not_of(" \t\r\"");
    cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
  }
  return cells;
}

// Where the columns of interest are.
struct Header {
  std::size_t pose = kMissing;
  std::size_t matrix[3][4];

  Header(const std::vector<std::string>& names, const std::string& path) {
    const auto find = [&names](const std::string& name) {
      const auto at = std::find(names.begin(), names.end(), name);
      return at == names.end() ? kMissing : static_cast<std::size_t>(at - names.begin());
    };
    pose = find("pose");
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 4; ++j) {
        const std::string name{'m', static_cast<char>('0' + i), static_cast<char>('0' + j)};
        matrix[i][j] = find(name);
        if (matrix[i][j] == kMissing) {
          throw Error(ErrorCode::bad_format,
                      path + " has no column " + name + "; its header row must name m00 to m23");
        }
      }
    }
  }
};

double readNumber(const std::vector<std::string>& cells, std::size_t column, const std::string& where) {
  const std::string text = column < cells.size() ? cells[column] : "";
  double value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size()) {
    throw Error(ErrorCode::bad_format, where + ": \"" + text + "\" is not a number");
  }
  if (!std::isfinite(value)) throw Error(ErrorCode::not_finite, where + ": a matrix element is not finite");
  return value;
}

// To the tolerance that queries ask for.
void checkRotation(const Mat3d& m, const std::string& where) {
  constexpr double kTolerance = 1e-4;
  double error = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      double product = 0;
      for (int k = 0; k < 3; ++k) product += m[3 * i + k] * m[3 * j + k];
      error = std::max(error, std::abs(product - (i == j ? 1 : 0)));
    }
  }
  const double determinant = m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
                             m[2] * (m[3] * m[7] - m[4] * m[6]);
  if (error > kTolerance || determinant < 0) {
    throw Error(ErrorCode::bad_format,
                where +
                    ": the matrix is not a rotation with a translation; it must not scale, "
                    "shear or mirror");
  }
}

}  // namespace

std::vector<NamedPose> readPoses(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error(ErrorCode::file_not_found, "cannot open " + path + ": " + std::strerror(errno));
  std::vector<NamedPose> poses;
  std::optional<Header> header;
  std::string line;
  std::size_t columns = 0;
  for (int number = 1; std::getline(file, line); ++number) {
    if (number == 1 && line.rfind(kByteOrderMark, 0) == 0) line.erase(0, kByteOrderMark.size());
    if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') continue;
    const std::vector<std::string> cells = splitCells(line);
    if (!header) {
      header.emplace(cells, path);
      columns = cells.size();
      continue;
    }
    const std::string where = path + ", line " + std::to_string(number);
    if (cells.size() > columns) {
      throw Error(ErrorCode::bad_format, where + " has " + std::to_string(cells.size()) +
                                             " fields, but the header row names only " +
                                             std::to_string(columns) + " columns");
    }
    NamedPose& pose = poses.emplace_back();
    pose.name = header->pose < cells.size() ? cells[header->pose] : std::to_string(poses.size() - 1);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        pose.placement.rotation[3 * i + j] = readNumber(cells, header->matrix[i][j], where);
      pose.placement.translation[i] = readNumber(cells, header->matrix[i][3], where);
    }
    checkRotation(pose.placement.rotation, where);
  }
  if (poses.empty())
    throw Error(ErrorCode::empty_input, path + " holds no poses: it needs a header row and data rows");
  return poses;
}

}  // namespace innersphere::tool
