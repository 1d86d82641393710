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
constexpr btScalar kPosesApart = btScalar(0.25);
/// In ways from pose to pose: contacts are looked for this far ahead. That is beyond the next pose, for what
/// meets later must not turn into the other body when the rest is stopped.
constexpr btScalar kLookAhead = 6;
/// The same for two packings: spheres of both that are enlarged by more do not tell the sides of a thin wall.
constexpr btScalar kPackingsLookAhead = 3;
/// In sizes of the smaller body: what would sink in by less in the step does not stop the bodies. They slide
/// on it, and may meet something else.
constexpr btScalar kGrazes = kPosesApart / 2;
/// Bullet turns no body by more than this in a step [rad].
constexpr btScalar kMostTurn = SIMD_HALF_PI / 2;
/// There are no more poses than this: they are further apart then.
constexpr btScalar kMostPoses = 1000;

/// Where a shape is after a part `time` of a step, if its body has its origin at `centre` now and at
/// `centre` + `moved` then.
btTransform movedOn(const btTransform& place, const btVector3& centre, const btVector3& moved,
                    const btVector3& spin, btScalar time, btScalar time_step) {
  const btScalar rate = btMin(spin.length(), kMostTurn / time_step);
  const btMatrix3x3 turn =
      rate > 0 ? btMatrix3x3(btQuaternion(spin.normalized(), rate * time)) : btMatrix3x3::getIdentity();
  return btTransform(turn * place.getBasis(), centre + moved + turn * (place.getOrigin() - centre));
}

}  // namespace

Sweep::Sweep(const PackingShape& a, const btCollisionShape& b, const Placed& now, const StepAhead& step)
    : a_(&a), b_(&b), now_(now), step_(step), placed_(now), ahead_(step) {
  if (!step.motion.isSwept()) return;
  const btScalar apart = btMax(kPosesApart * step.size, step.needed / kMostPoses);
  poses_ = static_cast<int>(std::ceil(step.needed / apart));
  const btScalar look_ahead = PackingShape::from(&b) == nullptr ? kLookAhead : kPackingsLookAhead;
  step_.needed = btMin(step.needed, look_ahead * apart);
  ahead_ = step_;
}

bool Sweep::goesOn(const std::vector<ContactPatch>& found) {
  if (poses_ <= 1) return false;
  if (pose_ == 0) kept_ = found;
  const auto stopsAt = [&](const ContactPatch& patch) { return stops(patch); };
  if (std::any_of(found.begin(), found.end(), stopsAt)) {
    // All of the first place where they are about to meet, of others what they meet there.
    if (!stopped_) kept_.clear();
    for (const ContactPatch& patch : found) {
      if (!stopped_ || stops(patch)) keep(patch);
    }
    stopped_ = true;
    deflect(found);
    const btScalar left = (ahead_.motion.a().linear - ahead_.motion.b().linear).length() * ahead_.time_step;
    if (left < kPosesApart * step_.size) return false;
  }
  do {
    if (++pose_ == poses_) break;
    advance();
  } while (!isNear());
  if (pose_ < poses_) return true;
  if (hasKept()) return false;
  *this = Sweep(*a_, *b_, now_, step_);
  poses_ = 1;
  return true;
}

void Sweep::finish(std::vector<ContactPatch>& patches) const {
  if (hasKept()) patches = kept_;
}

/// How much nearer the bodies have come on their way to the pose, along the normal of a contact there.
btScalar Sweep::wayTo(const ContactPoint& point) const {
  const PairMotion& motion = ahead_.motion;
  const btVector3 moved = moved_a_ - motion.b().linear * time_;
  const btScalar turning =
      motion.approachAt(point.on_b, point.normal) - (motion.a().linear - motion.b().linear).dot(point.normal);
  return btMax(btScalar(0), moved.dot(point.normal) + turning * time_);
}

/// Whether the bodies meet there before the next pose, and it is more than a grazing that the first pose has
/// seen, too.
bool Sweep::stops(const ContactPatch& patch) const {
  const auto end = patch.points.begin() + patch.count;
  return std::any_of(patch.points.begin(), end, [&](const ContactPoint& point) { return stops(point); });
}

bool Sweep::stops(const ContactPoint& point) const {
  const btScalar approach = ahead_.motion.approachAt(point.on_b, point.normal);
  if (!(point.depth + approach * step_.time_step / btScalar(poses_) > 0)) return false;
  return point.depth + approach * ahead_.time_step > kGrazes * step_.size ||
         point.depth - wayTo(point) < -step_.needed;
}

/// Takes a patch that was found at the pose back to the first one.
void Sweep::keep(ContactPatch patch) {
  const btVector3 origin = a_->impl().toWorld(placed_.a).getOrigin() - a_->impl().toWorld(now_.a).getOrigin();
  const btVector3 moved_b = ahead_.motion.b().linear * time_;
  const btVector3 moved = moved_a_ - moved_b;
  patch.centre += origin - moved_b;
  for (int i = 0; i < patch.count; ++i) {
    ContactPoint& point = patch.points[i];
    point.depth -= wayTo(point);
    point.aside = point.normal * moved.dot(point.normal) - moved;
    point.on_b += origin - moved_b;
  }
  kept_.push_back(patch);
}

/// Lets the way of A go along what stops it.
void Sweep::deflect(const std::vector<ContactPatch>& found) {
  const PairMotion motion = ahead_.motion;
  BodyVelocity a = motion.a();
  for (const ContactPatch& patch : found) {
    const btScalar approach = (a.linear - motion.b().linear).dot(patch.normal);
    if (approach > 0 && stops(patch)) a.linear -= patch.normal * approach;
  }
  ahead_.motion = PairMotion(motion.originA(), a, motion.originB(), motion.b(), true);
}

/// Goes to the next pose along the way.
void Sweep::advance() {
  const btScalar time = step_.time_step / btScalar(poses_);
  const BodyVelocity a = ahead_.motion.a(), b = ahead_.motion.b();
  time_ += time;
  ahead_.time_step -= time;
  moved_a_ += a.linear * time;
  const btVector3 moved_b = b.linear * time_;
  const btVector3 origin = a_->impl().toWorld(now_.a).getOrigin();
  const btVector3 centre_a = origin + step_.motion.originA(), centre_b = origin + step_.motion.originB();
  placed_.a = movedOn(now_.a, centre_a, moved_a_, a.spin, time_, step_.time_step);
  placed_.b = movedOn(now_.b, centre_b, moved_b, b.spin, time_, step_.time_step);
  const btVector3 origin_then = a_->impl().toWorld(placed_.a).getOrigin();
  ahead_.motion = PairMotion(centre_a + moved_a_ - origin_then, a, centre_b + moved_b - origin_then, b, true);
}

/// Whether the boxes of the shapes are as near each other as contacts are looked for.
bool Sweep::isNear() const {
  btVector3 min_a, max_a, min_b, max_b;
  a_->getAabb(placed_.a, min_a, max_a);
  b_->getAabb(placed_.b, min_b, max_b);
  const btVector3 ahead(step_.needed, step_.needed, step_.needed);
  return TestAabbAgainstAabb2(min_a - ahead, max_a + ahead, min_b, max_b);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
