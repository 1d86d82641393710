#include "narrow_phase/deepest_points.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "narrow_phase/contact_point.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Of the curvatures themselves.
constexpr btScalar kUnlike = btScalar(0.3);
constexpr int kSteps = 8;
constexpr int kStepsBeside = 2;
/// Of two steps, in fractions of the first.
constexpr btScalar kSlowest = btScalar(0.1);
/// Slopes of places beside a point that bears: those that a rolling body meets next, say [rad].
constexpr btScalar kBeside = btScalar(0.1);
/// A top that is guessed to be this near to one that was climbed is that one: in fractions of the way there,
/// and of the separation.
constexpr btScalar kSameHill = btScalar(0.5);
constexpr btScalar kSameTop = btScalar(0.1);
/// Slopes that say little about the top [rad].
constexpr btScalar kSteep = btScalar(0.5);

struct Place {
  btScalar depth;   ///< along the direction
  btVector3 slope;  ///< of the depth, in that plane
};

Place placeOf(const OpposedPoints& gap, const btVector3& direction) {
  const btScalar a = gap.normal_a.dot(direction), b = gap.normal_b.dot(direction);
  const btVector3 slope = gap.normal_b / b - gap.normal_a / a;
  return {(gap.on_a - gap.on_b).dot(direction), slope};
}

bool usable(const OpposedPoints& gap, const btVector3& direction) {
  return gap.normal_a.dot(direction) > btScalar(0.5) && gap.normal_b.dot(direction) > btScalar(0.5);
}

btScalar depthOf(const ProbedSample& m) {
  return (m.gap.on_a - m.gap.on_b).dot(m.direction);
}

/// Where the depth is greatest around a measurement, going by its slope and curvature: a guess, worth nothing
/// where it is steep.
struct Top {
  btScalar depth;
  btVector3 shift;  ///< from here
};

Top topOf(const ProbedSample& m) {
  const Place place = placeOf(m.gap, m.direction);
  if (fitTogether(m.gap.curvature_a, m.gap.curvature_b) || place.slope.length() > kSteep)
    return {place.depth, btVector3(0, 0, 0)};
  const btVector3 shift = place.slope / (m.gap.curvature_a + m.gap.curvature_b);
  return {place.depth + place.slope.dot(shift) / 2, shift};
}

/// Moves a measurement uphill; not where slopes above `steepest` say that the top is far.
void climb(const SurfaceProbe& probe, btScalar steepest, int steps, ProbedSample& m) {
  Place place = placeOf(m.gap, m.direction);
  // How fast the slope falls with distance. Nothing is to be climbed where faces are flat, or fit together.
  const btScalar fastest = m.gap.curvature_a + m.gap.curvature_b;
  btScalar fall = fastest;
  if (fitTogether(m.gap.curvature_a, m.gap.curvature_b) || place.slope.length() > steepest) return;
  btVector3 shift(0, 0, 0);
  for (int i = 0; i < steps; ++i) {
    OpposedPoints gap;
    gap.triangle_a = m.gap.triangle_a;
    gap.triangle_b = m.gap.triangle_b;
    const btVector3 step = place.slope / fall;
    if (!probe.measure(m.index, m.direction, shift + step, gap) || !usable(gap, m.direction)) return;
    const Place next = placeOf(gap, m.direction);
    if (next.depth <= place.depth) {
      if (fall >= fastest) return;
      fall = fastest;  // too far
      continue;
    }
    // From here on as fast as it fell along the step: surfaces may be less curved that way.
    const btScalar fell = (place.slope - next.slope).dot(step) / step.length2();
    if (fell > kSlowest * fall) fall = fell;
    shift += step;
    m.gap = gap;
    place = next;
  }
}

}  // namespace

bool fitTogether(btScalar curvature_a, btScalar curvature_b) {
  return !(curvature_a + curvature_b > kUnlike * (btFabs(curvature_a) + btFabs(curvature_b)));
}

void climb(const SurfaceProbe& probe, btScalar separation, std::vector<ProbedSample>& measured) {
  std::array<ProbedSample, kPatchPoints> tops;
  int count = 0;
  const auto isClimbed = [&](const Top& top, const btVector3& from) {
    return std::any_of(tops.begin(), tops.begin() + count, [&](const ProbedSample& climbed) {
      const btVector3 way = climbed.gap.on_b - from;
      return (way - top.shift).length() < btMax(kSameHill * way.length(), kSameTop * separation);
    });
  };
  while (count < kPatchPoints) {
    ProbedSample* best = nullptr;
    btScalar most = count > 0 ? -separation : -BT_LARGE_FLOAT;
    for (ProbedSample& m : measured) {
      if (m.starts_climb || !usable(m.gap, m.direction)) continue;
      const Top top = topOf(m);
      // The first is sure to be there.
      const btScalar depth = count > 0 ? top.depth : depthOf(m);
      if (depth > most && !isClimbed(top, m.gap.on_b)) {
        most = depth;
        best = &m;
      }
    }
    if (best == nullptr) break;
    best->starts_climb = true;
    ProbedSample& top = tops[count];
    top = *best;
    top.id = kDeepestId - static_cast<std::uint64_t>(count++);
    climb(probe, BT_LARGE_FLOAT, kSteps, top);
  }
  for (ProbedSample& m : measured) {
    if (probe.exactB() && usable(m.gap, m.direction)) climb(probe, kBeside, kStepsBeside, m);
  }
  std::copy_if(tops.begin(), tops.begin() + count, std::back_inserter(measured),
               [](const ProbedSample& top) { return top.gap.curvature_a + top.gap.curvature_b > 0; });
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
