#include "observation.hpp"

#include <algorithm>
#include <limits>

#include "bullet_math.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

Vec3d plus(const Vec3d& a, const btVector3& b) {
  return {a[0] + b.x(), a[1] + b.y(), a[2] + b.z()};
}

void addMotion(const btRigidBody& body, const btVector3& gravity, StepRecord& record) {
  const btScalar mass = 1 / body.getInvMass();
  const btVector3 velocity = body.getLinearVelocity();
  const btVector3 turn = body.getAngularVelocity();
  const btVector3 place = body.getCenterOfMassPosition();
  const btMatrix3x3 axes = body.getCenterOfMassTransform().getBasis();
  const btVector3 local_turn = turn * axes;  // transposed: into the body's frame
  const btVector3 spin = axes * (local_turn / body.getInvInertiaDiagLocal());
  record.kinetic += 0.5 * mass * velocity.length2() + 0.5 * turn.dot(spin);
  record.potential -= mass * gravity.dot(place);
  record.momentum = plus(record.momentum, mass * velocity);
  record.angular_momentum = plus(record.angular_momentum, mass * place.cross(velocity) + spin);
  record.fastest = std::max<double>(record.fastest, velocity.length());
  record.fastest_turn = std::max<double>(record.fastest_turn, turn.length());
}

// Calls visit(manifold, point) for each point that overlaps, or is about to and pushes.
template <typename Visit>
void forEachContact(SceneWorld& world, const Visit& visit) {
  btDispatcher* dispatcher = world.bullet().getDispatcher();
  for (int i = 0; i < dispatcher->getNumManifolds(); ++i) {
    const btPersistentManifold* manifold = dispatcher->getManifoldByIndexInternal(i);
    for (int k = 0; k < manifold->getNumContacts(); ++k) {
      const btManifoldPoint& point = manifold->getContactPoint(k);
      if (point.getDistance() <= 0 || point.getAppliedImpulse() > 0) visit(*manifold, point);
    }
  }
}

void addContacts(SceneWorld& world, StepRecord& record) {
  const auto sizeOf = [&world](const btCollisionObject* object) {
    for (const SceneBody& body : world.bodies()) {
      if (body.body.get() == object && body.moves()) return body.size;
    }
    return std::numeric_limits<double>::infinity();
  };
  const btPersistentManifold* last = nullptr;
  double size = 0;
  forEachContact(world, [&](const btPersistentManifold& manifold, const btManifoldPoint& point) {
    if (&manifold != last) size = std::min(sizeOf(manifold.getBody0()), sizeOf(manifold.getBody1()));
    last = &manifold;
    const double overlap = -point.getDistance();
    ++record.contacts;
    record.overlap = std::max(record.overlap, overlap);
    record.relative_overlap = std::max(record.relative_overlap, overlap / size);
  });
}

}  // namespace

StepRecord observe(SceneWorld& world, double time, double step_time) {
  StepRecord record;
  record.time = time;
  record.step_time = step_time;
  for (const SceneBody& body : world.bodies()) {
    if (body.moves()) addMotion(*body.body, world.bullet().getGravity(), record);
  }
  addContacts(world, record);
  return record;
}

void appendStates(const SceneWorld& world, std::vector<BodyState>& states) {
  for (const SceneBody& entry : world.bodies()) {
    const btRigidBody& body = *entry.body;
    const btQuaternion q = body.getWorldTransform().getRotation();
    states.push_back({toVec3d(body.getWorldTransform().getOrigin()),
                      {double(q.x()), double(q.y()), double(q.z()), double(q.w())},
                      toVec3d(body.getLinearVelocity()),
                      toVec3d(body.getAngularVelocity())});
  }
}

std::vector<ContactMark> contactMarks(SceneWorld& world) {
  std::vector<ContactMark> marks;
  forEachContact(world, [&](const btPersistentManifold&, const btManifoldPoint& point) {
    const btVector3 middle = (point.getPositionWorldOnA() + point.getPositionWorldOnB()) / 2;
    ContactMark& mark = marks.emplace_back();
    for (int k = 0; k < 3; ++k) {
      mark.point[k] = static_cast<float>(middle[k]);
      mark.normal[k] = static_cast<float>(point.m_normalWorldOnB[k]);
    }
  });
  return marks;
}

}  // namespace innersphere::demo
