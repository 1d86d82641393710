// Stiffness over twelve decades. A compliant contact is stable at any: a box sinks by its weight over
// stiffness and area, to 5 % and the 2 cm by which 500 spheres are rougher than its faces, and falls through
// a ground that cannot carry it. A penalty force is explicit: it rests at the same depth and adds no energy
// where PairOverlap::largest_step allows the step, and where the step is too long that says so before any is
// added.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "innersphere/packer.hpp"
#include "innersphere/pair_overlaps.hpp"
#include "innersphere/solids.hpp"
#include "watched_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kMass = 1000, kGravity = 9.81, kWeight = kMass * kGravity, kDt = 1.0 / 240;
constexpr double kDrop = 0.05;  // [m]

std::shared_ptr<PackingShape> box() {
  static const std::shared_ptr<PackingShape> shape = [] {
    PackOptions options;
    options.spheres = 500;
    options.overlap_errors = false;
    return makeShape(pack(*makeBox({1, 1, 1}), options));
  }();
  return shape;
}

void expectDepth(const btRigidBody& body, double stiffness) {
  const double depth = kWeight / stiffness, z = body.getWorldTransform().getOrigin().z();
  if (depth < 1) {
    EXPECT_NEAR(z, 0.5 - depth, 0.05 * depth + 0.02);
  } else {
    EXPECT_LT(z, -1) << "the ground cannot carry it";
  }
}

ContactOptions optionsOf(Response response, double stiffness) {
  ContactOptions options;
  options.response = response;
  options.stiffness = stiffness;
  return options;
}

std::string decade(const testing::TestParamInfo<int>& info) {
  return "1e" + std::to_string(info.param);
}

class Stiffness : public testing::TestWithParam<int> {};

TEST_P(Stiffness, OfCompliantContactsIsStable) {
  const double stiffness = std::pow(10, GetParam());
  WatchedWorld world(optionsOf(Response::compliant, stiffness));
  world.addFloor();
  const btRigidBody& body = world.add(box(), kMass, btVector3(0, 0, btScalar(0.5 + kDrop)));
  world.watch(4, kDt);
  EXPECT_TRUE(world.finite());
  EXPECT_LE(world.gain(), 1e-3 * kWeight * kDrop);
  expectDepth(body, stiffness);
}

TEST_P(Stiffness, OfPenaltyForcesIsStableWhereTheStepAllowsIt) {
  const double stiffness = std::pow(10, GetParam());
  WatchedWorld world(optionsOf(Response::penalty, stiffness));
  world.addFloor();
  const btRigidBody& body = world.add(box(), kMass, btVector3(0, 0, btScalar(0.5 + kDrop)));
  bool stable = true;
  for (double time = 0; stable && time < 4; time += kDt) {
    world.watch(kDt, kDt);
    for (const PairOverlap& pair : pairOverlaps(&world.dispatcher))
      stable = stable && pair.largest_step > kDt;
  }
  EXPECT_TRUE(world.finite());
  EXPECT_LE(world.gain(), 1e-3 * kWeight * kDrop);
  EXPECT_EQ(stable, stiffness < 3e9);
  if (stable) expectDepth(body, stiffness);
}

INSTANTIATE_TEST_SUITE_P(Of, Stiffness, testing::Range(0, 13), decade);

}  // namespace
}  // namespace innersphere::test
