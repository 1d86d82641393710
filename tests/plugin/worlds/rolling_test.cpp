// What brakes balls, or drives them: next to nothing where they roll, the friction of a small round contact
// where they spin.
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <gtest/gtest.h>

#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "outline_meshes.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kRadius = 0.5, kGravity = 9.81, kStep = 1.0 / 240;

/// A ball of 1 kg that has come to lie on the plane.
btRigidBody& addBall(TestWorld& world) {
  world.world.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  world.addFloor().setFriction(1);
  btRigidBody& ball = world.add(makeNamedShape("ball", 500, kRadius), 1, btVector3(0, 0, btScalar(kRadius)));
  ball.setFriction(1);
  ball.setActivationState(DISABLE_DEACTIVATION);
  world.run(0.5, kStep);
  return ball;
}

double inertiaOf(const btRigidBody& body) {
  return 1 / double(body.getInvInertiaDiagLocal().z());
}

void roll(btRigidBody& ball, double speed) {
  ball.setLinearVelocity(btVector3(btScalar(speed), 0, 0));
  ball.setAngularVelocity(btVector3(0, btScalar(speed / kRadius), 0));
}

// A load that lies a lever ahead of the middle slows the ball by g lever / R / (1 + I / (m R^2)).
TEST(Rolling, IsHardlyBraked) {
  TestWorld world;
  btRigidBody& ball = addBall(world);
  roll(ball, 1);
  world.run(10, kStep);
  const double slowing = kGravity * 1e-5 * kRadius / kRadius / 1.4;
  EXPECT_NEAR(1 - ball.getLinearVelocity().x(), 10 * slowing, 0.3 * 10 * slowing);
}

TEST(Rolling, IsBrakedAsTheUserSays) {
  TestWorld world;
  btRigidBody& ball = addBall(world);
  constexpr double kLever = 0.02;
  ball.setRollingFriction(btScalar(kLever));
  roll(ball, 1);
  world.run(1, kStep);
  const double slowing = kGravity * kLever / kRadius / 1.4;
  EXPECT_NEAR(1 - ball.getLinearVelocity().x(), slowing, 0.05 * slowing);
}

// The pressure of a round contact of radius a, as Hertz has it, is 3 pi / 16 a from its middle on average; a
// ball that is d deep has a = sqrt(R d).
TEST(Rolling, ASpinningBallIsBrakedByItsContact) {
  TestWorld world;
  btRigidBody& ball = addBall(world);
  const double depth = -double(world.contactsOfLast().at(0).getDistance());
  ball.setAngularVelocity(btVector3(0, 0, 5));
  constexpr double kSeconds = 2;
  world.run(kSeconds, kStep);
  const double torque = kGravity * 3 * M_PI / 16 * std::sqrt(kRadius * depth);
  const double slowing = torque / inertiaOf(ball);
  EXPECT_NEAR(5 - ball.getAngularVelocity().z(), kSeconds * slowing, 0.05 * kSeconds * slowing);
  EXPECT_LT(ball.getLinearVelocity().length(), 1e-3);
}

/// What is round, about z: packed, or a shape of Bullet's.
struct Round {
  std::string name;
  std::shared_ptr<btCollisionShape> (*make)(double radius, double width);
};
const Round kWheel{"PackedWheel", [](double radius, double width) -> std::shared_ptr<btCollisionShape> {
                     return makeFineCylinderShape(radius, width, 256);
                   }};
const Round kCylinder{"Cylinder", [](double radius, double width) -> std::shared_ptr<btCollisionShape> {
                        return std::make_shared<btCylinderShapeZ>(
                            btVector3(btScalar(radius), btScalar(radius), btScalar(width / 2)));
                      }};
const Round kPackedBall{"PackedBall", [](double radius, double) -> std::shared_ptr<btCollisionShape> {
                          return makeFineBallShape(radius, 256);
                        }};
const Round kBall{"Ball", [](double radius, double) -> std::shared_ptr<btCollisionShape> {
                    return std::make_shared<btSphereShape>(btScalar(radius));
                  }};

/// Rolls with Bullet's solver, or with a SubstepSolver, at a number of steps a second.
class Wheels : public testing::TestWithParam<std::tuple<Round, bool, double>> {
 protected:
  static constexpr double kWheel = 0.15, kSpeed = 2, kSeconds = 2;
  Wheels() {
    if (usesSubsteps()) world.world.setConstraintSolver(&solver_);
    PackingCollisionAlgorithm::prepareWorld(world.world);
  }
  ~Wheels() override { world.world.setConstraintSolver(&world.solver); }
  static bool usesSubsteps() { return std::get<1>(GetParam()); }
  static double rate() { return std::get<2>(GetParam()); }
  /// Of the floor's frame.
  void turnWorld(const btQuaternion& turned) {
    turned_ = turned;
    world.world.setGravity(quatRotate(turned, world.world.getGravity()));
  }
  void addPacked(const Vec3d& size, double x, const std::shared_ptr<PackingShape>& shape = nullptr) {
    const btVector3 place{btScalar(x), 0, btScalar(-size[2] / 2)};
    world.add(shape ? shape : makePackedShape(*makeBox(size), 256), 0, quatRotate(turned_, place), turned_);
  }
  void roll(double lost, double hop);

 private:
  SubstepSolver solver_;
  btQuaternion turned_ = btQuaternion::getIdentity();

 protected:
  TestWorld world;
};

void Wheels::roll(double lost, double hop) {
  const btVector3 place{btScalar(0.2), 0, btScalar(kWheel)};
  btRigidBody& body = world.add(std::get<0>(GetParam()).make(kWheel, 0.08), 1, quatRotate(turned_, place),
                                turned_ * btQuaternion(btVector3(1, 0, 0), SIMD_HALF_PI));
  body.setLinearVelocity(quatRotate(turned_, btVector3(btScalar(kSpeed), 0, 0)));
  body.setAngularVelocity(quatRotate(turned_, btVector3(0, btScalar(kSpeed / kWheel), 0)));
  const btQuaternion back = turned_.inverse();
  for (int i = 0; i < int(kSeconds * rate()); ++i) {
    world.run(1 / rate(), 1 / rate());
    EXPECT_NEAR(quatRotate(back, body.getWorldTransform().getOrigin()).z(), kWheel, hop);
  }
  const btScalar left = quatRotate(back, body.getLinearVelocity()).x();
  EXPECT_GT(left, (1 - lost) * kSpeed);
  EXPECT_LT(left, 1.003 * kSpeed);
}

// Ends of the line that a wheel lies on, or places beside it, were taken for what bears it, as if they did
// not go along with it: 0.60 to 0.89 of the speed were left at 60 steps/s.
TEST_P(Wheels, KeepTheirSpeedOnAPackedFloor) {
  addPacked({14, 2, 0.5}, 6);
  roll(usesSubsteps() ? 0.002 : 0.01, usesSubsteps() ? 2e-4 : 5e-4);
}

// Axes across a normal that are chosen by its direction change at 45 degrees.
TEST_P(Wheels, RollAlikeInAWorldThatIsTurned) {
  turnWorld(btQuaternion(btVector3(1, 0, 0), SIMD_HALF_PI / 2));
  addPacked({14, 2, 0.5}, 6);
  roll(usesSubsteps() ? 0.002 : 0.01, usesSubsteps() ? 2e-4 : 5e-4);
}

// The next tile's edge comes nearer, passes below, and falls behind within a step: 0.62 to 0.78 were left.
TEST_P(Wheels, RollOverTheJointsOfTiles) {
  const Vec3d size{1, 2, 0.5};
  const auto tile = makePackedShape(*makeBox(size), 256);
  for (int i = -1; i < 6; ++i) addPacked(size, 0.5 + i, tile);
  roll(usesSubsteps() ? 0.01 : 0.04, usesSubsteps() ? 5e-4 : 2e-3);
}

INSTANTIATE_TEST_SUITE_P(Of, Wheels,
                         testing::Combine(testing::Values(kWheel, kCylinder, kPackedBall, kBall),
                                          testing::Bool(), testing::Values(60.0, 240.0)),
                         [](const testing::TestParamInfo<Wheels::ParamType>& info) {
                           return std::get<0>(info.param).name +
                                  (std::get<1>(info.param) ? "Substeps" : "Bullet") +
                                  std::to_string(int(std::get<2>(info.param)));
                         });

/// What a ball rolls on.
enum class Floor { plane, box, packed, triangles, heights };

std::string nameOf(Floor floor) {
  switch (floor) {
    case Floor::plane:
      return "Plane";
    case Floor::box:
      return "Box";
    case Floor::packed:
      return "Packed";
    case Floor::triangles:
      return "Triangles";
    default:
      return "Heights";
  }
}

/// A ball that turns by a third of a radian in a step of 1/60 s.
class FastBalls : public testing::TestWithParam<std::tuple<Floor, bool, double>> {
 protected:
  static constexpr double kBall = 0.1, kSpeed = 2, kSeconds = 2, kFar = 8, kCell = 0.1;
  static constexpr int kCells = 80;

  void addFloor(TestWorld& world) {
    const btVector3 half(kFar, kFar, btScalar(0.2)), middle(0, 0, btScalar(-0.2));
    switch (std::get<0>(GetParam())) {
      case Floor::plane:
        world.addFloor();
        break;
      case Floor::box:
        world.add(std::make_shared<btBoxShape>(half), 0, middle);
        break;
      case Floor::packed:
        world.add(makePackedShape(*makeBox({2 * kFar, 2 * kFar, 0.4}), 256), 0, middle);
        break;
      case Floor::triangles:
        addTriangles();
        world.add(std::make_shared<btBvhTriangleMeshShape>(&triangles_, true), 0, btVector3(0, 0, 0));
        break;
      case Floor::heights: {
        auto shape =
            std::make_shared<btHeightfieldTerrainShape>(kCells + 1, kCells + 1, heights_.data(), btScalar(1),
                                                        btScalar(-0.1), btScalar(0.1), 2, PHY_FLOAT, false);
        shape->setLocalScaling(btVector3(btScalar(kCell), btScalar(kCell), 1));
        world.add(shape, 0, btVector3(0, 0, 0));
      }
    }
    world.bodies.back()->setFriction(1);
  }

 private:
  /// Flat, of no regular shape.
  void addTriangles() {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> aside(-0.3, 0.3);
    std::vector<btVector3> places;
    for (int i = 0; i < (kCells + 1) * (kCells + 1); ++i)
      places.emplace_back(btScalar((i % (kCells + 1) - kCells / 2 + aside(random)) * kCell),
                          btScalar((i / (kCells + 1) - kCells / 2 + aside(random)) * kCell), btScalar(0));
    for (int row = 0; row < kCells; ++row) {
      for (int k = row * (kCells + 1); k < row * (kCells + 1) + kCells; ++k) {
        triangles_.addTriangle(places[k], places[k + 1], places[k + kCells + 2]);
        triangles_.addTriangle(places[k], places[k + kCells + 2], places[k + kCells + 1]);
      }
    }
  }

  btTriangleMesh triangles_;
  std::vector<btScalar> heights_ = std::vector<btScalar>((kCells + 1) * (kCells + 1), btScalar(0));
};

// With Bullet's solver at 60 steps/s it gained a tenth of its speed on planes, as the slip of a circle was
// reckoned along its chord, and lost a fifth on triangles: a vertex of the ball bore beside its lowest place,
// and from a gap it was told to turn away by 5 mm, as a triangle's curvature of -1e-14 made it hollow.
TEST_P(FastBalls, KeepTheirSpeedAndDoNotHop) {
  const auto [floor, substeps, rate] = GetParam();
  TestWorld world;
  SubstepSolver solver;
  if (substeps) world.world.setConstraintSolver(&solver);
  PackingCollisionAlgorithm::prepareWorld(world.world);
  addFloor(world);
  constexpr double kGap = 5e-4;
  btRigidBody& ball =
      world.add(makeMeshBallShape(kBall, 256), 1, btVector3(-2, btScalar(0.013), btScalar(kBall + kGap)));
  ball.setFriction(1);
  ball.setLinearVelocity(btVector3(kSpeed, 0, 0));
  ball.setAngularVelocity(btVector3(0, kSpeed / kBall, 0));
  double lowest = 1, highest = 0;
  for (int i = 0; i < int(kSeconds * rate); ++i) {
    world.run(1 / rate, 1 / rate);
    const double height = ball.getWorldTransform().getOrigin().z() - kBall;
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  EXPECT_GT(lowest, -2.5e-4);
  EXPECT_LT(highest, kGap);
  EXPECT_GT(double(ball.getLinearVelocity().x()), (substeps ? 0.994 : 0.999) * kSpeed);
  EXPECT_LT(double(ball.getLinearVelocity().x()), 1.0005 * kSpeed);
  world.world.setConstraintSolver(&world.solver);
}

INSTANTIATE_TEST_SUITE_P(On, FastBalls,
                         testing::Combine(testing::Values(Floor::plane, Floor::box, Floor::packed,
                                                          Floor::triangles, Floor::heights),
                                          testing::Bool(), testing::Values(60.0, 240.0)),
                         [](const testing::TestParamInfo<FastBalls::ParamType>& info) {
                           return nameOf(std::get<0>(info.param)) +
                                  (std::get<1>(info.param) ? "Substeps" : "Bullet") +
                                  std::to_string(int(std::get<2>(info.param)));
                         });

// A disc that slides down a packed slope, and spins up as it does, moves by g (sin - mu cos). Of what is near
// ahead of the step, the flat road bears it: a normal of the disc's own, which spins past, has a speed that
// nothing approaches with, and throws it up.
TEST(Rolling, ADiscSlidesDownAPackedSlope) {
  constexpr double kOuter = 0.3, kSlope = 0.9, kFriction = 0.2, kSeconds = 1.2;
  const Mesh disc = turnedMesh({{0, -0.05}, {kOuter, -0.05}, {kOuter, 0.05}, {0, 0.05}}, 128);
  for (const bool substeps : {false, true}) {
    for (const double rate : {120.0, 240.0}) {
      TestWorld world;
      SubstepSolver solver;
      if (substeps) world.world.setConstraintSolver(&solver);
      PackingCollisionAlgorithm::prepareWorld(world.world);
      world.world.setGravity(
          btVector3(btScalar(kGravity * std::sin(kSlope)), 0, btScalar(-kGravity * std::cos(kSlope))));
      world.add(makePackedShape(*makeBox({12, 2, 1}), 256), 0, btVector3(5, 0, btScalar(-0.5)))
          .setFriction(1);
      const auto shape = makePackedShape(*makeSolid(disc, "disc"), 256);
      btRigidBody& body = world.add(shape, 1, btVector3(0, 0, 0));
      body.setFriction(btScalar(kFriction));
      const btQuaternion upright(btVector3(1, 0, 0), SIMD_HALF_PI);
      body.setWorldTransform(shape->bodyTransform(btTransform(upright, btVector3(0, 0, btScalar(kOuter)))));
      btScalar highest = 0;
      for (int i = 0; i < int(kSeconds * rate); ++i) {
        world.run(1 / rate, 1 / rate);
        highest = btMax(highest, body.getWorldTransform().getOrigin().z());
      }
      const double speed = kGravity * (std::sin(kSlope) - kFriction * std::cos(kSlope)) * kSeconds;
      EXPECT_NEAR(body.getLinearVelocity().x(), speed, 0.015 * speed) << substeps << rate;
      EXPECT_LT(highest, kOuter + 0.002) << substeps << rate;
      world.world.setConstraintSolver(&world.solver);
    }
  }
}

}  // namespace
}  // namespace innersphere::test
