// What lies flat on a packed table slides as far as friction lets it, whatever its sides are.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <tuple>

#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "outline_meshes.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kThickness = 0.01, kRadius = 0.05;  // [m]

/// About z, from its middle; with a round hole or without.
std::shared_ptr<PackingShape> disc(bool hole) {
  constexpr double kHalf = kThickness / 2;
  if (!hole)
    return makePackedShape(
        *makeSolid(turnedMesh({{0, -kHalf}, {kRadius, -kHalf}, {kRadius, kHalf}, {0, kHalf}}), "disc"), 256);
  constexpr double kHole = 0.4 * kRadius;
  const Mesh ring = ringMesh({{kHole, -kHalf}, {kRadius, -kHalf}, {kRadius, kHalf}, {kHole, kHalf}}, 48);
  return makePackedShape(*makeSolid(ring, "ring"), 256);
}

class Sliding : public testing::TestWithParam<std::tuple<bool, bool, double>> {};

// From half the thickness in a step on, faces of the sides were contacts, though only near the table: it
// stopped after a step, or tipped.
TEST_P(Sliding, StopsWhereFrictionSays) {
  const auto [hole, substeps, steps] = GetParam();
  constexpr double kFriction = 0.3, kSpeed = 1.2, kGravity = 9.81;
  TestWorld world;
  SubstepSolver solver;
  if (substeps) world.world.setConstraintSolver(&solver);
  PackingCollisionAlgorithm::prepareWorld(world.world);
  world.world.setGravity(btVector3(0, 0, btScalar(-kGravity)));
  world.add(makePackedShape(*makeBox({0.8, 0.8, 0.03}), 256), 0, btVector3(0, 0, btScalar(-0.015)))
      .setFriction(1);
  btRigidBody& body = world.add(disc(hole), 0.3, btVector3(btScalar(-0.25), 0, btScalar(kThickness / 2)));
  body.setFriction(kFriction);
  body.setLinearVelocity(btVector3(kSpeed, 0, 0));
  world.run(1, 1 / steps);
  const double way = kSpeed * kSpeed / (2 * kFriction * kGravity);
  // Friction takes its part of the speed before the first way: half of what it takes in a step.
  EXPECT_NEAR(body.getWorldTransform().getOrigin().x() + 0.25, way, 0.005 * way + kSpeed / steps / 2);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().y(), 0, 0.002 * way);
  EXPECT_LT(body.getLinearVelocity().length(), 1e-3);
  world.world.setConstraintSolver(&world.solver);
}

std::string nameOfCase(const testing::TestParamInfo<Sliding::ParamType>& info) {
  return std::string(std::get<0>(info.param) ? "Ring" : "Disc") +
         (std::get<1>(info.param) ? "Substeps" : "") + std::to_string(int(std::get<2>(info.param)));
}

INSTANTIATE_TEST_SUITE_P(OnATable, Sliding,
                         testing::Combine(testing::Bool(), testing::Bool(), testing::Values(60.0, 240.0)),
                         nameOfCase);

}  // namespace
}  // namespace innersphere::test
