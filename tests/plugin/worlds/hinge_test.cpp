// A body with a bore hangs on a pin without friction: a physical pendulum.
#include <cmath>
#include <cstdint>
#include <memory>

#include <gtest/gtest.h>

#include "innersphere/mesh.hpp"
#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kDisc = 0.15, kPin = 0.05, kBeside = 0.07;  // radii, and from axis to axis [m]
constexpr double kMass = 4, kGravity = 9.81, kSwing = 0.3;   // [kg], [m/s^2], [rad]

/// A disc about z, 0.2 m thick, with a bore about an axis through (0, kBeside).
Mesh boredDisc(double bore) {
  constexpr std::uint32_t kAround = 96;
  Mesh mesh;
  for (const double z : {-0.1, 0.1}) {
    for (const bool inside : {false, true}) {
      for (std::uint32_t i = 0; i < kAround; ++i) {
        const double angle = 2 * M_PI * i / kAround, radius = inside ? bore : kDisc;
        mesh.vertices.push_back(
            {radius * std::cos(angle), radius * std::sin(angle) + (inside ? kBeside : 0), z});
      }
    }
  }
  for (std::uint32_t i = 0; i < kAround; ++i) {
    const auto quad = [&](std::uint32_t ring, std::uint32_t next) {
      const std::uint32_t j = (i + 1) % kAround, from = ring * kAround, to = next * kAround;
      mesh.triangles.push_back({from + i, from + j, to + j});
      mesh.triangles.push_back({from + i, to + j, to + i});
    };
    quad(0, 2);
    quad(2, 3);
    quad(3, 1);
    quad(1, 0);
  }
  return mesh;
}

class Hinge : public testing::TestWithParam<double> {};

TEST_P(Hinge, SwingsAndKeepsItsEnergy) {
  const double bore = kPin + GetParam();
  const auto disc = makePackedShape(*makeSolid(boredDisc(bore), "disc"), 256);
  TestWorld world;
  SubstepSolver solver;
  world.world.setConstraintSolver(&solver);
  PackingCollisionAlgorithm::prepareWorld(world.world);
  world.world.setGravity(btVector3(0, btScalar(-kGravity), 0));
  world
      .add(std::make_shared<btCylinderShapeZ>(btVector3(btScalar(kPin), btScalar(kPin), btScalar(0.2))), 0,
           btVector3(0, 0, 0))
      .setFriction(0);
  // The top of the bore lies on the pin, and the disc hangs aside.
  const btQuaternion turned(btVector3(0, 0, 1), btScalar(kSwing));
  const btTransform start =
      disc->bodyTransform(btTransform(turned, quatRotate(turned, btVector3(0, btScalar(-kBeside), 0)) -
                                                  btVector3(0, btScalar(GetParam()), 0)));
  btRigidBody& body = world.add(disc, kMass, start.getOrigin(), start.getRotation());
  body.setFriction(0);
  body.setActivationState(DISABLE_DEACTIVATION);

  const double solid = kDisc * kDisc, hole = bore * bore;
  const double lever = kBeside * solid / (solid - hole);  // from the axis of the bore to the centre of mass
  // About that axis, over the mass.
  const double inertia = (solid * (solid / 2 + kBeside * kBeside) - hole * hole / 2) / (solid - hole);
  const double period = 2 * M_PI * std::sqrt(inertia / (kGravity * lever)) * (1 + kSwing * kSwing / 16);
  const double lowest = -kMass * kGravity * (lever + GetParam());
  const auto swing = [&] {
    return world.kineticEnergy() + kMass * kGravity * body.getWorldTransform().getOrigin().y() - lowest;
  };
  const double before = swing();
  constexpr double kStep = 1.0 / 60;
  double first = -1, last = -1, x = 0;
  int swings = -1;
  for (int i = 1; i <= 600; ++i) {
    world.run(kStep, kStep);
    const double now = body.getWorldTransform().getOrigin().x();
    if (x < 0 && now >= 0) {
      last = (i - now / (now - x)) * kStep;
      if (first < 0) first = last;
      ++swings;
    }
    x = now;
  }
  EXPECT_NEAR(swing() / before, 1, 0.03);
  EXPECT_NEAR((last - first) / swings, period, 0.01 * period);
}

INSTANTIATE_TEST_SUITE_P(Clearances, Hinge, testing::Values(0.0002, 0.001),
                         [](const auto& info) { return info.param < 0.0005 ? "Tight" : "Wide"; });

}  // namespace
}  // namespace innersphere::test
