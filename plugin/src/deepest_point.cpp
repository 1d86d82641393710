#include "deepest_point.hpp"

#include "contact_patch.hpp"

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

struct Place {
  btScalar depth;   ///< along the direction
  btVector3 slope;  ///< of the depth, in that plane
};

Place placeOf(const Gap& gap, const btVector3& direction) {
  const btScalar a = gap.normal_a.dot(direction), b = gap.normal_b.dot(direction);
  const btVector3 slope = gap.normal_b / b - gap.normal_a / a;
  return {(gap.on_a - gap.on_b).dot(direction), slope};
}

bool usable(const Gap& gap, const btVector3& direction) {
  return gap.normal_a.dot(direction) > btScalar(0.5) && gap.normal_b.dot(direction) > btScalar(0.5);
}

btScalar depthOf(const Measured& m) {
  return (m.gap.on_a - m.gap.on_b).dot(m.direction);
}

/// Moves a measurement uphill; not where slopes above `steepest` say that the top is far.
void climb(const Gauge& gauge, btScalar steepest, int steps, Measured& m) {
  Place place = placeOf(m.gap, m.direction);
  // How fast the slope falls with distance. Nothing is to be climbed where faces are flat, or fit together.
  btScalar fall = m.gap.curvature_a + m.gap.curvature_b;
  if (fitTogether(m.gap.curvature_a, m.gap.curvature_b) || place.slope.length() > steepest) return;
  btVector3 shift(0, 0, 0);
  for (int i = 0; i < steps; ++i) {
    Gap gap;
    gap.triangle_a = m.gap.triangle_a;
    gap.triangle_b = m.gap.triangle_b;
    const btVector3 step = place.slope / fall;
    if (!gauge.measure(m.index, m.direction, shift + step, gap) || !usable(gap, m.direction)) return;
    const Place next = placeOf(gap, m.direction);
    if (next.depth <= place.depth) return;
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

void climb(const Gauge& gauge, std::vector<Measured>& measured) {
  const Measured* deepest = nullptr;
  for (const Measured& m : measured) {
    if (usable(m.gap, m.direction) && (deepest == nullptr || depthOf(m) > depthOf(*deepest))) deepest = &m;
  }
  if (deepest == nullptr) return;
  Measured top = *deepest;
  top.id = kDeepestId;
  climb(gauge, BT_LARGE_FLOAT, kSteps, top);
  for (Measured& m : measured) {
    if (gauge.exactB() && usable(m.gap, m.direction)) climb(gauge, kBeside, kStepsBeside, m);
  }
  if (top.gap.curvature_a + top.gap.curvature_b > 0) measured.push_back(top);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
