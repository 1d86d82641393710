#include "solver/driven_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// The part of what is gained that was gained in the step before, too.
btVector3 steady(const btVector3& gained, const btVector3& before) {
  const btScalar both = gained.dot(before), all = gained.length2();
  return both > 0 ? gained * btMin(both / all, btScalar(1)) : btVector3(0, 0, 0);
}

/// The turn from one rotation to another, about the axis of the world that it is along [rad].
btVector3 turnBetween(const btQuaternion& from, const btQuaternion& to) {
  btQuaternion turn = to * from.inverse();
  if (turn.w() < 0) turn = -turn;
  const btVector3 axis(turn.x(), turn.y(), turn.z());
  const btScalar sine = axis.length();
  return sine > 0 ? axis * (2 * std::atan2(sine, turn.w()) / sine) : axis;
}

}  // namespace

DrivenMotion DrivenBodies::motionOf(const btRigidBody& body, btScalar time_step) {
  if (!now_.empty() && now_.back().body == &body) return now_.back().motion;  // of its next contact
  // Twice what a cosine near 1 leaves of an angle.
  const btScalar rounding = 4 * std::sqrt(SIMD_EPSILON);
  Past now{.body = &body, .rotation = body.getWorldTransform().getRotation()};
  DrivenMotion& motion = now.motion;
  motion.velocity = body.getLinearVelocity();
  motion.spin = body.getAngularVelocity();
  const auto past =
      std::lower_bound(before_.begin(), before_.end(), &body,
                       [](const Past& p, const btRigidBody* b) { return std::less<>()(p.body, b); });
  const bool known = past != before_.end() && past->body == &body;
  if (known) {
    const btVector3 turn = turnBetween(past->rotation, now.rotation);
    now.turned = !turn.isZero();
    // A belt's pose stays, and that of a body in the second of several steps of a frame.
    if (now.turned && past->turned && turn.distance(motion.spin * time_step) < rounding)
      motion.spin = turn / time_step;
    now.gained = motion.velocity - past->motion.velocity;
    now.spin_gained = motion.spin - past->motion.spin;
    motion.acceleration = steady(now.gained, past->gained) / time_step;
    motion.angular_acceleration = steady(now.spin_gained, past->spin_gained) / time_step;
  }
  now_.push_back(now);
  return now.motion;
}

void DrivenBodies::endStep() {
  std::sort(now_.begin(), now_.end(),
            [](const Past& a, const Past& b) { return std::less<>()(a.body, b.body); });
  std::swap(before_, now_);
  now_.clear();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
