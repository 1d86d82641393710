#include "narrow_phase/sweep.hpp"

#include <algorithm>
#include <cmath>

#include <LinearMath/btAabbUtil2.h>
#include <LinearMath/btQuaternion.h>

#include "shape/packing_shape_impl.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// In sizes of the smaller body: poses are no further apart.
constexpr btScalar kPosesApart = btScalar(0.5);
/// In sizes of the smaller body: contacts are looked for this far ahead of a pose. From the one before bodies
/// meet, that is as far as the hindmost part of the smaller body.
constexpr btScalar kLookAhead = 2 + kPosesApart;
/// In sizes of the smaller body: what would sink in by less in the step does not stop the bodies. They slide
/// on it, and may meet something else.
constexpr btScalar kGrazes = kPosesApart / 2;
/// Bullet turns no body by more than this in a step [rad].
constexpr btScalar kMostTurn = SIMD_HALF_PI / 2;
/// There are no more poses than this. Beyond that each looks further ahead.
constexpr btScalar kMostPoses = 1000;

/// Where a shape is after `time` of a step, if its body has its origin at `centre` now.
btTransform movedOn(const btTransform& place, const btVector3& centre, const BodyVelocity& velocity,
                    btScalar time, btScalar time_step) {
  const btScalar rate = btMin(velocity.spin.length(), kMostTurn / time_step);
  const btMatrix3x3 turn = rate > 0 ? btMatrix3x3(btQuaternion(velocity.spin.normalized(), rate * time))
                                    : btMatrix3x3::getIdentity();
  return btTransform(turn * place.getBasis(),
                     centre + velocity.linear * time + turn * (place.getOrigin() - centre));
}

}  // namespace

Sweep::Sweep(const PackingShape& a, const btCollisionShape& b, const Placed& now, const StepAhead& step)
    : a_(&a), b_(&b), now_(now), step_(step), placed_(now), ahead_(step) {
  if (!step.motion.isSwept()) return;
  const btScalar poses = std::ceil(step.needed / (kPosesApart * step.size));
  poses_ = static_cast<int>(btMin(poses, kMostPoses));
  if (poses <= kMostPoses) step_.needed = btMin(step.needed, kLookAhead * step.size);
  ahead_ = step_;
}

bool Sweep::goesOn(const std::vector<ContactPatch>& found) {
  if (poses_ <= 1) return false;
  for (const ContactPatch& patch : found) {
    const auto end = patch.points.begin() + patch.count;
    if (std::any_of(patch.points.begin(), end, [&](const ContactPoint& point) { return stops(point); }))
      return false;
  }
  do {
    if (pose_ + 1 == poses_) {
      poses_ = 0;  // none is left after this one
      goTo(0);
      return true;
    }
    goTo(pose_ + 1);
  } while (!isNear());
  return true;
}

void Sweep::takeBack(std::vector<ContactPatch>& patches) const {
  if (pose_ == 0) return;
  const btVector3 origin = a_->impl().toWorld(placed_.a).getOrigin() - a_->impl().toWorld(now_.a).getOrigin();
  const btVector3 shift = origin - step_.motion.b().linear * time_;
  const btVector3 way = (step_.motion.a().linear - step_.motion.b().linear) * time_;
  for (ContactPatch& patch : patches) {
    patch.centre += shift;
    for (int i = 0; i < patch.count; ++i) {
      ContactPoint& point = patch.points[i];
      const btScalar approach = ahead_.motion.approachAt(point.on_b, point.normal);
      point.depth -= time_ * btMax(approach, btScalar(0));
      point.aside = point.normal * way.dot(point.normal) - way;
      point.on_b += shift;
    }
  }
}

void Sweep::goTo(int pose) {
  pose_ = pose;
  ahead_ = step_;
  placed_ = now_;
  time_ = 0;
  if (pose == 0) return;
  time_ = step_.time_step * btScalar(pose) / btScalar(poses_);
  const PairMotion& motion = step_.motion;
  const btVector3 origin = a_->impl().toWorld(now_.a).getOrigin();
  const btVector3 centre_a = origin + motion.originA(), centre_b = origin + motion.originB();
  placed_.a = movedOn(now_.a, centre_a, motion.a(), time_, step_.time_step);
  placed_.b = movedOn(now_.b, centre_b, motion.b(), time_, step_.time_step);
  const btVector3 origin_then = a_->impl().toWorld(placed_.a).getOrigin();
  ahead_.motion = PairMotion(centre_a + motion.a().linear * time_ - origin_then, motion.a(),
                             centre_b + motion.b().linear * time_ - origin_then, motion.b(), true);
  ahead_.time_step -= time_;
}

/// Whether the boxes of the shapes are as near each other as contacts are looked for.
bool Sweep::isNear() const {
  btVector3 min_a, max_a, min_b, max_b;
  a_->getAabb(placed_.a, min_a, max_a);
  b_->getAabb(placed_.b, min_b, max_b);
  const btVector3 ahead(step_.needed, step_.needed, step_.needed);
  return TestAabbAgainstAabb2(min_a - ahead, max_a + ahead, min_b, max_b);
}

/// Whether the bodies meet there before the next pose, and it is more than a grazing that the first pose has
/// seen, too.
bool Sweep::stops(const ContactPoint& point) const {
  const btScalar approach = ahead_.motion.approachAt(point.on_b, point.normal);
  if (!(point.depth + approach * step_.time_step / btScalar(poses_) > 0)) return false;
  return point.depth + approach * ahead_.time_step > kGrazes * step_.size ||
         point.depth - approach * time_ < -step_.needed;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
