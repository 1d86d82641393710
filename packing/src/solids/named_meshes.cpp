#include "solids/named_meshes.hpp"

#include <cmath>
#include <numbers>

#include "common/bounds.hpp"
#include "common/steady_math.hpp"
#include "solids/generators.hpp"

namespace innersphere {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

// A circle of n points in the plane of `side` and `up`.
Ring tubeRing(const Vec3d& centre, const Vec3d& side, const Vec3d& up, double radius, int n) {
  Ring ring;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * kHalfTurn * i / n;
    ring.push_back(centre + radius * steady::cos(angle) * side + radius * steady::sin(angle) * up);
  }
  return ring;
}

}  // namespace

// A chain link in the xy plane, long in x: a torus of ring radius 0.25 and tube radius 0.08, cut in two
// halves that are joined by straight parts of 0.6.
Mesh linkMesh() {
  constexpr double kBend = 0.25, kTube = 0.08, kHalfStraight = 0.3;
  constexpr int kBendSteps = 24, kAround = 24;
  std::vector<Ring> rings;
  for (const double end : {1.0, -1.0}) {
    for (int i = 0; i <= kBendSteps; ++i) {
      const double angle = kHalfTurn * i / kBendSteps + (end > 0 ? -kHalfTurn / 2 : kHalfTurn / 2);
      const Vec3d out{steady::cos(angle), steady::sin(angle), 0};
      rings.push_back(
          tubeRing(Vec3d{end * kHalfStraight, 0, 0} + kBend * out, out, {0, 0, 1}, kTube, kAround));
    }
  }
  return turned(loft(rings, true));
}

// Half a spherical shell of outer radius 0.5 and thickness 0.08, open upwards, with a round rim at z = 0.
Mesh bowlMesh() {
  constexpr double kOuter = 0.5, kThickness = 0.08, kInner = kOuter - kThickness;
  constexpr double kRim = kThickness / 2;
  constexpr int kAround = 64, kArc = 20, kRimSteps = 8;
  std::vector<Ring> rings{{{0, 0, -kOuter}}};
  for (int i = 1; i <= kArc; ++i) {
    const double angle = kHalfTurn / 2 * i / kArc;
    rings.push_back(circle(kOuter * steady::sin(angle), -kOuter * steady::cos(angle), kAround));
  }
  for (int i = 1; i < kRimSteps; ++i) {
    const double angle = kHalfTurn * i / kRimSteps;
    rings.push_back(circle(kOuter - kRim + kRim * steady::cos(angle), kRim * steady::sin(angle), kAround));
  }
  for (int i = kArc; i >= 1; --i) {
    const double angle = kHalfTurn / 2 * i / kArc;
    rings.push_back(circle(kInner * steady::sin(angle), -kInner * steady::cos(angle), kAround));
  }
  rings.push_back({{0, 0, -kInner}});
  return loft(rings, false);
}

// A spur gear about the z axis with 16 teeth between radius 0.42 and 0.52, a bore of radius 0.2, 0.25 thick.
Mesh gearMesh() {
  constexpr int kTeeth = 16, kRoot = 4;
  constexpr double kRootRadius = 0.42, kTipRadius = 0.52, kBore = 0.2, kHalf = 0.125;
  Polygon outer, bore;
  for (int tooth = 0; tooth < kTeeth; ++tooth) {
    const auto add = [&](double fraction, double radius) {
      const double angle = 2 * kHalfTurn * (tooth + fraction) / kTeeth;
      outer.push_back({radius * steady::cos(angle), radius * steady::sin(angle)});
      bore.push_back({kBore * steady::cos(angle), kBore * steady::sin(angle)});
    };
    for (int i = 0; i < kRoot; ++i) add(0.5 * i / (kRoot - 1) - 0.25, kRootRadius);
    add(0.38, kTipRadius);
    add(0.5, kTipRadius);
    add(0.62, kTipRadius);
  }
  return loft({lifted(outer, -kHalf), lifted(outer, kHalf), lifted(bore, kHalf), lifted(bore, -kHalf)}, true);
}

// Two arms of length 1 and width 0.3 along x and y, 0.3 thick, one corner at the origin.
Mesh lbracketMesh() {
  const Polygon outline{{0, 0}, {1, 0}, {1, 0.3}, {0.3, 0.3}, {0.3, 1}, {0, 1}};
  return loft({lifted(outline, 0), lifted(outline, 0.3)}, false);
}

// An open container: outside 2 x 2 x 1, walls and floor 0.2 thick, standing on z = 0.
Mesh trayMesh() {
  const auto square = [](double half, double z) {
    return Ring{{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
  };
  return loft({square(1, 0), square(1, 1), square(0.8, 1), square(0.8, 0.2)}, false);
}

// A trefoil: a tube of radius 0.07 around the (2, 3) torus knot.
Mesh knotMesh() {
  constexpr double kRing = 0.3, kWinding = 0.12, kTube = 0.07;
  constexpr int kAlong = 144, kAround = 20;
  const auto onTorus = [](double t, double r) -> Vec3d {
    const double rho = kRing + r * steady::cos(3 * t);
    return {rho * steady::cos(2 * t), rho * steady::sin(2 * t), r * steady::sin(3 * t)};
  };
  std::vector<Ring> rings;
  for (int i = 0; i < kAlong; ++i) {
    const double t = 2 * kHalfTurn * i / kAlong;
    const double step = 1e-4;
    Vec3d along = onTorus(t + step, kWinding) - onTorus(t - step, kWinding);
    along = (1 / norm(along)) * along;
    Vec3d out = onTorus(t, kWinding) - onTorus(t, 0);
    out = out - dot(out, along) * along;
    out = (1 / norm(out)) * out;
    rings.push_back(tubeRing(onTorus(t, kWinding), out, cross(along, out), kTube, kAround));
  }
  return loft(rings, true);
}

}  // namespace innersphere
