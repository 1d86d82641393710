#include "narrow_phase/contact_transport.hpp"

#include "common/motion_bound.hpp"
#include "narrow_phase/hill.hpp"
#include "shape/packing_shape_impl.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// A body that is held from sides more than 107 degrees apart is enclosed.
constexpr btScalar kEnclosed = btScalar(-0.3);

/// Of a body of this size, as seen from a frame.
btScalar motionIn(const btTransform& frame_before, const btTransform& before, const btTransform& frame_now,
                  const btTransform& now, btScalar size) {
  return travelBetween(frame_before.inverseTimes(before), frame_now.inverseTimes(now), size);
}

/// From where `point` and its normal have gone with each body to where the surfaces are deepest in each other
/// now: a contact of curved surfaces moves over both as they roll and slide, to where their normals agree,
/// but along axes in which they are so flat that this is further away than `farthest` [m]. `axes` are those
/// of its bends, which have gone with B.
void rollOn(const btVector3& normal_a, const btVector3& normal_b, const btVector3& on_a, const Across& axes,
            btScalar farthest, ContactPoint& point) {
  const btVector3 apart = on_a - point.on_b;
  const btScalar depth = apart.dot(normal_b);
  const btVector3 aside = apart - normal_b * depth;
  const btVector3 lean = normal_a - normal_b;
  const btVector3 slope = point.bend_a.turn(aside, axes) - lean;
  const Hill hill(point.bend_a, point.bend_b, depth, axes);
  btVector3 on_b(0, 0, 0), stays = lean;
  bool rolls[2];
  for (int i = 0; i < 2; ++i) {
    const btScalar rise = slope.dot(hill.axis(i));
    rolls[i] = hill.hasTop(i) && btFabs(rise) < farthest * hill.fall(i);
    if (!rolls[i]) continue;
    on_b += hill.axis(i) * (rise / hill.fall(i));
    stays -= hill.axis(i) * lean.dot(hill.axis(i));
  }
  const btVector3 turn_b = point.bend_b.turn(on_b, axes);
  point.normal = (normal_b - turn_b + stays * point.turn_a).normalized();
  btVector3 on_a_too = on_b - turn_b * depth - aside;
  for (int i = 0; i < 2; ++i) {
    if (!rolls[i]) on_a_too -= hill.axis(i) * on_a_too.dot(hill.axis(i));
  }
  const btScalar bulge_a = point.bend_a.turn(on_a_too, axes).dot(on_a_too) / 2,
                 bulge_b = turn_b.dot(on_b) / 2;
  point.depth = apart.dot(point.normal) + bulge_a + bulge_b;
  point.on_b += on_b + point.normal * bulge_b;
  point.bend_x = axes.x;
}

}  // namespace

btScalar motionBetween(const Placed& before, const Placed& now, btScalar size_a, btScalar size_b) {
  return size_b < size_a ? motionIn(before.a, before.b, now.a, now.b, size_b)
                         : motionIn(before.b, before.a, now.b, now.a, size_a);
}

void ContactTransport::noteSearch(const Placed& now) {
  searched_at_ = now;
  if (isEmpty() && patches.empty()) {
    samples = Samples();
    measured_.clear();
    releaseIfEmpty(patches);
    releaseIfEmpty(measured_);
  }
  enclosed_ = false;
  for (const Samples::OfPatch& patch : samples.patches) {
    for (const Samples::OfPatch& other : samples.patches)
      enclosed_ = enclosed_ || patch.normal.dot(other.normal) < kEnclosed;
  }
}

void ContactTransport::turnTo(const Placed& now) {
  turn(now.a.getBasis() * measured_at_.a.getBasis().transpose(), samples);
}

void ContactTransport::noteDepths(const Placed& now, btScalar found) {
  measured_at_ = now;
  measured_ = patches;
  gap_ = found;
  for (const ContactPatch& patch : patches) gap_ = btMin(gap_, -patch.depth());
}

void ContactTransport::carryTo(const Placed& now, const PackingShape& a, btScalar spacing) {
  const Placed& then = measured_at_;
  patches = measured_;
  if (patches.empty() || then == now) return;
  const btMatrix3x3 turn_a = now.a.getBasis() * then.a.getBasis().transpose();
  const btMatrix3x3 turn_b = now.b.getBasis() * then.b.getBasis().transpose();
  const btVector3 to_b_then = then.b.getOrigin() - a.impl().toWorld(then.a).getOrigin();
  const btVector3 to_b_now = now.b.getOrigin() - a.impl().toWorld(now.a).getOrigin();
  for (ContactPatch& patch : patches) {
    patch.normal = turn_a * patch.normal;
    patch.centre = turn_a * patch.centre;
    for (int i = 0; i < patch.count; ++i) {
      ContactPoint& point = patch.points[i];
      const btVector3 on_a = turn_a * (point.on_b + point.normal * point.depth);
      Across axes = bendAxes(point);
      axes.x = turn_b * axes.x;
      axes.y = turn_b * axes.y;
      point.on_b = turn_b * (point.on_b - to_b_then) + to_b_now;
      point.to_top = turn_b * point.to_top;
      rollOn(turn_a * point.normal, turn_b * point.normal, on_a, axes, kRollsOn * spacing, point);
    }
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
