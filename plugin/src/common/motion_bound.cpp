#include "common/motion_bound.hpp"

#include <cmath>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

btScalar speedBetween(const Motion& a, const Motion& b) {
  return (a.velocity - b.velocity).length() + a.rim_speed + b.rim_speed;
}

}  // namespace

btVector3 accelerationOf(const btCollisionObject& object) {
  const btRigidBody* body = btRigidBody::upcast(&object);
  if (body == nullptr || !(body->getInvMass() > 0)) return {0, 0, 0};
  const btVector3 acceleration = body->getTotalForce() * body->getInvMass() * body->getLinearFactor();
  return std::isfinite(acceleration.length2()) ? acceleration : btVector3(0, 0, 0);
}

btVector3 pushIn(const btCollisionObject& object, btScalar time_step) {
  const btRigidBody* body = btRigidBody::upcast(&object);
  if (body == nullptr || !(body->getInvMass() > 0)) return {0, 0, 0};
  const btVector3& force = body->getTotalForce();
  // Outside of a step there is none, not even gravity.
  if (force.isZero()) return force;
  const btVector3 push =
      (force * body->getInvMass() - body->getGravity()) * body->getLinearFactor() * time_step;
  return std::isfinite(push.length2()) ? push : btVector3(0, 0, 0);
}

Motion::Motion(const btCollisionObject& object, const BodyVelocity& now, const btVector3& push)
    : size(BT_LARGE_FLOAT) {
  if (object.getCollisionShape()->isInfinite()) return;
  size = object.getCollisionShape()->getAngularMotionDisc();
  if (object.isStaticObject()) return;
  if (object.getCcdMotionThreshold() > 0) swept_from = object.getCcdMotionThreshold();
  velocity = now.linear + push;
  rim_speed = now.spin.length() * size;
}

bool isSwept(const Motion& a, const Motion& b, btScalar time_step) {
  return speedBetween(a, b) * time_step > btMin(a.swept_from, b.swept_from);
}

btScalar speculativeDistance(const Motion& a, const Motion& b, btScalar time_step) {
  const btScalar way = speedBetween(a, b) * time_step;
  return isSwept(a, b, time_step) ? way : btMin(way, btMin(a.size, b.size));
}

btScalar travelBetween(const btTransform& before, const btTransform& now, btScalar size) {
  btScalar turned2 = 0;  // a turn by t changes the axes by 2 sqrt(2) sin(t / 2)
  for (int i = 0; i < 3; ++i) turned2 += now.getBasis()[i].distance2(before.getBasis()[i]);
  return now.getOrigin().distance(before.getOrigin()) + size * btSqrt(turned2 / 2);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
