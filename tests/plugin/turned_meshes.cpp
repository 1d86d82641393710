#include "turned_meshes.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace innersphere::test {
namespace {

/// A body of revolution about z: (distance from the axis, z) from one place on the axis to another,
/// counter-clockwise around the cross section.
Mesh turnedMesh(const std::vector<std::array<double, 2>>& profile) {
  constexpr std::uint32_t kAround = 48;
  const auto rings = static_cast<std::uint32_t>(profile.size() - 2);
  Mesh mesh;
  for (std::uint32_t k = 1; k <= rings; ++k) {
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const double angle = 2 * M_PI * i / kAround;
      mesh.vertices.push_back(
          {profile[k][0] * std::cos(angle), profile[k][0] * std::sin(angle), profile[k][1]});
    }
  }
  mesh.vertices.push_back({0, 0, profile.front()[1]});
  mesh.vertices.push_back({0, 0, profile.back()[1]});
  const std::uint32_t first = rings * kAround, last = first - kAround;
  for (std::uint32_t i = 0; i < kAround; ++i) {
    const std::uint32_t next = (i + 1) % kAround;
    mesh.triangles.push_back({first, next, i});
    mesh.triangles.push_back({last + i, last + next, first + 1});
    for (std::uint32_t low = 0; low < last; low += kAround) {
      mesh.triangles.push_back({low + i, low + next, low + kAround + next});
      mesh.triangles.push_back({low + i, low + kAround + next, low + kAround + i});
    }
  }
  return mesh;
}

}  // namespace

Mesh cupMesh() {
  constexpr double kRadius = 0.05, kHeight = 0.1, kWall = 0.001;
  std::vector<std::array<double, 2>> profile{{0, 0}, {kRadius, 0}};
  for (int i = 1; i <= 10; ++i) profile.push_back({kRadius, kHeight * i / 10});
  for (int i = 10; i >= 1; --i) profile.push_back({kRadius - kWall, kWall + (kHeight - kWall) * i / 10});
  profile.push_back({kRadius - kWall, kWall});
  profile.push_back({0, kWall});
  return turnedMesh(profile);
}

Mesh hornMesh() {
  constexpr double kRadius = 0.05, kRoot = 0.012, kLength = 0.2;
  std::vector<std::array<double, 2>> profile;
  const double top = std::acos(kRoot / kRadius);
  for (int i = 0; i <= 24; ++i) {
    const double angle = -M_PI / 2 + (M_PI / 2 + top) * i / 24;
    profile.push_back({i == 0 ? 0 : kRadius * std::cos(angle), kRadius * std::sin(angle)});
  }
  const double root = profile.back()[1];
  for (int i = 1; i <= 12; ++i) profile.push_back({kRoot * (12 - i) / 12, root + kLength * i / 12});
  profile.back()[0] = 0;
  return turnedMesh(profile);
}

}  // namespace innersphere::test
