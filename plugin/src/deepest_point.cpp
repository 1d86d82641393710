#include "deepest_point.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// No sphere has this id.
constexpr std::uint64_t kClimbedId = ~std::uint64_t(0);
constexpr int kSteps = 2;
/// Slopes below this are flat enough.
constexpr btScalar kLevel = btScalar(1e-3);

struct Place {
  btVector3 at;     ///< in the plane across the direction
  btScalar depth;   ///< along the direction
  btVector3 slope;  ///< of the depth, in that plane
};

Place placeOf(const Gap& gap, const btVector3& direction) {
  const btScalar a = gap.normal_a.dot(direction), b = gap.normal_b.dot(direction);
  const btVector3 middle = (gap.on_a + gap.on_b) / 2;
  const btVector3 slope = gap.normal_b / b - gap.normal_a / a;
  return {middle - direction * middle.dot(direction), (gap.on_a - gap.on_b).dot(direction), slope};
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
  best.id = kClimbedId;
  const btVector3 direction = best.direction;
  Place top = placeOf(best.gap, direction);
  if (top.slope.length() < kLevel) return;

  // How fast the slope falls with distance, along itself; and how far the patch reaches.
  btScalar fall = 0, weight = 0, reach = 0;
  for (const Measured& m : measured) {
    if (!usable(m.gap, direction)) continue;
    const Place place = placeOf(m.gap, direction);
    const btVector3 apart = place.at - top.at;
    fall -= (place.slope - top.slope).dot(apart);
    weight += apart.length2();
    reach = btMax(reach, apart.length());
  }
  if (!(weight > 0) || !(fall > 0)) return;
  fall /= weight;

  btVector3 shift(0, 0, 0);
  bool climbed = false;
  for (int i = 0; i < kSteps && top.slope.length() > kLevel; ++i) {
    btVector3 step = top.slope / fall;
    if (step.length() > reach) step *= reach / step.length();
    Gap gap;
    if (!gauge.measure(best.index, direction, shift + step, gap) || !usable(gap, direction)) break;
    const Place place = placeOf(gap, direction);
    if (place.depth <= top.depth) break;
    shift += step;
    best.gap = gap;
    top = place;
    climbed = true;
  }
  if (climbed) measured.push_back(best);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
