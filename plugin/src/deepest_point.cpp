#include "deepest_point.hpp"

#include "contact_patch.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

constexpr int kSteps = 2;

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

}  // namespace

void appendDeepest(const Gauge& gauge, std::vector<Measured>& measured) {
  const Measured* start = nullptr;
  for (const Measured& m : measured) {
    if (!usable(m.gap, m.direction)) continue;
    if (start == nullptr || depthOf(m) > depthOf(*start)) start = &m;
  }
  if (start == nullptr) return;
  Measured best = *start;
  best.id = kDeepestId;
  const btVector3 direction = best.direction;
  btVector3 shift(0, 0, 0);
  for (int i = 0; i < kSteps; ++i) {
    const Place top = placeOf(best.gap, direction);
    // How fast the slope falls with distance. Nothing is to be climbed where faces are flat, or fit together.
    const btScalar fall = best.gap.curvature_a + best.gap.curvature_b;
    if (!(fall > 0)) return;
    if (top.slope.length() < best.gap.faceting) break;
    Gap gap;
    const btVector3 step = top.slope / fall;
    if (!gauge.measure(best.index, direction, shift + step, gap) || !usable(gap, direction)) break;
    if (placeOf(gap, direction).depth <= top.depth) break;
    shift += step;
    best.gap = gap;
  }
  measured.push_back(best);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
