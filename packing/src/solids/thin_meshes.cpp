// Solids of thin walls and slender parts, in which spheres by falling radius leave walls bare.
#include <cmath>
#include <numbers>

#include "common/steady_math.hpp"
#include "solids/generators.hpp"
#include "solids/named_meshes.hpp"

namespace innersphere {
namespace {

constexpr int kAround = 64;

// A vessel that stands on z = 0 and widens upwards, with radii at its foot and its rim.
Mesh vesselMesh(double foot, double rim, double height, double wall, double floor) {
  const double inner = foot + (rim - foot) * floor / height - wall;
  return loft({{{0, 0, 0}},
               circle(foot, 0, kAround),
               circle(rim, height, kAround),
               circle(rim - wall, height, kAround),
               circle(inner, floor, kAround),
               {{0, 0, floor}}},
              false);
}

}  // namespace

// 0.8 wide and 0.9 high; walls of 0.008, a floor of 0.04.
Mesh cupMesh() {
  return vesselMesh(0.35, 0.4, 0.9, 0.008, 0.04);
}

// 1 wide and 0.15 high; walls of 0.006, a floor of 0.01.
Mesh panMesh() {
  return vesselMesh(0.4, 0.5, 0.15, 0.006, 0.01);
}

// 1 long from z = 0 to its tip, 0.12 wide, 0.008 thick at its back and sharp at its edge.
Mesh bladeMesh() {
  constexpr double kWidth = 0.12, kBack = 0.008;
  constexpr int kSteps = 40;
  std::vector<Ring> rings;
  for (int i = 0; i < kSteps; ++i) {
    const double z = static_cast<double>(i) / kSteps;
    const double width = kWidth * (1 - z * z * z), half = kBack / 2 * (1 - z / 2);
    rings.push_back(lifted({{0, -half}, {width, 0}, {0, half}}, z));
  }
  rings.push_back({{0, 0, 1}});
  return loft(rings, false);
}

// A cone whose axis bends by 120 degrees along a circle of radius 0.5; 0.3 wide where it begins.
Mesh hornMesh() {
  constexpr double kBend = 0.5, kWidest = 0.15, kTurn = 2 * std::numbers::pi / 3;
  constexpr int kSteps = 48, kSides = 32;
  std::vector<Ring> rings;
  for (int i = 0; i < kSteps; ++i) {
    const double part = static_cast<double>(i) / kSteps, angle = kTurn * part;
    const Vec3d side{steady::cos(angle), 0, -steady::sin(angle)};
    const Vec3d middle = Vec3d{kBend, 0, 0} - kBend * side;
    Ring ring;
    for (const Vec3d& p : circle(kWidest * (1 - part), 0, kSides))
      ring.push_back(middle + p[0] * side + Vec3d{0, p[1], 0});
    rings.push_back(ring);
  }
  rings.push_back({{kBend - kBend * steady::cos(kTurn), 0, kBend * steady::sin(kTurn)}});
  return loft(rings, false);
}

}  // namespace innersphere
