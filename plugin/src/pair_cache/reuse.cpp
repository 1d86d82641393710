#include "pair_cache/reuse.hpp"

#include <algorithm>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// In units of what a gap is wider than needed: contacts are moved along by this far also where that is more
/// than kRefineAgain, as it does not matter how wide such a gap is.
constexpr btScalar kRefineGap = btScalar(0.25);

btScalar sizeOf(const btCollisionShape& shape) {
  return shape.isInfinite() ? BT_LARGE_FLOAT : shape.getAngularMotionDisc();
}

/// Of the thinner body. What gets no further into it than this is pushed out by the side that it came from.
btScalar halfThickness(const ContactPair& pair) {
  const btScalar a = pair.a.packing->impl().halfThickness();
  return pair.b.packing == nullptr ? a : btMin(a, pair.b.packing->impl().halfThickness());
}

/// As long as they come no nearer in the step than SafeDistance::separation.
bool staysApart(const SafeDistance& safe, const BodySnapshot& a, const BodySnapshot& b) {
  return safe.known && (a.isActive() || b.isActive()) && a.changes() + b.changes() == safe.changes &&
         a.travel() + b.travel() <= safe.travel;
}

}  // namespace

Reuse reuseOf(const ContactPair& pair, const BodySnapshot& a, const BodySnapshot& b, btScalar time_step,
              Reuse least) {
  const bool apart = least == Reuse::idle && staysApart(pair.safe, a, b) &&
                     neededSeparation(pair, a, b, time_step) <= pair.safe.separation;
  if (apart && pair.of_packings) return Reuse::idle;  // has read nothing but the beginning of the pair
  const std::optional<btTransform> at_a = pair.a.placeIn(a);
  const std::optional<btTransform> at_b = pair.b.placeIn(b);
  if (!at_a || !at_b) return Reuse::search;  // the shapes may be no more
  const bool same_shapes = pair.found->hasSameShapes();
  if (apart && same_shapes) return Reuse::idle;
  if (least == Reuse::search || !pair.found->isKnown() || !same_shapes || !pair.a.hasSameShape() ||
      !pair.b.hasSameShape())
    return Reuse::search;
  const Placed now{a.startOf(*at_a), b.startOf(*at_b)};
  const ContactTransport& memory = pair.found->memory;
  const ContactSettings& settings = *pair.found->settings;
  if (!pair.found->on_surfaces && (least > Reuse::transport || !(memory.measuredAt() == now)))
    return Reuse::search;
  const btScalar size_a = sizeOf(*pair.a.shape), size_b = sizeOf(*pair.b.shape);
  const btScalar needed = neededSeparation(pair, a, b, time_step);
  const btScalar moved = motionBetween(memory.searchedAt(), now, size_a, size_b);
  const bool enclosed = memory.isEnclosed();
  const btScalar farthest = (enclosed ? kSearchEnclosedAgain : kSearchAgain) * settings.spacing;
  if (moved > farthest || needed + moved > settings.separation) return Reuse::search;
  if (memory.isEmpty()) return std::max(least, Reuse::transport);
  const btScalar turned = motionBetween(memory.measuredAt(), now, size_a, size_b);
  const btScalar carried = enclosed
                               ? kRefineEnclosedAgain * settings.spacing
                               : btMax(kRefineAgain * settings.spacing, kRefineGap * (memory.gap() - needed));
  return std::max(least, turned > carried ? Reuse::refine : Reuse::transport);
}

btScalar neededSeparation(const ContactPair& pair, const BodySnapshot& a, const BodySnapshot& b,
                          btScalar time_step) {
  const btScalar needed = btMax(pair.separation, speculativeDistance(a.motion(), b.motion(), time_step));
  const btScalar stopped = btMax(a.way(), b.way());
  return stopped > needed ? btMax(needed, btMin(stopped, halfThickness(pair))) : needed;
}

void noteWay(const ContactPair& pair, BodySnapshot& a, BodySnapshot& b, btScalar time_step) {
  const btScalar way = speculativeDistance(a.motion(), b.motion(), time_step);
  if (staysApart(pair.safe, a, b) && way <= pair.safe.separation) return;
  if (!a.object()->isStaticOrKinematicObject()) a.noteWay(way);
  if (!b.object()->isStaticOrKinematicObject()) b.noteWay(way);
}

SafeDistance safeDistanceOf(const ContactPair& pair, const BodySnapshot& a, const BodySnapshot& b) {
  SafeDistance safe;
  if (!pair.a.isWhole() || !pair.b.isWhole() || !pair.found->isKnown() || !pair.found->on_surfaces ||
      !pair.found->memory.isEmpty())
    return safe;
  const btScalar spacing = pair.found->settings->spacing;
  const btScalar moved = motionBetween(pair.found->memory.searchedAt(), pair.placed(), sizeOf(*pair.a.shape),
                                       sizeOf(*pair.b.shape));
  const btScalar left = kSearchAgain * spacing - moved;
  safe.known = left > 0;
  safe.changes = a.changes() + b.changes();
  safe.travel = a.travel() + b.travel() + left;
  safe.separation = pair.found->settings->separation - kSearchAgain * spacing;
  return safe;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
