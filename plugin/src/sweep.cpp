#include "sweep.hpp"

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

struct Motion {
  explicit Motion(const btCollisionObject& object) {
    if (object.getCollisionShape()->isInfinite()) return;
    size = object.getCollisionShape()->getAngularMotionDisc();
    const btRigidBody* body = btRigidBody::upcast(&object);
    if (body == nullptr || body->isStaticObject()) return;
    velocity = body->getLinearVelocity();
    rim_speed = body->getAngularVelocity().length() * size;
  }
  btVector3 velocity{0, 0, 0};
  btScalar rim_speed = 0;
  btScalar size = BT_LARGE_FLOAT;
};

}  // namespace

btScalar sweepOf(const btCollisionObject& a, const btCollisionObject& b, btScalar time_step) {
  const Motion of_a(a), of_b(b);
  const btScalar speed = (of_a.velocity - of_b.velocity).length() + of_a.rim_speed + of_b.rim_speed;
  return btMin(speed * time_step, btMin(of_a.size, of_b.size) / 2);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
