#include "thin_meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "outline_meshes.hpp"

namespace innersphere::test {
namespace {

double between(double a, double b, double t) {
  return a + (b - a) * t;
}

/// A limb from one place to another, thinner at its end.
struct Limb {
  Vec3d from, to;
  double thick, thin;

  double distance(const Vec3d& p) const {
    double along = 0, length2 = 0;
    for (int k = 0; k < 3; ++k) {
      along += (p[k] - from[k]) * (to[k] - from[k]);
      length2 += (to[k] - from[k]) * (to[k] - from[k]);
    }
    const double t = std::clamp(along / length2, 0.0, 1.0);
    double off2 = 0;
    for (int k = 0; k < 3; ++k) off2 += std::pow(p[k] - between(from[k], to[k], t), 2);
    return std::sqrt(off2) - between(thick, thin, t);
  }
};

}  // namespace

std::unique_ptr<Solid> makeCow() {
  std::vector<Limb> limbs{
      {{-0.13, 0, 0.27}, {0.11, 0, 0.28}, 0.075, 0.07},    // body
      {{0.13, 0, 0.3}, {0.2, 0, 0.36}, 0.045, 0.035},      // neck
      {{0.2, 0, 0.36}, {0.27, 0, 0.32}, 0.034, 0.022},     // head
      {{-0.2, 0, 0.31}, {-0.24, 0, 0.13}, 0.006, 0.004},   // tail
      {{-0.24, 0, 0.13}, {-0.245, 0, 0.1}, 0.009, 0.004},  // its tuft
      {{-0.09, 0, 0.2}, {-0.08, 0, 0.185}, 0.035, 0.03},   // udder
  };
  for (const double side : {-1.0, 1.0}) {
    for (const double x : {-0.15, 0.11})
      limbs.push_back({{x, side * 0.05, 0.22}, {x, side * 0.05, 0.01}, 0.026, 0.012});
    for (const double x : {-0.1, -0.07})
      limbs.push_back({{x, side * 0.015, 0.165}, {x, side * 0.018, 0.14}, 0.007, 0.005});
    limbs.push_back({{0.2, side * 0.025, 0.385}, {0.195, side * 0.075, 0.41}, 0.009, 0.006});   // horns
    limbs.push_back({{0.195, side * 0.075, 0.41}, {0.205, side * 0.085, 0.46}, 0.006, 0.003});  // their tips
    limbs.push_back({{0.19, side * 0.03, 0.36}, {0.17, side * 0.085, 0.35}, 0.005, 0.012});     // ears
  }
  const auto distance = [limbs](const Vec3d& p) {
    double least = limbs[0].distance(p);
    for (const Limb& limb : limbs) least = std::min(least, limb.distance(p));
    return least;
  };
  // Packed by its triangles, which is faster.
  const Bounds bounds{{-0.27, -0.11, -0.01}, {0.3, 0.11, 0.48}};
  return makeSolid(makeDistanceSolid("cow", distance, bounds, 192)->surface(), "cow");
}

Mesh cupMesh(std::uint32_t around) {
  constexpr double kRadius = 0.05, kHeight = 0.1, kWall = 0.001;
  std::vector<std::array<double, 2>> profile{{0, 0}, {kRadius, 0}};
  for (int i = 1; i <= 10; ++i) profile.push_back({kRadius, kHeight * i / 10});
  for (int i = 10; i >= 1; --i) profile.push_back({kRadius - kWall, kWall + (kHeight - kWall) * i / 10});
  profile.push_back({kRadius - kWall, kWall});
  profile.push_back({0, kWall});
  return turnedMesh(profile, around);
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
