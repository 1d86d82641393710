// A ball in a hollow that is hardly larger touches it at one place, and is pushed through its centre.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "innersphere/mesh.hpp"
#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "outline_meshes.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kHollow = 1, kWall = 0.2, kBend = 3, kLength = 4;  // [m]

/// Half a ring, open upwards, counter-clockwise from where it is outermost, or from its lowest place.
std::vector<std::array<double, 2>> section(double first, int steps) {
  std::vector<std::array<double, 2>> outline;
  for (const double radius : {kHollow + kWall, kHollow}) {
    for (int i = 0; i <= steps; ++i) {
      const double t = double(radius > kHollow ? i : steps - i) / steps,
                   angle = first + (2 * M_PI - first) * t;
      outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
  }
  return outline;
}

Mesh bowl() {
  std::vector<std::array<double, 2>> profile = section(1.5 * M_PI, 48);
  profile.front()[0] = profile.back()[0] = 0;
  return turnedMesh(profile, 128);
}

/// This section, half of whose corners are on the outside, as a quarter of a ring about z, or straight along
/// y.
Mesh pipe(const std::vector<std::array<double, 2>>& outline, bool bent) {
  const auto around = std::uint32_t(outline.size());
  const std::uint32_t along = bent ? 64 : 1;
  Mesh mesh;
  for (std::uint32_t i = 0; i <= along; ++i) {
    const double turn = bent ? M_PI / 2 * i / along : 0;
    for (const auto& [out, up] : outline) {
      const double x = out + (bent ? kBend : 0);
      mesh.vertices.push_back(
          {x * std::cos(turn), bent ? x * std::sin(turn) : kLength * (i / double(along) - 0.5), up});
    }
  }
  for (std::uint32_t k = 0; k < around; ++k) {
    const std::uint32_t next = (k + 1) % around;
    for (std::uint32_t i = 0; i < along * around; i += around) {
      mesh.triangles.push_back({i + k, i + around + k, i + around + next});
      mesh.triangles.push_back({i + k, i + around + next, i + next});
    }
  }
  for (std::uint32_t k = 0; k + 1 < around / 2; ++k) {
    const std::uint32_t end = along * around, back = around - 1 - k;
    mesh.triangles.push_back({k, k + 1, back - 1});
    mesh.triangles.push_back({k, back - 1, back});
    mesh.triangles.push_back({end + k, end + back - 1, end + k + 1});
    mesh.triangles.push_back({end + k, end + back, end + back - 1});
  }
  return mesh;
}

Mesh halfPipe(bool bent) {
  return pipe(section(M_PI, 96), bent);
}

/// Its walls lean by 45 degrees.
Mesh groove() {
  return pipe({{-1.3, 1}, {0, -0.3}, {1.3, 1}, {1, 1}, {0, 0}, {-1, 1}}, false);
}

std::shared_ptr<PackingShape> packed(const Mesh& mesh) {
  return makePackedShape(*makeSolid(mesh, "hollow"), 1000);
}

std::shared_ptr<btCollisionShape> ball(bool is_packed, double radius) {
  if (is_packed) return makeFineBallShape(radius, 256);
  return std::make_shared<btSphereShape>(btScalar(radius));
}

/// Of a ball, b.
struct AllPoints : btCollisionWorld::ContactResultCallback {
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* object0, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    const bool swapped = object0->getCollisionObject() == b;
    const btVector3 normal = swapped ? point.m_normalWorldOnB : -point.m_normalWorldOnB;
    const btVector3 on_ball = swapped ? point.getPositionWorldOnA() : point.getPositionWorldOnB();
    const btVector3 inwards = (b->getWorldTransform().getOrigin() - on_ball).normalized();
    past_centre = std::max(past_centre, double(inwards.cross(normal).length()));
    ++count;
    if (-point.getDistance() < depth) return 0;
    depth = -point.getDistance();
    deepest = normal;
    return 0;
  }
  const btCollisionObject* b = nullptr;
  int count = 0;
  double past_centre = 0;  ///< sine, at most
  btScalar depth = -1;
  btVector3 deepest{0, 0, 0};  ///< normal there, into the ball
};

/// Where a ball touches: a place in the middle of the hollow, and the way from there.
struct Place {
  btVector3 middle, way;
};

class Hollows : public testing::TestWithParam<const char*> {};

std::vector<Place> placesIn(const std::string& hollow) {
  std::vector<Place> places;
  for (int i = 0; i < 8; ++i) {
    const double side = (i - 3.5) / 7, turn = hollow == "bowl" ? 0.7 * i : M_PI / 4 + 0.03 * i;
    const btVector3 out(btScalar(std::cos(turn)), btScalar(std::sin(turn)), 0), down(0, 0, -1);
    if (hollow == "straight") {
      places.push_back({btVector3(0, btScalar(0.1 * i), 0),
                        btVector3(btScalar(std::sin(side)), 0, btScalar(-std::cos(side)))});
    } else {
      places.push_back({hollow == "bent" ? out * btScalar(kBend) : btVector3(0, 0, 0),
                        out * btScalar(std::sin(side)) + down * btScalar(std::cos(side))});
    }
  }
  return places;
}

TEST_P(Hollows, TouchABallAtOnePlace) {
  constexpr double kDepth = 0.0005 * kHollow, kDegree = M_PI / 180;
  const std::string hollow = GetParam();
  const auto shape = packed(hollow == "bowl" ? bowl() : halfPipe(hollow == "bent"));
  TestWorld world;
  btRigidBody& a = world.add(shape, 0, btVector3(0, 0, 0));
  a.setWorldTransform(shape->bodyTransform(btTransform::getIdentity()));
  for (const double ratio : {0.3, 0.5, 0.56, 0.7, 0.85}) {
    btSphereShape ball{btScalar(ratio * kHollow)};
    btCollisionObject b;
    b.setCollisionShape(&ball);
    for (const Place& place : placesIn(hollow)) {
      const btVector3 at = place.middle + place.way * btScalar((1 - ratio) * kHollow + kDepth);
      b.setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
      AllPoints found;
      found.b = &b;
      world.world.contactPairTest(&a, &b, found);
      EXPECT_NEAR(found.depth, kDepth, 0.05 * kDepth) << ratio;
      EXPECT_LT((found.deepest + place.way).length(), 0.3 * kDegree) << ratio;
      EXPECT_LT(found.past_centre, 0.1 * kDegree) << ratio;
      EXPECT_EQ(found.count, 1) << ratio;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Hollows, testing::Values("straight", "bent", "bowl"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Bowl, LetsABallSwingWithoutLossOrSpin) {
  constexpr double kStart = 1;  // [rad]
  const auto shape = packed(bowl());
  for (const double ratio : {0.3, 0.6, 0.9}) {
    for (const bool is_packed : {false, true}) {
      const double radius = ratio * kHollow, far = kHollow - radius;
      TestWorld world;
      btRigidBody& a = world.add(shape, 0, btVector3(0, 0, 0));
      a.setWorldTransform(shape->bodyTransform(btTransform::getIdentity()));
      btRigidBody& b =
          world.add(ball(is_packed, radius), 1,
                    btVector3(btScalar(far * std::sin(kStart)), 0, btScalar(-far * std::cos(kStart))));
      b.setFriction(0);
      b.setActivationState(DISABLE_DEACTIVATION);
      const double height = far * (1 - std::cos(kStart));
      double fastest_spin = 0;
      for (int i = 0; i < 6; ++i) {
        world.run(0.5, 1.0 / 240);
        fastest_spin = std::max(fastest_spin, double(b.getAngularVelocity().length()));
      }
      const btVector3 at = b.getWorldTransform().getOrigin();
      const double energy = 0.5 * b.getLinearVelocity().length2() + 9.81 * (at.z() + far);
      EXPECT_NEAR(energy / (9.81 * height), 1, 0.04) << ratio << is_packed;
      EXPECT_LT(fastest_spin, 0.02) << ratio << is_packed;
      EXPECT_NEAR(at.y(), 0, 0.01 * kHollow) << ratio << is_packed;
    }
  }
}

/// A ball at the bottom of a straight half pipe that turns about the level axis across it, at rest or not.
class HalfPipes : public testing::TestWithParam<std::tuple<bool, bool, double>> {
 protected:
  static constexpr double kSpeed = 3, kTime = 1;  // [m/s], [s]
  static void SetUpTestSuite() { shape = packed(halfPipe(false)); }
  static void TearDownTestSuite() { shape.reset(); }

  /// What is left of the spin, and of the speed along the pipe.
  std::array<double, 2> left(double friction, double speed, double height = 0) const {
    const auto [substeps, is_packed, ratio] = GetParam();
    const double radius = ratio * kHollow;
    TestWorld world;
    SubstepSolver solver;
    if (substeps) world.world.setConstraintSolver(&solver);
    PackingCollisionAlgorithm::prepareWorld(world.world);
    btRigidBody& a = world.add(shape, 0, btVector3(0, 0, 0));
    a.setWorldTransform(shape->bodyTransform(btTransform::getIdentity()));
    btRigidBody& b =
        world.add(ball(is_packed, radius), 1,
                  btVector3(0, btScalar(-speed * kTime / 2), btScalar(radius - kHollow + height)));
    for (btRigidBody* body : {&a, &b}) body->setFriction(btScalar(friction));
    b.setActivationState(DISABLE_DEACTIVATION);
    b.setLinearVelocity(btVector3(0, btScalar(speed), 0));
    b.setAngularVelocity(btVector3(btScalar(-kSpeed / radius), 0, 0));
    world.run(kTime, 1.0 / 30);
    world.world.setConstraintSolver(&world.solver);
    return {-double(b.getAngularVelocity().x()) * radius / kSpeed,
            double(b.getLinearVelocity().y()) / kSpeed};
  }
  static std::shared_ptr<PackingShape> shape;
};
std::shared_ptr<PackingShape> HalfPipes::shape;

// Pushes through its centre do not turn what is round.
TEST_P(HalfPipes, LeaveAFrictionlessBallItsSpin) {
  EXPECT_NEAR(left(0, 0)[0], 1, 0.005);
}

TEST_P(HalfPipes, LetABallRollAlong) {
  const auto [spin, speed] = left(0.5, kSpeed);
  EXPECT_NEAR(speed, 1, 0.02);
  EXPECT_NEAR(spin, 1, 0.02);
}

// Links of a chain, which bear others, are held back where they are deep. A ball that lands bears nothing.
TEST_P(HalfPipes, LetABallThatLandsRollOn) {
  const auto [spin, speed] = left(0.5, kSpeed, 0.1);
  EXPECT_NEAR(speed, 1, 0.02);
  EXPECT_NEAR(spin, 1, 0.02);
}

std::string nameOfRoller(const testing::TestParamInfo<std::tuple<bool, bool, double>>& info) {
  const auto [substeps, is_packed, ratio] = info.param;
  return std::string(substeps ? "Substeps" : "Bullet") + (is_packed ? "Packed" : "Sphere") +
         std::to_string(int(std::lround(100 * ratio)));
}

INSTANTIATE_TEST_SUITE_P(All, HalfPipes,
                         testing::Combine(testing::Bool(), testing::Bool(), testing::Values(0.35, 0.7)),
                         nameOfRoller);

/// With friction, in steps of that many a second.
class Grooves : public testing::TestWithParam<std::tuple<bool, bool, int, double>> {
 protected:
  static void SetUpTestSuite() { shape = packed(groove()); }
  static void TearDownTestSuite() { shape.reset(); }
  static std::shared_ptr<PackingShape> shape;
};
std::shared_ptr<PackingShape> Grooves::shape;

// It rolls on two circles of its radius / sqrt 2, and spins on both walls.
TEST_P(Grooves, LetABallRollDown) {
  const auto [substeps, is_packed, rate, friction] = GetParam();
  constexpr double kRadius = 0.1, kSlope = 0.087, kSeconds = 2;
  constexpr double kDepth = 1e-5;  // it does not fall on the walls first
  const btVector3 gravity(0, btScalar(9.81 * std::sin(kSlope)), btScalar(-9.81 * std::cos(kSlope)));
  TestWorld world;
  SubstepSolver solver;
  if (substeps) world.world.setConstraintSolver(&solver);
  world.world.setGravity(gravity);
  PackingCollisionAlgorithm::prepareWorld(world.world);
  btRigidBody& a = world.add(shape, 0, btVector3(0, 0, 0));
  a.setWorldTransform(shape->bodyTransform(btTransform::getIdentity()));
  btRigidBody& b =
      world.add(ball(is_packed, kRadius), 1, btVector3(0, -1, btScalar(kRadius * M_SQRT2 - kDepth)));
  for (btRigidBody* body : {&a, &b}) body->setFriction(btScalar(std::sqrt(friction)));
  b.setActivationState(DISABLE_DEACTIVATION);
  world.run(kSeconds, 1.0 / rate);
  world.world.setConstraintSolver(&world.solver);
  const double speed = 9.81 * std::sin(kSlope) / (1 + 2 * 0.4) * kSeconds;
  // More friction may hold what presses it into the walls at first, and its spin feels that.
  EXPECT_NEAR(double(b.getLinearVelocity().y()) / speed, 1, friction < 0.7 ? 0.01 : 0.04);
}

std::string nameOfDescent(const testing::TestParamInfo<std::tuple<bool, bool, int, double>>& info) {
  const auto [substeps, is_packed, rate, friction] = info.param;
  return std::string(substeps ? "Substeps" : "Bullet") + (is_packed ? "Packed" : "Sphere") +
         std::to_string(rate) + "Friction" + std::to_string(int(std::lround(100 * friction)));
}

INSTANTIATE_TEST_SUITE_P(All, Grooves,
                         testing::Combine(testing::Bool(), testing::Bool(), testing::Values(60, 240),
                                          testing::Values(0.1, 0.5, 0.8, 1.0)),
                         nameOfDescent);

}  // namespace
}  // namespace innersphere::test
