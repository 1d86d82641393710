#include "motion.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Of `body`, as seen from `frame`.
btScalar motionIn(const btTransform& frame_before, const btTransform& before, const btTransform& frame_now,
                  const btTransform& now, btScalar size) {
  const btTransform was = frame_before.inverseTimes(before), is = frame_now.inverseTimes(now);
  btScalar turned2 = 0;  // a turn by t changes the axes by 2 sqrt(2) sin(t / 2)
  for (int i = 0; i < 3; ++i) turned2 += is.getBasis()[i].distance2(was.getBasis()[i]);
  return is.getOrigin().distance(was.getOrigin()) + size * btSqrt(turned2 / 2);
}

}  // namespace

btScalar motionBetween(const Placed& before, const Placed& now, btScalar size_a, btScalar size_b) {
  // Contact is where both are, so within the smaller one.
  return size_b < size_a ? motionIn(before.a, before.b, now.a, now.b, size_b)
                         : motionIn(before.b, before.a, now.b, now.a, size_a);
}

void carry(const std::vector<ContactPatch>& measured, const Placed& then, const btVector3& origin_then,
           const Placed& now, const btVector3& origin_now, std::vector<ContactPatch>& patches) {
  const btMatrix3x3 turn_a = now.a.getBasis() * then.a.getBasis().transpose();
  const btMatrix3x3 turn_b = now.b.getBasis() * then.b.getBasis().transpose();
  const btVector3 to_b_then = then.b.getOrigin() - origin_then, to_b_now = now.b.getOrigin() - origin_now;
  patches = measured;
  for (ContactPatch& patch : patches) {
    patch.normal = turn_a * patch.normal;
    patch.centre = turn_a * patch.centre;
    for (int i = 0; i < patch.count; ++i) {
      ContactPoint& point = patch.points[i];
      const btVector3 on_a = turn_a * (point.on_b + point.normal * point.depth);
      point.normal = turn_a * point.normal;
      point.on_b = turn_b * (point.on_b - to_b_then) + to_b_now;
      point.depth = (on_a - point.on_b).dot(point.normal);
    }
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
