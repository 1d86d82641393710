#include "sweep.hpp"

#include <cmath>
#include <numbers>

namespace innersphere::benchmarks {
namespace {

/// Rodrigues: about an axis of any length.
Mat3d rotation(const Vec3d& axis, double angle) {
  const double length = std::hypot(axis[0], axis[1], axis[2]);
  const double x = axis[0] / length, y = axis[1] / length, z = axis[2] / length;
  const double c = std::cos(angle), s = std::sin(angle), d = 1 - c;
  return {c + x * x * d,     x * y * d - z * s, x * z * d + y * s,  //
          y * x * d + z * s, c + y * y * d,     y * z * d - x * s,  //
          z * x * d - y * s, z * y * d + x * s, c + z * z * d};
}

}  // namespace

std::vector<Placement> sweepPoses(const Bounds& box, const Vec3d& axis, std::size_t count) {
  std::vector<Placement> poses(count);
  for (std::size_t i = 0; i < count; ++i) {
    Placement& pose = poses[i];
    pose.rotation =
        rotation(axis, 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count));
    for (int k = 0; k < 3; ++k) pose.translation[k] = (box.min[k] + box.max[k]) / 2;  // back from the centre
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j)
        pose.translation[k] -= pose.rotation[3 * k + j] * (box.min[j] + box.max[j]) / 2;
    }
    pose.translation[0] += (box.max[0] - box.min[0]) / 2;
  }
  return poses;
}

}  // namespace innersphere::benchmarks
