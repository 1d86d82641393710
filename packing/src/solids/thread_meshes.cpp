// Nut and bolt. Both threads are sampled on one grid of angle and height whose diagonals follow the helix, so
// that crests and roots are sharp lines of the mesh.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/steady_math.hpp"
#include "solids/generators.hpp"
#include "solids/named_meshes.hpp"

namespace innersphere {
namespace {

constexpr double kPitch = 0.125;
constexpr int kSteps = 36;  // around, and along one pitch
constexpr double kCrest = 0.3;
constexpr double kDepth = 0.068;       // 60 degrees between the flanks, as ISO threads have
constexpr double kClearance = 0.01;    // radial, between bolt and nut
constexpr double kHexagon = 0.85 / 2;  // half the width across flats
constexpr double kHead = 0.25;

// The bolt's radius where the helix has come `turns` turns up: root, flank, crest and flank.
double threadRadius(double turns) {
  const double x = std::abs(turns - std::floor(turns) - 0.5);  // 0 on the crest, 1/2 on the root
  constexpr double kHalfCrest = 1.0 / 18, kHalfRoot = 7.0 / 18;
  return kCrest - kDepth * std::clamp((x - kHalfCrest) / (kHalfRoot - kHalfCrest), 0.0, 1.0);
}

// The thread at `step` steps up, widened by `clearance`; right-handed.
Ring threadRing(int step, double clearance) {
  Ring ring;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSteps;
    const double radius = threadRadius(static_cast<double>(step - i) / kSteps) + clearance;
    ring.push_back({radius * steady::cos(angle), radius * steady::sin(angle), kPitch * step / kSteps});
  }
  return ring;
}

Ring hexagonRing(double z) {
  Ring ring;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSteps;
    // Angle from the middle of the nearest flat; corners are at multiples of 60 degrees.
    const double off = std::remainder(angle - std::numbers::pi / 6, std::numbers::pi / 3);
    const double radius = kHexagon / steady::cos(off);
    ring.push_back({radius * steady::cos(angle), radius * steady::sin(angle), z});
  }
  return ring;
}

}  // namespace

Mesh boltMesh() {
  constexpr int kTurns = 6;
  std::vector<Ring> rings{hexagonRing(-kHead), hexagonRing(0)};
  for (int step = 0; step <= kTurns * kSteps; ++step) rings.push_back(threadRing(step, 0));
  return loft(rings, false);
}

Mesh nutMesh() {
  constexpr int kTurns = 3;
  std::vector<Ring> rings{hexagonRing(kTurns * kPitch), hexagonRing(0)};
  for (int step = 0; step <= kTurns * kSteps; ++step) rings.push_back(threadRing(step, kClearance));
  return turned(loft(rings, true));
}

}  // namespace innersphere
