#include "innersphere/contact_drawer.hpp"

#include <cmath>

#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btIDebugDraw.h>

#include "bullet/registration.hpp"
#include "innersphere/pair_overlaps.hpp"
#include "shape/placed_packing.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

const btVector3 kPatchColour(btScalar(0.2), btScalar(0.4), 1);
const btVector3 kNormalColour(1, btScalar(0.2), btScalar(0.2));
const btVector3 kVolumeColour(1, btScalar(0.2), 1);
const btVector3 kSphereColour(1, btScalar(0.8), btScalar(0.2));
constexpr btScalar kWeight = btScalar(9.81);
constexpr btScalar kShortest = btScalar(0.1);

/// Points are kept in no order around the patch: the fourth may lie across from any side.
void drawOutline(const btPersistentManifold& manifold, btIDebugDraw& drawer) {
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    for (int k = 0; k < i; ++k)
      drawer.drawLine(manifold.getContactPoint(i).getPositionWorldOnB(),
                      manifold.getContactPoint(k).getPositionWorldOnB(), kPatchColour);
  }
}

void drawNormals(const btPersistentManifold& manifold, btScalar time_step, btIDebugDraw& drawer) {
  btScalar size = BT_LARGE_FLOAT, mass = 0;
  for (const btCollisionObject* object : {manifold.getBody0(), manifold.getBody1()}) {
    if (!object->getCollisionShape()->isInfinite())
      size = btMin(size, object->getCollisionShape()->getAngularMotionDisc());
    const btRigidBody* body = btRigidBody::upcast(object);
    if (body != nullptr && body->getInvMass() > 0) mass = btMax(mass, 1 / body->getInvMass());
  }
  const btScalar weight = mass * kWeight * time_step;
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& point = manifold.getContactPoint(i);
    const btScalar load = weight > 0 ? btMin(point.getAppliedImpulse() / weight, btScalar(1)) : btScalar(0);
    const btScalar length = size * btMax(kShortest, load);
    const btVector3& from = point.getPositionWorldOnB();
    drawer.drawLine(from, from + point.m_normalWorldOnB * length, kNormalColour);
  }
}

void drawSpheres(const btCollisionShape& shape, const btTransform& world, btIDebugDraw& drawer) {
  if (const PackingShape* packing = PackingShape::from(&shape)) {
    const PlacedPacking body(*packing, world, Estimator::raw, 0);
    for (std::size_t i = 0; i < body.count(); ++i) {
      drawer.drawSphere(body.ownRadius(i),
                        btTransform(body.world.getBasis(), body.origin() + body.centreOf(i)), kSphereColour);
    }
  } else if (shape.isCompound()) {
    const auto& compound = static_cast<const btCompoundShape&>(shape);
    for (int i = 0; i < compound.getNumChildShapes(); ++i)
      drawSpheres(*compound.getChildShape(i), world * compound.getChildTransform(i), drawer);
  }
}

}  // namespace

void ContactDrawer::updateAction(btCollisionWorld*, btScalar time_step) {
  time_step_ = time_step;
}

void ContactDrawer::debugDraw(btIDebugDraw* drawer) {
  auto* dispatcher = dynamic_cast<btCollisionDispatcher*>(world_.getDispatcher());
  const std::shared_ptr<Registration> registration = Registration::find(dispatcher);
  if (drawer == nullptr || !registration) return;
  static thread_local btManifoldArray manifolds;
  manifolds.resize(0);
  registration->table().appendManifolds(manifolds);
  for (int m = 0; m < manifolds.size(); ++m) {
    if (options_.patches) drawOutline(*manifolds[m], *drawer);
    if (options_.normals) drawNormals(*manifolds[m], time_step_, *drawer);
  }
  if (options_.volumes) {
    for (const PairOverlap& pair : pairOverlaps(dispatcher)) {
      const double radius = std::cbrt(pair.volume * 3 / (4 * M_PI));
      if (radius > 0) drawer->drawSphere(pair.centroid, btScalar(radius), kVolumeColour);
    }
  }
  if (options_.spheres) {
    const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i)
      drawSpheres(*objects[i]->getCollisionShape(), objects[i]->getWorldTransform(), *drawer);
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
