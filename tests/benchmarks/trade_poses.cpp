#include "trade_poses.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "true_overlap.hpp"

namespace innersphere::benchmarks {
namespace {

constexpr std::size_t kRough = 1 << 12, kFine = 1 << 19;  // samples of a volume
constexpr double kPieces = 400;                           // along a diagonal of the box, of surface triangles

Eigen::Vector3d placedAt(const Placement& placement, const Vec3d& p) {
  Eigen::Vector3d result(placement.translation.data());
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) result[i] += placement.rotation[3 * i + k] * p[k];
  }
  return result;
}

/// Sum of the area vectors of the small triangles that a triangle is cut into and whose middles are inside.
Eigen::Vector3d areaInside(const Solid& solid, const std::array<Eigen::Vector3d, 3>& corners, double edge) {
  const Eigen::Vector3d u = corners[1] - corners[0], v = corners[2] - corners[0];
  const double longest = std::max({u.norm(), v.norm(), (u - v).norm()});
  const int n = std::max(1, static_cast<int>(std::ceil(longest / edge)));
  int inside = 0;
  const auto look = [&](double i, double j) {
    const Eigen::Vector3d p = corners[0] + (i / n) * u + (j / n) * v;
    inside += solid.contains({p.x(), p.y(), p.z()}) ? 1 : 0;
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n - i; ++j) {
      look(i + 1.0 / 3, j + 1.0 / 3);
      if (i + j < n - 1) look(i + 2.0 / 3, j + 2.0 / 3);
    }
  }
  return u.cross(v) / 2 * inside / (n * n);
}

Vec3d gradientOf(const Solid& solid, const Mesh& surface, double size, const Placement& copy) {
  std::vector<Eigen::Vector3d> parts(surface.triangles.size());
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    std::array<Eigen::Vector3d, 3> corners;
    for (int k = 0; k < 3; ++k) corners[k] = placedAt(copy, surface.vertices[surface.triangles[i][k]]);
    parts[i] = areaInside(solid, corners, size / kPieces);
  });
  Eigen::Vector3d sum(0, 0, 0);
  for (const Eigen::Vector3d& part : parts) sum += part;
  return {sum.x(), sum.y(), sum.z()};
}

}  // namespace

std::vector<ExactPose> touchingPoses(const Solid& solid, std::size_t count, double share) {
  const Mesh surface = solid.surface();
  const Bounds box = solid.bounds();
  const double volume = solid.massProperties().volume;
  const Eigen::Vector3d low(box.min.data()), high(box.max.data()), middle = (low + high) / 2;
  const double size = (high - low).norm();
  std::mt19937_64 engine(1);
  const auto random = [&] { return 2 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1; };

  std::vector<ExactPose> poses;
  while (poses.size() < count) {
    const Eigen::Quaterniond turn = Eigen::Quaterniond(random(), random(), random(), random()).normalized();
    const Eigen::Vector3d side = Eigen::Vector3d(random(), random(), random()).normalized();
    const auto at = [&](double distance) {
      Placement placement;
      const Eigen::Matrix3d m = turn.toRotationMatrix();
      const Eigen::Vector3d shift = middle - m * middle + distance * side;
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) placement.rotation[3 * i + k] = m(i, k);
        placement.translation[i] = shift[i];
      }
      return placement;
    };
    // The first place from outside where enough is shared; solids with holes share less again farther in.
    double outside = size, inside = size;
    while (inside > 0 && sampledOverlap(solid, at(inside), kRough).volume < share * volume) {
      outside = inside;
      inside -= size / 50;
    }
    if (inside <= 0) continue;
    for (int i = 0; i < 8; ++i) {
      const double between = (inside + outside) / 2;
      (sampledOverlap(solid, at(between), kRough).volume < share * volume ? outside : inside) = between;
    }
    ExactPose& pose = poses.emplace_back();
    pose.placement = at(inside);
    pose.volume = sampledOverlap(solid, pose.placement, kFine).volume;
    pose.gradient = gradientOf(solid, surface, size, pose.placement);
  }
  return poses;
}

}  // namespace innersphere::benchmarks
