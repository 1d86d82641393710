#include "narrow_phase/contact_transport.hpp"

#include "common/motion_bound.hpp"
#include "narrow_phase/deepest_points.hpp"
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
/// but where they are so flat that this is further away than `farthest` [m].
void rollOn(const btVector3& normal_a, const btVector3& normal_b, const btVector3& on_a, btScalar farthest,
            ContactPoint& point) {
  const btScalar a = point.curvature_a, b = point.curvature_b;
  const btVector3 apart = on_a - point.on_b;
  // A's normal at on_b: convex surfaces turn towards the way that one goes on them.
  const btVector3 aside = apart - normal_b * apart.dot(normal_b);
  const btVector3 slope = normal_b - (normal_a - aside * a);
  const btScalar fall = a + b;
  if (!fitTogether(a, b) && slope.length() < farthest * fall) {
    const btVector3 shift = slope / fall;
    point.normal = (normal_b - shift * b).normalized();
    point.depth = apart.dot(point.normal) + slope.dot(shift) / 2;
    point.on_b += shift - point.normal * shift.dot(point.normal);
  } else {
    point.normal = (normal_a * point.turn_a + normal_b * (1 - point.turn_a)).normalized();
    point.depth = apart.dot(point.normal);
  }
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
  for (const ContactPatch& patch : patches) {
    for (int i = 0; i < patch.count; ++i) gap_ = btMin(gap_, -patch.points[i].depth);
  }
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
      point.on_b = turn_b * (point.on_b - to_b_then) + to_b_now;
      rollOn(turn_a * point.normal, turn_b * point.normal, on_a, kRefineAgain * spacing, point);
    }
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
