// From a millimetre to a kilometre, and from long time steps to short ones: bodies fall from a fifth of their
// size, come to rest at their surface within 0.5 % of their size, and never have more energy than they
// started with, to 1 % of that of the fall. Two limits are Bullet's: steps in which gravity moves a body by
// more than 3 % of its height (g dt^2) are too long for it to rest on another, and masses above 1.4e7 kg
// count as infinite in contacts in single precision. Neither adds energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"
#include "watched_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kGravity = 9.81;  // [m/s^2]

struct Fall {
  const char* body;
  double size;  // [m]
  double dt;    // [s]

  friend void PrintTo(const Fall& fall, std::ostream* out) {
    *out << fall.body << " of " << fall.size << " m, steps of " << fall.dt << " s";
  }
};

/// Half as high as it is wide. The torus has a quarter of its width.
std::shared_ptr<PackingShape> makeBody(const std::string& name, double size) {
  if (name == "torus") {
    PackOptions options;
    options.spheres = 150;
    options.overlap_errors = false;
    return makeShape(pack(*makeTorus(0.375 * size, 0.125 * size), options));
  }
  return makeShape(latticeBox({size, size, 0.5 * size}, 6));
}

double heightOf(const Fall& fall) {
  return (std::string(fall.body) == "torus" ? 0.25 : 0.5) * fall.size;
}

class Falls : public testing::TestWithParam<Fall> {};

TEST_P(Falls, OnAPlaneAndOnEachOther) {
  const Fall& fall = GetParam();
  const double height = heightOf(fall), drop = 0.2 * fall.size;
  WatchedWorld world;
  world.addFloor();
  const auto shape = makeBody(fall.body, fall.size);
  const double mass = std::min(1000 * std::pow(fall.size, 3), 1e6);
  const btRigidBody& lower = world.add(shape, mass, btVector3(0, 0, btScalar(height / 2 + drop)));
  const btRigidBody& upper = world.add(shape, mass, btVector3(0, 0, btScalar(1.5 * height + 2 * drop)));
  // In units of the time of the fall; short steps are not run for longer than it takes to see the outcome.
  const double time = std::sqrt(2 * drop / kGravity);
  world.watch((fall.dt < 1e-3 ? 3 : 10) * std::max(time, 2 * fall.dt) + 20 * fall.dt, fall.dt);
  EXPECT_TRUE(world.finite());
  EXPECT_LT(world.gain(), 0.01 * mass * kGravity * 3 * drop);
  if (kGravity * fall.dt * fall.dt > 0.04 * height) return;  // too long a step to rest
  EXPECT_NEAR(lower.getWorldTransform().getOrigin().z(), height / 2, 0.005 * fall.size);
  EXPECT_NEAR(upper.getWorldTransform().getOrigin().z(), 1.5 * height, 0.01 * fall.size);
}

std::string nameOf(const testing::TestParamInfo<Fall>& info) {
  const Fall& f = info.param;
  return std::string(f.body) + "_of_" + std::to_string(std::lround(1000 * f.size)) + "_mm_at_" +
         std::to_string(std::lround(1 / f.dt)) + "_Hz";
}

std::vector<Fall> falls() {
  std::vector<Fall> all;
  for (const char* body : {"box", "torus"}) {
    for (const double size : {1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3}) {
      if (size < 200) all.push_back({body, size, 1.0 / 240});
      // As many steps in a fall as a body of 1 m makes.
      if (size != 1) all.push_back({body, size, std::sqrt(size) / 240});
    }
    for (const double rate : {30, 60, 120, 1000, 10000}) all.push_back({body, 1, 1 / rate});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Of, Falls, testing::ValuesIn(falls()), nameOf);

/// Where a body of this mass is after a second on a plane, at first at its surface [m].
double heightAfterASecond(std::shared_ptr<btCollisionShape> shape, double mass) {
  WatchedWorld world;
  world.addFloor();
  const btRigidBody& body = world.add(std::move(shape), mass, btVector3(0, 0, 5));
  world.watch(1, 1.0 / 240);
  EXPECT_TRUE(world.finite());
  EXPECT_LT(world.gain(), 1e-6 * mass);
  return body.getWorldTransform().getOrigin().z();
}

TEST(HeavyBodies, AreHeldAsFarAsBulletHoldsItsOwn) {
  // An inverse mass whose square is below that of the scalars' epsilon counts as 0: Bullet skips the contact.
  const double limit = std::sqrt(3.0) / double(SIMD_EPSILON);
  for (const double mass : {0.5 * limit, 2 * limit}) {
    const double expected = mass < limit ? 5 : 5 - 9.81 / 2;
    EXPECT_NEAR(heightAfterASecond(makeShape(latticeBox({10, 10, 10}, 6)), mass), expected, 0.05);
    EXPECT_NEAR(heightAfterASecond(std::make_shared<btBoxShape>(btVector3(5, 5, 5)), mass), expected, 0.05);
  }
}

}  // namespace
}  // namespace innersphere::test
