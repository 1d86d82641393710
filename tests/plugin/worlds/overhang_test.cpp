// A face that lies over the edge of another bears on all that both have in common, and on no more.
#include <memory>

#include <gtest/gtest.h>

#include "innersphere/substep_solver.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

struct Case {
  bool substeps, on_bullets_box;
};

class Overhang : public testing::TestWithParam<Case> {};

/// [s]: until then it tips if it does.
constexpr double kSeconds = 3;
constexpr double kSide = 0.5, kOver = 0.15;  // [m] of the cube; how far it sticks out
const Vec3d kBlock{2, 2, 0.5};

/// How far a cube over the edge x = 0 of a block tilts [degrees]. Its centre of mass, in the middle of its
/// height, is over `place`.
double tiltOver(const Case& c, double x, double y) {
  TestWorld world;
  SubstepSolver solver;
  if (c.substeps) world.world.setConstraintSolver(&solver);
  PackingCollisionAlgorithm::prepareWorld(world.world);
  const btVector3 half = btVector3(btScalar(kBlock[0]), btScalar(kBlock[1]), btScalar(kBlock[2])) / 2;
  const btVector3 middle(-half.x(), 0, -half.z());
  if (c.on_bullets_box)
    world.add(std::make_shared<btBoxShape>(half), 0, middle);
  else
    world.add(makeShape(latticeBox(kBlock, 6)), 0, middle);
  const btVector3 cube(btScalar(kOver - kSide / 2), 0, btScalar(kSide / 2));
  const btVector3 centre_of_mass{btScalar(x), btScalar(y), cube.z()};
  const auto model = std::make_shared<const CollisionModel>(
      std::make_shared<const Packing>(latticeBox({kSide, kSide, kSide}, 5)));
  const btTransform to_body(btMatrix3x3::getIdentity(), cube - centre_of_mass);
  btRigidBody& body = world.add(std::make_shared<PackingShape>(model, to_body), 1, centre_of_mass);
  body.setActivationState(DISABLE_DEACTIVATION);
  world.run(kSeconds, 1.0 / 120);
  return tiltDegrees(body);
}

// Statics: it stands if and only if its centre of mass is over the rectangle that both faces share.
TEST_P(Overhang, StandsWhileItsCentreOfMassIsOverWhatBothShare) {
  constexpr double kInside = 0.005;  // [m]
  // Where an edge of the one crosses an edge of the other, and along the edge of the block.
  for (const double y : {kSide / 2 - kInside, 0.12, 0.0, kInside - kSide / 2})
    EXPECT_LT(tiltOver(GetParam(), -kInside, y), 0.5) << "at " << y;
}

TEST_P(Overhang, TipsWhenItIsNot) {
  EXPECT_GT(tiltOver(GetParam(), 0.005, 0), 1);
}

INSTANTIATE_TEST_SUITE_P(Solvers, Overhang,
                         testing::Values(Case{false, false}, Case{false, true}, Case{true, false},
                                         Case{true, true}));

}  // namespace
}  // namespace innersphere::test
