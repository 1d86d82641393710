#include "exact_poses.hpp"

#include <fstream>
#include <map>
#include <sstream>

#include "innersphere/error.hpp"

namespace innersphere::benchmarks {
namespace {

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

class Row {
 public:
  Row(const std::map<std::string, std::size_t>& columns, std::vector<std::string> cells, std::string path)
      : columns_(columns), cells_(std::move(cells)), path_(std::move(path)) {}

  double operator()(const std::string& name) const {
    const auto column = columns_.find(name);
    if (column == columns_.end()) throw Error(ErrorCode::bad_format, path_ + " has no column " + name);
    try {
      return std::stod(cells_.at(column->second));
    } catch (const std::logic_error&) {
      throw Error(ErrorCode::bad_format, path_ + " has a row without a number " + name);
    }
  }

 private:
  const std::map<std::string, std::size_t>& columns_;
  std::vector<std::string> cells_;
  std::string path_;
};

ExactPose poseOf(const Row& row) {
  ExactPose pose;
  for (int i = 0; i < 3; ++i) {
    const std::string m = std::string("m") + std::to_string(i);
    for (int j = 0; j < 3; ++j) pose.placement.rotation[3 * i + j] = row(m + std::to_string(j));
    pose.placement.translation[i] = row(m + "3");
  }
  pose.volume = row("V");
  pose.centroid = {row("cx"), row("cy"), row("cz")};
  pose.gradient = {row("gx"), row("gy"), row("gz")};
  return pose;
}

}  // namespace

std::vector<ExactPose> readExactPoses(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error(ErrorCode::file_not_found, "cannot open " + path);
  std::map<std::string, std::size_t> columns;
  std::vector<ExactPose> poses;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string> cells = cellsOf(line);
    if (columns.empty()) {
      for (const std::string& name : cells) columns.emplace(name, columns.size());
      continue;
    }
    const Row row(columns, cells, path);
    if (row("V") > 0) poses.push_back(poseOf(row));
  }
  return poses;
}

}  // namespace innersphere::benchmarks
