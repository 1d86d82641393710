#include "solver/solver_bodies.hpp"

#include <algorithm>
#include <cmath>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <LinearMath/btTransformUtil.h>

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// The rotation of a spin [rad/s] that lasts for a time [s].
btQuaternion rotationOf(const btVector3& spin, btScalar time) {
  const btScalar half = spin.length() * time / 2;
  constexpr btScalar kSmall = btScalar(0.01);
  // sin(x) / x to the last bit of single precision; nothing is divided by zero.
  const btScalar sinc = half < kSmall ? 1 - half * half / 6 : std::sin(half) / half;
  const btVector3 axis = spin * (time / 2 * sinc);
  return btQuaternion(axis.x(), axis.y(), axis.z(), std::cos(half));
}

/// How a rotation changes a vector.
btVector3 changeBy(const btQuaternion& rotation, const btVector3& v) {
  const btVector3 axis(rotation.x(), rotation.y(), rotation.z()), across = axis.cross(v);
  return (across * rotation.w() + axis.cross(across)) * 2;
}

bool hasNumbers(const btRigidBody& body) {
  // Squares of velocities are formed: they have to be finite, too.
  return isFinite(body.getWorldTransform()) && std::isfinite(body.getLinearVelocity().length2()) &&
         std::isfinite(body.getAngularVelocity().length2()) && isFinite(body.getTotalForce()) &&
         isFinite(body.getTotalTorque()) && std::isfinite(body.getInvMass()) &&
         isFinite(body.getInvInertiaDiagLocal()) && isFinite(body.getLinearFactor()) &&
         isFinite(body.getAngularFactor());
}

bool canBeMoved(const btRigidBody& body) {
  const bool yields = body.getInvMass() > 0 || !body.getInvInertiaDiagLocal().isZero();
  return yields && !body.isStaticOrKinematicObject() && body.getActivationState() != DISABLE_SIMULATION;
}

btScalar inverseOrZero(btScalar x) {
  return x > 0 ? 1 / x : btScalar(0);
}

}  // namespace

void SolverBodies::begin(int count, btScalar time_step) {
  time_step_ = time_step;
  broken_ = false;
  broken_driven_ = nullptr;
  found_.resize(static_cast<std::size_t>(count));
}

void SolverBodies::find(int begin, int end, btCollisionObject** objects) {
  for (int i = begin; i < end; ++i) {
    btRigidBody* rigid = btRigidBody::upcast(objects[i]);
    found_[static_cast<std::size_t>(i)] = rigid != nullptr && canBeMoved(*rigid) ? rigid : nullptr;
  }
}

void SolverBodies::collect() {
  found_.erase(std::remove(found_.begin(), found_.end(), nullptr), found_.end());
  movable_ = static_cast<int>(found_.size());
  bodies_.resize(found_.size() + 1);
  states_.resize(bodies_.size());
  bodies_.back() = Body();  // the fixed world
  states_.back() = BodyState();
  motions_.clear();
}

void SolverBodies::fill(int begin, int end) {
  for (std::size_t i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
    Body& body = bodies_[i] = Body();
    states_[i] = BodyState();
    body.rigid = found_[i];
    body.rigid->setCompanionId(static_cast<int>(i));
    body.broken = !hasNumbers(*body.rigid);
    if (body.broken)
      broken_ = true;
    else
      fill(body, states_[i]);
  }
}

void SolverBodies::fill(Body& body, BodyState& state) {
  const btRigidBody& rigid = *body.rigid;
  body.origin = rigid.getWorldTransform().getOrigin();
  body.rotation = rigid.getWorldTransform().getRotation().normalized();
  body.mass = rigid.getMass();
  body.force = rigid.getTotalForce() * rigid.getInvMass();
  body.torque = rigid.getTotalTorque();
  body.inverse_inertia = rigid.getInvInertiaDiagLocal();
  body.angular_factor = rigid.getAngularFactor();
  const btVector3& inverse = body.inverse_inertia;
  body.inertia.setValue(inverseOrZero(inverse.x()), inverseOrZero(inverse.y()), inverseOrZero(inverse.z()));
  constexpr int kGyroscopic = BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT |
                              BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD |
                              BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY;
  const bool free = body.angular_factor == btVector3(1, 1, 1) && inverse[inverse.minAxis()] > 0;
  body.round = free && inverse.x() == inverse.y() && inverse.y() == inverse.z();
  body.tumbles = free && !body.round && (rigid.getFlags() & kGyroscopic) != 0;
  btVector3 centre;
  if (rigid.getCollisionShape() != nullptr) {
    rigid.getCollisionShape()->getBoundingSphere(centre, body.size);
    body.size *= 2;
  }
  state.velocity = rigid.getLinearVelocity();
  state.spin = rigid.getAngularVelocity();
  state.inverse_mass = rigid.getLinearFactor() * rigid.getInvMass();
  updateInertia(body, state);
}

const btRigidBody* SolverBodies::broken() const {
  if (!broken_) return nullptr;
  const auto body = std::find_if(bodies_.begin(), bodies_.end(), [](const Body& b) { return b.broken; });
  return body != bodies_.end() ? body->rigid : broken_driven_;
}

int SolverBodies::placeOf(const btCollisionObject& object) const {
  const int id = object.getCompanionId();
  if (id < 0 || id >= movable_ || bodies_[static_cast<std::size_t>(id)].rigid != &object) return kOther;
  return bodies_[static_cast<std::size_t>(id)].broken ? kBroken : id;
}

int SolverBodies::indexOf(const btCollisionObject& object) {
  const int place = placeOf(object);
  if (place != kOther) return place;
  const btRigidBody* rigid = btRigidBody::upcast(&object);
  const bool kinematic = rigid != nullptr && rigid->isKinematicObject();
  if (rigid == nullptr ||
      (!kinematic && rigid->getLinearVelocity().isZero() && rigid->getAngularVelocity().isZero()))
    return movable_;
  if (!hasNumbers(*rigid)) {
    broken_ = true;
    broken_driven_ = rigid;
    return kBroken;
  }
  if (bodies_.back().rigid == rigid) return static_cast<int>(bodies_.size()) - 1;
  DrivenMotion motion{.velocity = rigid->getLinearVelocity(), .spin = rigid->getAngularVelocity()};
  if (kinematic) motion = driven_bodies_.motionOf(*rigid, time_step_);
  if (motion.velocity.isZero() && motion.spin.isZero()) return movable_;
  motions_.push_back(motion);
  Body& body = bodies_.emplace_back();
  BodyState& state = states_.emplace_back();
  body.rigid = const_cast<btRigidBody*>(rigid);
  body.given = rigid->getWorldTransform();
  state.velocity = motion.velocity;
  state.spin = motion.spin;
  btTransform start = body.given;
  if (kinematic)  // Bullet has moved it already
    btTransformUtil::integrateTransform(body.given, -state.velocity, -state.spin, time_step_, start);
  body.origin = start.getOrigin();
  body.rotation = start.getRotation();
  return static_cast<int>(bodies_.size()) - 1;
}

void SolverBodies::follow(int index) {
  if (index < 0) return;
  Body& body = bodies_[static_cast<std::size_t>(index)];
  body.followed = true;
  if (index > movable_) body.rigid->setWorldTransform(poseOf(body, states_[static_cast<std::size_t>(index)]));
}

btScalar SolverBodies::largestAcceleration() const {
  btScalar largest = 0;
  for (const Body& body : bodies_) largest = std::max(largest, body.force.length2());
  return std::sqrt(largest);
}

void SolverBodies::accelerate(int begin, int end, btScalar substep) {
  for (int i = begin; i < end; ++i) {
    const Body& body = bodies_[static_cast<std::size_t>(i)];
    BodyState& state = states_[static_cast<std::size_t>(i)];
    state.velocity += body.force * substep;
    if (!body.torque.isZero()) state.spin += state.inverseInertiaTimes(body.torque * substep);
    state.push(state.impulse, state.angular_impulse);
    state.impulse.setZero();
    state.angular_impulse.setZero();
  }
}

void SolverBodies::updateInertia(const Body& body, BodyState& state) {
  const btMatrix3x3 axes(state.turned * body.rotation);
  const btVector3& f = body.angular_factor;
  const btVector3 x = axes[0] * f.x(), y = axes[1] * f.y(), z = axes[2] * f.z();
  const btVector3 of_x = x * body.inverse_inertia, of_y = y * body.inverse_inertia;
  state.xx = of_x.dot(x);
  state.xy = of_x.dot(y);
  state.xz = of_x.dot(z);
  state.yy = of_y.dot(y);
  state.yz = of_y.dot(z);
  state.zz = (z * body.inverse_inertia).dot(z);
}

/// Nothing but the orientation changes of a body that keeps its spin. One that tumbles keeps its angular
/// momentum: its spin follows from that and the orientation, in the middle of the way as at its end, which is
/// of second order in the substep.
void SolverBodies::turn(const Body& body, BodyState& state, btScalar substep) const {
  if (state.spin.isZero()) return;
  if (!body.tumbles) {
    state.turned = (rotationOf(state.spin, substep) * state.turned).normalized();
    if (!body.round) updateInertia(body, state);
    return;
  }
  const btQuaternion start = (state.turned * body.rotation).normalized();
  const btVector3 momentum = quatRotate(start.inverse(), state.spin) * body.inertia;  // in its own frame
  // Only changes are turned, and multiplied by the inertia and its inverse. None of that is so to the last
  // bit, and thousands of substeps would add up what is missing.
  const auto spinAfter = [&](const btQuaternion& turn) {
    const btQuaternion rotation = (turn * start).normalized();
    const btVector3 change = changeBy(rotation.inverse() * start, momentum) * body.inverse_inertia;
    return state.spin + changeBy(turn, state.spin) + quatRotate(rotation, change);
  };
  const btVector3 middle = spinAfter(rotationOf(state.spin, substep / 2));
  const btQuaternion turn = rotationOf(middle, substep);
  state.spin = spinAfter(turn);
  state.turned = (turn * state.turned).normalized();
  updateInertia(body, state);
}

void SolverBodies::move(int begin, int end, btScalar substep) {
  for (int i = begin; i < end; ++i) {
    const Body& body = bodies_[static_cast<std::size_t>(i)];
    BodyState& state = states_[static_cast<std::size_t>(i)];
    state.moved = state.moved + state.velocity * substep;
    turn(body, state, substep);
    if (!body.followed) continue;
    body.rigid->setWorldTransform(poseOf(body, state));
    body.rigid->setLinearVelocity(state.velocity);
    body.rigid->setAngularVelocity(state.spin);
    body.rigid->updateInertiaTensor();
  }
}

template <typename Visit>
void SolverBodies::forEachDriven(const Visit& visit) {
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const std::size_t body = static_cast<std::size_t>(movable_) + 1 + i;
    visit(bodies_[body], states_[body], motions_[i]);
  }
}

void SolverBodies::startDriven(btScalar substep) {
  const btScalar before = (substep - time_step_) / 2;  // than the middle of the step
  forEachDriven([&](const Body&, BodyState& state, const DrivenMotion& motion) {
    state.velocity += motion.acceleration * before;
    state.spin += motion.angular_acceleration * before;
  });
}

void SolverBodies::moveDriven(btScalar substep) {
  forEachDriven([&](const Body& body, BodyState& state, const DrivenMotion& motion) {
    // A static body with a velocity is a belt: its surface moves, it does not.
    if (!body.rigid->isKinematicObject()) return;
    state.moved = state.moved + state.velocity * substep;
    state.turned = (rotationOf(state.spin, substep) * state.turned).normalized();
    if (body.followed) body.rigid->setWorldTransform(poseOf(body, state));
    state.velocity += motion.acceleration * substep;
    state.spin += motion.angular_acceleration * substep;
  });
}

btTransform SolverBodies::poseOf(const Body& body, const BodyState& state) const {
  return btTransform(state.turned * body.rotation, body.origin + state.moved);
}

btVector3 SolverBodies::startOf(int index, const btVector3& point) const {
  const Body& body = bodies_[static_cast<std::size_t>(index)];
  if (index <= movable_ || !body.rigid->isKinematicObject()) return point;
  return btTransform(body.rotation, body.origin) * body.given.invXform(point);
}

void SolverBodies::finish(int begin, int end) {
  for (std::size_t i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
    Body& body = bodies_[i];
    BodyState& state = states_[i];
    body.rigid->setCompanionId(-1);
    if (body.broken) {
      // Else Bullet would take it to nowhere, and what it touches after it.
      body.rigid->setLinearVelocity(btVector3(0, 0, 0));
      body.rigid->setAngularVelocity(btVector3(0, 0, 0));
      continue;
    }
    if (!isFinite(poseOf(body, state)) || !std::isfinite(state.velocity.length2()) ||
        !std::isfinite(state.spin.length2())) {
      state = BodyState();
      body.broken = true;
      broken_ = true;
    }
    // Bullet goes on from here by the velocities, over the whole step.
    btTransform start;
    btTransformUtil::integrateTransform(poseOf(body, state), -state.velocity, -state.spin, time_step_, start);
    body.rigid->setWorldTransform(start);
    body.rigid->setLinearVelocity(state.velocity);
    body.rigid->setAngularVelocity(state.spin);
  }
}

void SolverBodies::release() {
  for (std::size_t i = static_cast<std::size_t>(movable_) + 1; i < bodies_.size(); ++i) {
    if (bodies_[i].followed) bodies_[i].rigid->setWorldTransform(bodies_[i].given);
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
