// A cylinder that leans touches with its rim, wherever its spheres are.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "outline_meshes.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kLength = 0.3, kRadius = 0.02;

/// About z, from its middle.
std::shared_ptr<PackingShape> rod(std::size_t spheres) {
  constexpr double kHalf = kLength / 2;
  return makePackedShape(
      *makeSolid(turnedMesh({{0, -kHalf}, {kRadius, -kHalf}, {kRadius, kHalf}, {0, kHalf}}, 48), "rod"),
      spheres);
}

btQuaternion about(const btVector3& axis, double angle) {
  return btQuaternion(axis, btScalar(angle));
}

enum class Ground { plane, box, packing };

class Rims : public testing::TestWithParam<std::tuple<Ground, std::size_t>> {
 protected:
  Rims() {
    const Vec3d size{4, 4, 0.5};
    const btVector3 below(0, 0, btScalar(-size[2] / 2));
    switch (std::get<0>(GetParam())) {
      case Ground::plane:
        world.addFloor();
        break;
      case Ground::box:
        world.add(std::make_shared<btBoxShape>(btVector3(2, 2, btScalar(0.25))), 0, below);
        break;
      case Ground::packing:
        world.add(makePackedShape(*makeBox(size), 512), 0, below);
    }
  }
  /// Nine rods; none may be deeper in the floor than that [m].
  void fall(double step, double deepest);
  /// Height of the lowest place of a rod over the floor [m].
  double lowest(const btRigidBody& body) const;

  TestWorld world;
  const std::shared_ptr<PackingShape> shape = rod(std::get<1>(GetParam()));
};

// Samples of its side bore, as far from the rim as spheres are: a millimetre of depth was told as up to 0.8
// apart, or 2.9.
TEST_P(Rims, BearWhereCylindersLean) {
  constexpr double kDeep = 1e-3;
  btRigidBody& body = world.add(shape, 1, btVector3(0, 0, 1));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(0, 1);
  for (int i = 0; i < 200; ++i) {
    // Further over its end bears, where spheres are near the corners of the mesh.
    const double lean = 0.01 + 0.95 * part(random), heading = 2 * M_PI * part(random);
    const btQuaternion turn = about(btVector3(0, 0, 1), heading) * about(btVector3(0, 1, 0), M_PI_2 - lean) *
                              about(btVector3(0, 0, 1), 2 * M_PI * part(random));
    // How far the lowest point of the lower rim's circle is from the middle.
    const double below = kLength / 2 * std::sin(lean) + kRadius * std::cos(lean),
                 aside = kRadius * std::sin(lean) - kLength / 2 * std::cos(lean);
    const btTransform mesh(
        turn, btVector3(btScalar(part(random)), btScalar(part(random)), btScalar(below - kDeep)));
    body.setWorldTransform(shape->bodyTransform(mesh));
    world.world.updateAabbs();
    world.world.performDiscreteCollisionDetection();
    const auto contacts = world.contactsOfLast();
    ASSERT_FALSE(contacts.empty()) << lean;
    const btManifoldPoint& deepest = contacts.front();
    EXPECT_NEAR(-deepest.getDistance(), kDeep, 2e-3 * kRadius) << lean;
    const btVector3 place = deepest.getPositionWorldOnB(), at = mesh.getOrigin();
    EXPECT_NEAR(place.x() - at.x(), aside * std::cos(heading), 0.02 * kRadius) << lean;
    EXPECT_NEAR(place.y() - at.y(), aside * std::sin(heading), 0.02 * kRadius) << lean;
    EXPECT_GT(deepest.m_normalWorldOnB.z(), 0.9999) << lean;
  }
}

// The ends of rods went up to 148 mm into packed floors of few spheres. A SubstepSolver left one end to the
// other, which touched first.
TEST_P(Rims, OfRodsThatFallStayOutOfTheFloor) {
  fall(1.0 / 240, 0.01 * kLength);
}

TEST_P(Rims, OfRodsThatFallStayOutOfTheFloorWithSubsteps) {
  SubstepSolver solver;
  world.world.setConstraintSolver(&solver);
  PackingCollisionAlgorithm::prepareWorld(world.world);
  fall(1.0 / 60, 0.03 * kLength);
  world.world.setConstraintSolver(&world.solver);
}

// The end that was up went in by 5 mm, on a packing by 16: contacts beside it were further up.
TEST_P(Rims, OfEndsThatSwingDownWithinAStepStayOutOfTheFloor) {
  constexpr double kStep = 1.0 / 60, kSpin = 14;  // [s], [rad/s]
  SubstepSolver solver;
  world.world.setConstraintSolver(&solver);
  PackingCollisionAlgorithm::prepareWorld(world.world);
  btRigidBody& body = world.add(shape, 0.5, btVector3(0, 0, 1));
  for (int i = 0; i < 20; ++i) {
    const double lean = 0.02 + 0.2 * i / 20;
    // Its axis, from the end that is down to the one that is up, and its turn, which takes that one down.
    const btVector3 axis(btScalar(std::cos(lean)), 0, btScalar(std::sin(lean))), turn(0, kSpin, 0);
    const btVector3 middle = axis * btScalar(kLength / 2);
    const btTransform mesh(about(btVector3(0, 1, 0), M_PI_2 - lean) * about(btVector3(0, 0, 1), 0.3 * i),
                           btVector3(middle.x(), 0, middle.z() + btScalar(kRadius * std::cos(lean) + 1e-3)));
    body.setCenterOfMassTransform(shape->bodyTransform(mesh));
    body.setLinearVelocity(turn.cross(middle));
    body.setAngularVelocity(turn);
    world.run(kStep, kStep);
    EXPECT_GT(lowest(body), -0.01 * kLength) << lean;
    // Nothing is kept from one pose to the next.
    world.world.removeRigidBody(&body);
    world.world.addRigidBody(&body);
  }
  world.world.setConstraintSolver(&world.solver);
}

double Rims::lowest(const btRigidBody& body) const {
  const btTransform mesh = body.getWorldTransform() * shape->meshToBody();
  const double axis = mesh.getBasis().getColumn(2).z();
  return double(mesh.getOrigin().z()) - kLength / 2 * std::fabs(axis) -
         kRadius * std::sqrt(std::max(0.0, 1 - axis * axis));
}

void Rims::fall(double step, double deepest) {
  std::vector<btRigidBody*> rods;
  std::mt19937 random(1);
  std::normal_distribution<double> part;
  for (int i = 0; i < 9; ++i) {
    const btQuaternion turn = btQuaternion(btScalar(part(random)), btScalar(part(random)),
                                           btScalar(part(random)), btScalar(part(random)))
                                  .normalized();
    const btVector3 place(btScalar(i % 3 - 1), btScalar(i / 3 - 1), btScalar(0.5));
    rods.push_back(&world.add(shape, 0.5, place, turn));
  }
  for (int i = 0; i * step < 2; ++i) {
    world.run(step, step);
    for (const btRigidBody* body : rods) ASSERT_GT(lowest(*body), -deepest) << i;
  }
  for (const btRigidBody* body : rods) EXPECT_NEAR(lowest(*body), 0, 5e-4);
}

std::string nameOfCase(const testing::TestParamInfo<Rims::ParamType>& info) {
  const char* const names[] = {"Plane", "Box", "Packing"};
  return names[int(std::get<0>(info.param))] + std::to_string(std::get<1>(info.param));
}

INSTANTIATE_TEST_SUITE_P(On, Rims,
                         testing::Combine(testing::Values(Ground::plane, Ground::box, Ground::packing),
                                          testing::Values(64, 512)),
                         nameOfCase);

}  // namespace
}  // namespace innersphere::test
