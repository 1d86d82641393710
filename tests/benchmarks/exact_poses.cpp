#include "exact_poses.hpp"

#include "csv_table.hpp"

namespace innersphere::benchmarks {

std::vector<ExactPose> readExactPoses(const std::string& path) {
  const CsvTable table(path);
  std::vector<ExactPose> poses;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto number = [&](const std::string& column) { return table.number(row, column); };
    ExactPose pose;
    for (int i = 0; i < 3; ++i) {
      const std::string m = std::string("m") + std::to_string(i);
      for (int j = 0; j < 3; ++j) pose.placement.rotation[3 * i + j] = number(m + std::to_string(j));
      pose.placement.translation[i] = number(m + "3");
    }
    pose.volume = number("V");
    pose.centroid = {number("cx"), number("cy"), number("cz")};
    pose.gradient = {number("gx"), number("gy"), number("gz")};
    poses.push_back(pose);
  }
  return poses;
}

std::vector<ExactPose> readOverlappingPoses(const std::string& path) {
  std::vector<ExactPose> poses = readExactPoses(path);
  std::erase_if(poses, [](const ExactPose& pose) { return !(pose.volume > 0); });
  return poses;
}

}  // namespace innersphere::benchmarks
