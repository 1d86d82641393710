// Two equal bodies that start inside each other, from touching to the same place: they are pushed apart, or
// stay where that is as good as any other way, with equal and opposite momenta. The solver parts them no
// faster than by twice their size in a second; penalty forces give back what the overlap holds, and no more.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "innersphere/packer.hpp"
#include "innersphere/pair_overlaps.hpp"
#include "innersphere/solids.hpp"
#include "watched_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kMass = 1000;  // [kg]

std::shared_ptr<PackingShape> makeBody(const std::string& name) {
  if (name == "box") return makeShape(latticeBox({1, 1, 1}, 6));
  if (name == "spheres") return makeShape(withoutSurface(latticeBox({1, 1, 1}, 6)));
  if (name == "ball") return makeShape(singleBall(0.5));
  PackOptions options;
  options.spheres = 200;
  options.overlap_errors = false;
  return makeShape(pack(*makeTorus(0.35, 0.15), options));
}

class Overlaps : public testing::TestWithParam<std::tuple<const char*, Response, double>> {};

TEST_P(Overlaps, ArePushedApartGently) {
  const auto& [name, response, share] = GetParam();
  ContactOptions options;
  options.response = response;
  WatchedWorld world(options);
  world.world.setGravity(btVector3(0, 0, 0));
  const auto shape = makeBody(name);
  const btScalar apart = btScalar(1 - share);
  const btRigidBody& a = world.add(shape, kMass, btVector3(0, 0, 0));
  const btRigidBody& b = world.add(shape, kMass, btVector3(apart, 0, 0));
  double fastest = 0, energy = 0, stored = 0;
  for (int i = 0; i < 240; ++i) {
    world.watch(1.0 / 240, 1.0 / 240);
    if (i == 0) {
      for (const PairOverlap& pair : pairOverlaps(&world.dispatcher)) stored += pair.penalty_energy;
    }
    energy = std::max(energy, world.kineticEnergy());
    for (const btRigidBody* body : {&a, &b})
      fastest = std::max(fastest, double(body->getLinearVelocity().length()));
  }
  EXPECT_TRUE(world.finite());
  if (response == Response::penalty) {
    EXPECT_LE(energy, 1.01 * stored);
  } else {
    EXPECT_LT(fastest, 2);
  }
  EXPECT_LT((a.getLinearVelocity() + b.getLinearVelocity()).length(), 1e-4 * std::max(1.0, fastest))
      << "momentum";
}

std::string caseName(const testing::TestParamInfo<Overlaps::ParamType>& info) {
  const auto& [body, response, share] = info.param;
  static const char* const kResponses[] = {"compliant", "rigid", "penalty"};
  return std::string(body) + "_" + kResponses[static_cast<int>(response)] + "_by_" +
         std::to_string(std::lround(1e6 * share)) + "_ppm";
}

INSTANTIATE_TEST_SUITE_P(
    Of, Overlaps,
    testing::Combine(testing::Values("box", "spheres", "ball", "torus"),
                     testing::Values(Response::compliant, Response::rigid, Response::penalty),
                     testing::Values(0.0, 1e-6, 1e-3, 0.01, 0.1, 0.5, 0.9, 0.999, 1 - 1e-6, 1.0)),
    caseName);

}  // namespace
}  // namespace innersphere::test
