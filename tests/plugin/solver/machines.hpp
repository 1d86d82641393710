// Bodies with joints, for tests and benchmarks of solvers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "solver/solver_world.hpp"

namespace innersphere::test {

/// Links of 1 kg and half a metre hang from the world by hinges, each across the one before; the last one has
/// a mass of its own [kg]. Returns it.
inline btRigidBody& hangChain(SolverWorld& world, int links, btScalar load) {
  const btVector3 half(btScalar(0.05), btScalar(0.05), btScalar(0.25)), up(0, 0, half.z());
  btRigidBody* above = nullptr;
  for (int i = 0; i < links; ++i) {
    btRigidBody& link =
        world.addBox(half, i + 1 == links ? load : 1, btVector3(0, 0, -half.z() * btScalar(2 * i + 1)));
    const btVector3 axis = i % 2 == 0 ? btVector3(0, 1, 0) : btVector3(1, 0, 0);
    if (above == nullptr)
      world.join<btHingeConstraint>(link, up, axis);
    else
      world.join<btHingeConstraint>(*above, link, -up, up, axis, axis);
    above = &link;
  }
  return *above;
}
inline btScalar chainEnd(int links) {
  return btScalar(-0.25 - 0.5 * (links - 1));
}

/// An arm of 1 kg and 1 m, level, with a load of 10 kg fixed to its end, on a motor of 300 N m at most.
struct MotorArm {
  static constexpr double kTorque = 300;
  /// How far it is after a second at 1 rad/s: up to speed it takes I w / (T - M g) [s], half of which it
  /// loses.
  static constexpr double kInertia = 10 * 1.004 + (1 + 0.01) / 3, kWeight = (10 + 0.5) * kGravity,
                          kAngle = 1 - kInertia / (kTorque - kWeight) / 2;

  explicit MotorArm(SolverWorld& world)
      : arm(world.addBox(btVector3(btScalar(0.5), btScalar(0.05), btScalar(0.05)), 1,
                         btVector3(btScalar(0.5), 0, 0))),
        load(world.addBall(btScalar(0.1), 10, btVector3(1, 0, 0))),
        hinge(world.join<btHingeConstraint>(arm, btVector3(btScalar(-0.5), 0, 0), btVector3(0, 1, 0))) {
    btTransform end(btQuaternion::getIdentity(), btVector3(btScalar(0.5), 0, 0));
    world.join<btFixedConstraint>(arm, load, end, btTransform::getIdentity());
  }
  /// Upwards [rad/s]. Bullet's motors have the impulse of a step for a limit.
  void turn(double speed, double step) {
    hinge.enableAngularMotor(true, btScalar(-speed), btScalar(kTorque * step));
  }
  double angle() const {
    const btVector3 along = arm.getWorldTransform().getBasis().getColumn(0);
    return std::atan2(along.z(), along.x());
  }
  /// How far the load is from where it is fixed [m].
  double gap() const {
    return arm.getWorldTransform()(btVector3(btScalar(0.5), 0, 0))
        .distance(load.getWorldTransform().getOrigin());
  }

  btRigidBody &arm, &load;
  btHingeConstraint& hinge;
};

/// A figure of eleven boxes with cone twist joints and hinges with limits, upright over the floor.
class Ragdoll {
 public:
  static constexpr double kSwing = 0.7;          ///< of cone twist joints, both ways [rad]
  static constexpr double kBent = 2, kBack = 0;  ///< limits of hinges [rad]
  struct Joint {
    btRigidBody *a, *b;
    btVector3 in_a, in_b;  ///< the pivot
    btVector3 axis;        ///< of a hinge, or along which a cone twist joint twists
    bool hinge;
  };

  Ragdoll(SolverWorld& world, btScalar height) : world_(world), height_(height) {
    btRigidBody& pelvis = part(0.15, 0.10, 0.10, 10, 0, 0, 1.0);
    btRigidBody& chest = part(0.18, 0.12, 0.20, 20, 0, 0, 1.3);
    btRigidBody& head = part(0.09, 0.10, 0.12, 5, 0, 0, 1.62);
    cone(pelvis, chest, 0, 0, 1.1, 0, 0, 1);
    cone(chest, head, 0, 0, 1.5, 0, 0, 1);
    for (const int side : {-1, 1}) {
      btRigidBody& upper = part(0.15, 0.05, 0.05, 2.5, side * 0.33, 0, 1.42);
      btRigidBody& lower = part(0.15, 0.04, 0.04, 2, side * 0.63, 0, 1.42);
      btRigidBody& thigh = part(0.07, 0.07, 0.20, 8, side * 0.09, 0, 0.7);
      btRigidBody& shin = part(0.05, 0.05, 0.20, 4, side * 0.09, 0, 0.3);
      cone(chest, upper, side * 0.18, 0, 1.42, side, 0, 0);
      cone(pelvis, thigh, side * 0.09, 0, 0.9, 0, 0, -1);
      hinge(upper, lower, side * 0.48, 0, 1.42, 0, 0, -side);
      hinge(thigh, shin, side * 0.09, 0, 0.5, 1, 0, 0);
    }
  }

  /// The farthest that two bodies are apart at a joint [m].
  double gap() const {
    double most = 0;
    for (const Joint& joint : joints) {
      const btVector3 a = joint.a->getWorldTransform()(joint.in_a),
                      b = joint.b->getWorldTransform()(joint.in_b);
      most = std::max(most, double(a.distance(b)));
    }
    return most;
  }
  /// The farthest that a joint is beyond its limits [rad].
  double beyond() const {
    double most = 0;
    for (const Joint& joint : joints) {
      const btMatrix3x3 turned =
          joint.a->getWorldTransform().getBasis().transpose() * joint.b->getWorldTransform().getBasis();
      if (joint.hinge) {
        // About its axis, from how it turns what is across.
        btVector3 across, other;
        btPlaneSpace1(joint.axis, across, other);
        const btVector3 now = turned * across;
        const double angle = std::atan2(now.dot(joint.axis.cross(across)), now.dot(across));
        most = std::max({most, angle - kBent, kBack - angle});
      } else {
        most = std::max(
            most, std::acos(std::clamp(double((turned * joint.axis).dot(joint.axis)), -1.0, 1.0)) - kSwing);
      }
    }
    return most;
  }
  double fastest() const {
    double most = 0;
    for (const btRigidBody* body : bodies) most = std::max(most, double(body->getLinearVelocity().length()));
    return most;
  }

  std::vector<btRigidBody*> bodies;
  std::vector<Joint> joints;

 private:
  btRigidBody& part(double x, double y, double z, double mass, double at_x, double at_y, double at_z) {
    btRigidBody& body = world_.addBox(btVector3(btScalar(x), btScalar(y), btScalar(z)), btScalar(mass),
                                      btVector3(btScalar(at_x), btScalar(at_y), btScalar(at_z) + height_));
    bodies.push_back(&body);
    return body;
  }
  Joint& join(btRigidBody& a, btRigidBody& b, const btVector3& pivot, const btVector3& axis, bool hinge) {
    const btVector3 at = pivot + btVector3(0, 0, height_);
    joints.push_back({&a, &b, at - a.getWorldTransform().getOrigin(), at - b.getWorldTransform().getOrigin(),
                      axis, hinge});
    return joints.back();
  }
  void cone(btRigidBody& a, btRigidBody& b, double x, double y, double z, double along_x, double along_y,
            double along_z) {
    const btVector3 along{btScalar(along_x), btScalar(along_y), btScalar(along_z)};
    const Joint& joint = join(a, b, btVector3(btScalar(x), btScalar(y), btScalar(z)), along, false);
    // Its x twists.
    const btQuaternion frame = shortestArcQuat(btVector3(1, 0, 0), along);
    world_.join<btConeTwistConstraint>(a, b, btTransform(frame, joint.in_a), btTransform(frame, joint.in_b))
        .setLimit(btScalar(kSwing), btScalar(kSwing), btScalar(0.5), 1);
  }
  void hinge(btRigidBody& a, btRigidBody& b, double x, double y, double z, double along_x, double along_y,
             double along_z) {
    const btVector3 axis{btScalar(along_x), btScalar(along_y), btScalar(along_z)};
    const Joint& joint = join(a, b, btVector3(btScalar(x), btScalar(y), btScalar(z)), axis, true);
    world_.join<btHingeConstraint>(a, b, joint.in_a, joint.in_b, axis, axis)
        .setLimit(btScalar(-kBent), btScalar(-kBack));  // Bullet's angle is that of the first body
  }

  SolverWorld& world_;
  btScalar height_;
};

}  // namespace innersphere::test
