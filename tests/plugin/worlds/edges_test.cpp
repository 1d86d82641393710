// What is round lies on the edges of solids, and what turns or rocks on edges is not braked by them.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "outline_meshes.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kGravity = 9.81;

/// With Bullet's solver, or with a SubstepSolver, at a number of steps a second.
class Edges : public testing::TestWithParam<std::tuple<bool, double>> {
 protected:
  Edges() {
    if (std::get<0>(GetParam())) world.world.setConstraintSolver(&substeps_);
    PackingCollisionAlgorithm::prepareWorld(world.world);
  }
  ~Edges() override { world.world.setConstraintSolver(&world.solver); }
  void run(double seconds) { world.run(seconds, 1 / std::get<1>(GetParam())); }

  /// Two rails along y, whose upper edges at these places of x are at z = 0.
  void addRails(double half_gap) {
    constexpr double kWide = 0.1, kLong = 2;
    for (const double side : {-1.0, 1.0})
      world.add(makePackedShape(*makeBox({kWide, kLong, kWide}), 256), 0,
                btVector3(btScalar(side * (half_gap + kWide / 2)), 0, btScalar(-kWide / 2)));
  }
  void bearABall(bool packing);
  void letABallRoll(bool packing);

 private:
  SubstepSolver substeps_;

 protected:
  TestWorld world;
};

constexpr double kBall = 0.1, kHalfGap = 0.06, kHeight = 0.08;  // 0.06^2 + 0.08^2 = 0.1^2

std::shared_ptr<btCollisionShape> ball(bool packing) {
  if (packing) return makeFineBallShape(kBall, 256);
  return std::make_shared<btSphereShape>(btScalar(kBall));
}

void Edges::bearABall(bool packing) {
  addRails(kHalfGap);
  const btRigidBody& body = world.add(ball(packing), 1, btVector3(0, 0, btScalar(kHeight + 0.002)));
  run(2);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), kHeight, 2e-4);
  EXPECT_LT(body.getLinearVelocity().length(), 2e-3);
}

TEST_P(Edges, BearABall) {
  bearABall(false);
}
TEST_P(Edges, BearAPackedBall) {
  bearABall(true);
}

// It rolls on a radius of 0.08 m, so that it speeds up by g sin a / (1 + 0.4 (0.1 / 0.08)^2).
void Edges::letABallRoll(bool packing) {
  constexpr double kSlope = 10 * M_PI / 180, kSeconds = 1.2;
  addRails(kHalfGap);
  btRigidBody& body = world.add(ball(packing), 1, btVector3(0, btScalar(-0.8), btScalar(kHeight)));
  body.setGravity(
      btVector3(0, btScalar(kGravity * std::sin(kSlope)), btScalar(-kGravity * std::cos(kSlope))));
  run(kSeconds);
  const double speed = kSeconds * kGravity * std::sin(kSlope) / (1 + 0.4 * std::pow(kBall / kHeight, 2));
  EXPECT_NEAR(body.getLinearVelocity().y(), speed, 0.01 * speed);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().x(), 0, 0.002);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), kHeight, 0.002);
}

TEST_P(Edges, LetABallRoll) {
  letABallRoll(false);
}
TEST_P(Edges, LetAPackedBallRoll) {
  letABallRoll(true);
}

TEST_P(Edges, BearACylinderThatLiesAlongThem) {
  addRails(kHalfGap);
  const btQuaternion along(btVector3(1, 0, 0), SIMD_HALF_PI);
  const btRigidBody& body =
      world.add(makeFineCylinderShape(kBall, 0.3, 256), 1, btVector3(0, 0, btScalar(kHeight + 0.002)), along);
  run(2);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), kHeight, 2e-4);
  EXPECT_LT(body.getLinearVelocity().length(), 2e-3);
}

/// A wheel about y, 0.1 m wide, with a round bore.
Mesh wheelMesh(double bore, double radius) {
  constexpr std::uint32_t kSides = 96;
  Mesh mesh;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double angle = 2 * M_PI * i / kSides;
    for (const double r : {bore / std::cos(M_PI / kSides), radius})
      for (const double y : {-0.05, 0.05})
        mesh.vertices.push_back({r * std::sin(angle), y, r * std::cos(angle)});
  }
  // Around the cross section: bore at y = -0.05, rim there, rim at 0.05, bore there.
  constexpr std::array<std::uint32_t, 4> kAround{0, 2, 3, 1};
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const std::uint32_t here = 4 * i, next = 4 * ((i + 1) % kSides);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t from = kAround[k], to = kAround[(k + 1) % 4];
      mesh.triangles.push_back({here + from, next + from, next + to});
      mesh.triangles.push_back({here + from, next + to, here + to});
    }
  }
  return mesh;
}

/// It hangs on the two upper edges of a pin with six sides. Whatever the pin's faces do, each push of a round
/// bore leads through its middle.
TEST_P(Edges, TurnAWheelOnASixSidedPin) {
  constexpr double kBore = 0.031, kPin = 0.03, kWheel = 0.2, kSpin = 10;
  std::vector<std::array<double, 2>> outline;
  for (int i = 0; i < 6; ++i)
    outline.push_back({kPin * std::sin(M_PI / 6 - i * M_PI / 3), kPin * std::cos(M_PI / 6 - i * M_PI / 3)});
  btTriangleMesh triangles;
  addTriangles(prismMesh(outline), triangles);
  btRigidBody& pin =
      world.add(std::make_shared<btBvhTriangleMeshShape>(&triangles, true), 0, btVector3(0, 0, 0));
  pin.setFriction(1);
  const double hangs = kPin * std::cos(M_PI / 6) - std::sqrt(kBore * kBore - kPin * kPin / 4);
  const auto wheel = makePackedShape(*makeSolid(wheelMesh(kBore, kWheel), "wheel"), 256);
  for (const double friction : {0.0, 0.2}) {
    btRigidBody& body = world.add(wheel, 1, btVector3(0, 0, btScalar(hangs)));
    body.setFriction(btScalar(friction));
    body.setAngularVelocity(btVector3(0, kSpin, 0));
    run(1);
    // Both edges press, 30 degrees beside the weight, and rub; the sum of all holds it.
    const double inertia = 0.5 * (kWheel * kWheel + kBore * kBore), edge = kPin / (2 * kBore),
                 presses = kGravity / (std::sqrt(1 - edge * edge) * (1 + friction * friction)),
                 lost = friction * presses * kBore / inertia;
    const double off = std::get<1>(GetParam()) < 100 ? 0.2 : 0.1;
    EXPECT_NEAR(body.getAngularVelocity().y(), kSpin - lost, friction > 0 ? off * lost : 0.01 * kSpin)
        << friction;
    world.world.removeRigidBody(&body);
  }
}

// Corners of both plates end in the same two planes. That is not passing each other by.
TEST_P(Edges, OfPlatesInOnePlaneMeet) {
  constexpr double kSide = 0.2, kSpeed = 0.4, kGap = 0.0015;
  world.world.setGravity(btVector3(0, 0, 0));
  const auto plate = makePackedShape(*makeBox({kSide, kSide, 0.06}), 256);
  world.add(plate, 0, btVector3(0, 0, 0));
  const double start = kSide / 2 + kSide / std::sqrt(2.0) + kGap;
  btRigidBody& body =
      world.add(plate, 1, btVector3(btScalar(start), 0, 0), btQuaternion(btVector3(0, 0, 1), SIMD_PI / 4));
  body.setLinearVelocity(btVector3(btScalar(-kSpeed), btScalar(0.1), 0));
  double deepest = start;
  for (int i = 0; i < 12; ++i) {
    run(1 / std::get<1>(GetParam()));
    deepest = std::min(deepest, double(body.getWorldTransform().getOrigin().x()));
  }
  EXPECT_GT(deepest, start - kGap - 2e-4);
}

using Outline = std::vector<std::array<double, 2>>;

/// A prism along y of this width with this outline in x and z, about y = 0.
Mesh barMesh(const Outline& outline, double width) {
  Mesh mesh = prismMesh(outline);
  double middle = 0;
  for (const auto& v : mesh.vertices) middle += v[1] / double(mesh.vertices.size());
  for (auto& v : mesh.vertices) v[1] = (v[1] - middle) * width;
  return mesh;
}

/// What a plate of 1 kg/m^2 with this outline is like, by sums over triangles from (0, 0).
struct Plate {
  explicit Plate(const Outline& outline) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const auto &p = outline[i], &q = outline[(i + 1) % outline.size()];
      const double twice = p[0] * q[1] - q[0] * p[1];
      moment += twice * (p[1] + q[1]) / 6;
      for (int k = 0; k < 2; ++k) inertia += twice * (p[k] * p[k] + p[k] * q[k] + q[k] * q[k]) / 12;
    }
  }
  double moment = 0;   ///< along z [kg m]
  double inertia = 0;  ///< about (0, 0) [kg m^2]
};

/// A roof with a notch under its ridge swings on the edge of a knife.
class Notch : public Edges {
 protected:
  static constexpr double kDeep = 0.04, kTilt = 5 * M_PI / 180;

  static Mesh knife() { return barMesh({{-0.25, -0.36}, {0.25, -0.36}, {0, kDeep}}, 0.2); }
  btRigidBody& addPackedKnife() {
    const auto shape = makePackedShape(*makeSolid(knife(), "knife"), 256);
    btRigidBody& body = world.add(shape, 0, btVector3(0, 0, 0));
    body.setWorldTransform(shape->bodyTransform(btTransform::getIdentity()));
    return body;
  }
  void swing(double half_width, btRigidBody& knife);
};

void Notch::swing(double half_width, btRigidBody& knife) {
  const Outline beam{{0, 0.14},  {-0.5, -0.3},    {-0.4, -0.3}, {-half_width, 0},
                     {0, kDeep}, {half_width, 0}, {0.4, -0.3},  {0.5, -0.3}};
  Outline about_edge = beam;
  for (auto& place : about_edge) place[1] -= kDeep;
  const Plate plate(about_edge);
  const double quarter = M_PI / 2 * std::sqrt(plate.inertia / (kGravity * -plate.moment));

  knife.setFriction(1);
  const auto shape = makePackedShape(*makeSolid(barMesh(beam, 0.1), "beam"), 256);
  const btTransform turn(btQuaternion(btVector3(0, 1, 0), btScalar(kTilt)));
  const btTransform edge(btMatrix3x3::getIdentity(), btVector3(0, 0, btScalar(kDeep)));
  btRigidBody& body = world.add(shape, 1, btVector3(0, 0, 0));
  body.setFriction(btScalar(0.6));
  body.setActivationState(DISABLE_DEACTIVATION);
  body.setWorldTransform(shape->bodyTransform(edge * turn * edge.inverse()));
  body.setInterpolationWorldTransform(body.getWorldTransform());

  const double step = 1 / std::get<1>(GetParam());
  double before = kTilt, crossed = 0, slipped = 0;
  int crossings = 0;
  for (double time = step; crossings < 4 && time < 20 * quarter; time += step) {
    run(step);
    const btTransform mesh = shape->meshTransform(body.getWorldTransform());
    const double tilt = std::asin(double(mesh.getBasis()[0][2]));
    slipped = std::max(slipped, double((mesh(edge.getOrigin()) - edge.getOrigin()).length()));
    if ((tilt > 0) != (before > 0)) {
      ++crossings;
      crossed = time - step * tilt / (tilt - before);
    }
    before = tilt;
  }
  EXPECT_EQ(crossings, 4);
  // A quarter of the swing to the first, then half a swing each.
  EXPECT_NEAR(crossed, 7 * quarter, 0.01 * 7 * quarter);
  EXPECT_LT(slipped, 1e-3);
}

TEST_P(Notch, SwingsOnAPackedKnife) {
  swing(0.04, addPackedKnife());
}
TEST_P(Notch, WideSwingsOnAPackedKnife) {
  swing(0.08, addPackedKnife());
}
TEST_P(Notch, SwingsOnAKnifeOfTriangles) {
  btTriangleMesh triangles;
  addTriangles(knife(), triangles);
  swing(0.08, world.add(std::make_shared<btBvhTriangleMeshShape>(&triangles, true), 0, btVector3(0, 0, 0)));
}
TEST_P(Notch, SwingsOnAKnifeThatIsAHull) {
  const auto hull = std::make_shared<btConvexHullShape>();
  hull->setMargin(0);
  const Mesh mesh = knife();
  for (const auto& v : mesh.vertices)
    hull->addPoint(btVector3(btScalar(v[0]), btScalar(v[1]), btScalar(v[2])));
  swing(0.08, world.add(hull, 0, btVector3(0, 0, 0)));
}

/// A ring that carries a weight swings on the two upper edges of a square bar, without friction.
class Ring : public Edges {
 protected:
  static constexpr double kBore = 0.12, kHalfBar = 0.05, kLong = 0.6, kTilt = 0.3;
  static constexpr double kDown = 0.4, kInertia = 0.05;  // of the weight, below the middle; of 1 kg

  static Mesh bar() {
    return barMesh({{-kHalfBar, -2 * kHalfBar}, {kHalfBar, -2 * kHalfBar}, {kHalfBar, 0}, {-kHalfBar, 0}},
                   kLong);
  }
  void swing(btRigidBody& bar);
};

// It turns about the middle of its bore, which stays where it is: a pendulum of the length of the weight.
void Ring::swing(btRigidBody& bar) {
  bar.setFriction(0);
  constexpr double kWide = 0.06, kOuter = 0.2;
  const Mesh mesh = ringMesh({{kBore, -kWide}, {kOuter, -kWide}, {kOuter, kWide}, {kBore, kWide}}, 96);
  const auto ring = makePackedShape(*makeSolid(mesh, "ring"), 1000);
  const btTransform upright(btQuaternion(btVector3(1, 0, 0), SIMD_HALF_PI), btVector3(0, 0, btScalar(kDown)));
  const auto carrier = std::make_shared<btCompoundShape>();
  carrier->addChildShape(ring->bodyTransform(upright), ring.get());
  btRigidBody& body = world.add(carrier, 1, btVector3(0, 0, 0));
  body.setMassProps(1, btVector3(1, 1, 1) * btScalar(kInertia));
  body.updateInertiaTensor();
  body.setFriction(0);
  body.setActivationState(DISABLE_DEACTIVATION);
  const btQuaternion turn(btVector3(0, 1, 0), btScalar(kTilt));
  const btVector3 middle(0, 0, btScalar(-std::sqrt(kBore * kBore - kHalfBar * kHalfBar)));
  const btVector3 weight(0, 0, btScalar(-kDown));
  body.setWorldTransform(btTransform(turn, middle + quatRotate(turn, weight)));
  body.setInterpolationWorldTransform(body.getWorldTransform());

  const double step = 1 / std::get<1>(GetParam());
  double before = kTilt, crossed = 0, widest = 0;
  int crossings = 0;
  for (double time = step; crossings < 8 && time < 10; time += step) {
    run(step);
    const double tilt = std::asin(double(body.getWorldTransform().getBasis()[0][2]));
    if ((tilt > 0) != (before > 0)) {
      ++crossings;
      crossed = time - step * tilt / (tilt - before);
      widest = 0;
    }
    widest = std::max(widest, std::fabs(tilt));
    before = tilt;
    const btVector3 off = body.getWorldTransform()(-weight) - middle;
    EXPECT_LT(std::hypot(double(off.x()), double(off.z())), 1e-3);
  }
  EXPECT_EQ(crossings, 8);
  const double quarter =
      M_PI / 2 * std::sqrt((kInertia + kDown * kDown) / (kGravity * kDown)) * (1 + kTilt * kTilt / 16);
  EXPECT_NEAR(crossed, 15 * quarter, 0.005 * 15 * quarter);
  run(quarter);
  widest = std::fabs(std::asin(double(body.getWorldTransform().getBasis()[0][2])));
  EXPECT_NEAR(widest, kTilt, 0.02 * kTilt);
  world.world.removeRigidBody(&body);
}

TEST_P(Ring, SwingsOnAPackedBar) {
  const auto shape = makePackedShape(*makeSolid(bar(), "bar"), 256);
  btRigidBody& body = world.add(shape, 0, btVector3(0, 0, 0));
  body.setWorldTransform(shape->bodyTransform(btTransform::getIdentity()));
  swing(body);
}
TEST_P(Ring, SwingsOnABarOfTriangles) {
  btTriangleMesh triangles;
  addTriangles(bar(), triangles);
  swing(world.add(std::make_shared<btBvhTriangleMeshShape>(&triangles, true), 0, btVector3(0, 0, 0)));
}

std::string nameOf(const testing::TestParamInfo<Edges::ParamType>& info) {
  return std::string(std::get<0>(info.param) ? "Substeps" : "Bullet") +
         std::to_string(int(std::get<1>(info.param)));
}
const auto kAll = testing::Combine(testing::Bool(), testing::Values(60.0, 240.0));
INSTANTIATE_TEST_SUITE_P(Of, Edges, kAll, nameOf);
INSTANTIATE_TEST_SUITE_P(Of, Notch, kAll, nameOf);
INSTANTIATE_TEST_SUITE_P(Of, Ring, kAll, nameOf);

/// All points of contact of two bodies.
struct AllPoints : btCollisionWorld::ContactResultCallback {
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    points.push_back(point);
    return 0;
  }
  std::vector<btManifoldPoint> points;
};

// The fall of a cylinder along its axis is rounding: no top lies there, however far off it is reckoned.
TEST(BesideAnEdge, NoRoundBodyIsDeeperThanItIs) {
  constexpr double kRadius = 0.2, kLift = 0.002;
  TestWorld world;
  btRigidBody& tile =
      world.add(makePackedShape(*makeBox({1, 1, 0.2}), 256), 0, btVector3(0, 0, btScalar(-0.1)));
  btRigidBody& body = world.add(makeFineCylinderShape(kRadius, 0.3, 256), 1, btVector3(0, 0, 1));
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> random(-1, 1);
  int touching = 0;
  for (int i = 0; i < 3000; ++i) {
    const double lean = 0.03 * random(rng), lift = kLift * random(rng);
    btTransform place(btQuaternion(btVector3(0, 0, 1), btScalar(0.03 * random(rng))) *
                          btQuaternion(btVector3(1, 0, 0), btScalar(M_PI / 2 + lean)) *
                          btQuaternion(btVector3(0, 0, 1), btScalar(M_PI * random(rng))),
                      btVector3(btScalar(-0.5 + 0.05 * random(rng)), btScalar(0.02 * random(rng)),
                                btScalar(kRadius + lift)));
    body.setWorldTransform(place);
    AllPoints found;
    world.world.contactPairTest(&tile, &body, found);
    for (const btManifoldPoint& point : found.points)
      EXPECT_GT(point.getDistance(), -(kLift + 0.15 * std::fabs(std::sin(lean)) + 1e-3));
    touching += found.points.empty() ? 0 : 1;
  }
  EXPECT_GT(touching, 1000);
}

// A walk over smooth facets of a hull leaves the face that lies flat.
TEST(BesideAnEdge, NoHullTouchesWhereItIsNot) {
  constexpr double kRadius = 0.2, kHalf = 0.15;
  constexpr int kSides = 32;
  TestWorld world;
  btRigidBody& tile =
      world.add(makePackedShape(*makeBox({1, 1, 0.2}), 256), 0, btVector3(0, 0, btScalar(-0.1)));
  const auto hull = std::make_shared<btConvexHullShape>();
  hull->setMargin(0);
  for (int k = 0; k < kSides; ++k) {
    const double angle = 2 * M_PI * k / kSides;
    for (const double y : {-kHalf, kHalf})
      hull->addPoint(
          btVector3(btScalar(kRadius * std::cos(angle)), btScalar(y), btScalar(kRadius * std::sin(angle))));
  }
  btRigidBody& body = world.add(hull, 1, btVector3(0, 0, 1));
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> random(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const double x = 0.2 * random(rng);
    btTransform place(btQuaternion(btVector3(1, 0, 0), btScalar(0.001 * random(rng))) *
                          btQuaternion(btVector3(0, 1, 0), btScalar(M_PI * random(rng))),
                      btVector3(btScalar(x), 0, 0));
    btVector3 low, high;
    hull->getAabb(place, low, high);
    place.getOrigin().setZ(-low.z() - btScalar(0.0005 * (1 + random(rng))));
    body.setWorldTransform(place);
    AllPoints found;
    world.world.contactPairTest(&tile, &body, found);
    for (const btManifoldPoint& point : found.points) {
      if (point.getDistance() > 0) continue;
      EXPECT_LT(std::fabs(point.getPositionWorldOnA().x() - x), kRadius + 0.01);
      EXPECT_LT(std::fabs(point.getPositionWorldOnB().x() - x), kRadius + 0.01);
    }
  }
}

}  // namespace
}  // namespace innersphere::test
