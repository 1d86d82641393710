// From one sphere to a million, and spheres of which one is ten thousand times as large as another: boxes
// rest on each other within 1 % of their size and gain no energy, to 1 % of that of the fall; queries find
// exactly the pairs that overlap, and their volume to 1e-4. A body ten thousand times as small as the one it
// lies on does the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "innersphere/query.hpp"
#include "watched_world.hpp"

namespace innersphere::test {
namespace {

class SphereCount : public testing::TestWithParam<int> {};

TEST_P(SphereCount, BoxesMeetAndRest) {
  const int n = GetParam();
  WatchedWorld world;
  world.addFloor();
  const auto shape = makeShape(latticeBox({1, 1, 1}, n));
  world.add(shape, 1000, btVector3(0, 0, btScalar(0.502)));
  const btRigidBody& upper = world.add(shape, 1000, btVector3(btScalar(0.1), 0, btScalar(1.506)));
  world.watch(0.1, 1.0 / 240);
  EXPECT_TRUE(world.finite());
  EXPECT_NEAR(upper.getWorldTransform().getOrigin().z(), 1.5, 0.01);
  EXPECT_LE(world.gain(), 0.01 * 1000 * 9.81 * 0.008);
}

TEST_P(SphereCount, OverlapOfTwoLatticesIsThatOfTheirSpheres) {
  const int n = GetParam();
  const auto packing = std::make_shared<const Packing>(latticeBox({1, 1, 1}, n));
  const CollisionModel model(packing);
  // Moved by one and a half cells along x: every sphere of B lies between two of A, radius r apart from each.
  PairQuery query;
  query.a = query.b = &model;
  query.placement_b.translation = {1.5 / n, 0, 0};
  QueryContext context;
  const Overlap overlap = context.overlap(query);
  // Of each row of n spheres, B's first n - 1 or n - 2 touch two of A's: 2 n - 3 lenses a row (n > 1).
  const double r = packing->spheres[0].radius, d = 0.5 / n;
  const double s = 2 * r - d;
  const double lens = M_PI * s * s * (d * d + 4 * d * r) / (12 * d);
  const double count = n > 1 ? double(2 * n - 3) * n * n : 0;
  EXPECT_EQ(double(overlap.pair_count), count);
  EXPECT_NEAR(overlap.volume, count * lens, 1e-4 * count * lens);
}

INSTANTIATE_TEST_SUITE_P(Of, SphereCount, testing::Values(1, 2, 10, 46, 100),
                         [](const auto& info) { return "lattice_of_" + std::to_string(info.param); });

/// One sphere of 1 m, and many of a ten-thousandth of that about its surface.
Packing dustyBall() {
  Packing p;
  p.spheres.push_back({0, 0, 0, 1});
  constexpr int kDust = 1000;
  for (int i = 0; i < kDust; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDust, angle = 2.399963 * i, width = std::sqrt(1 - z * z);
    p.spheres.push_back({float(1.00011 * width * std::cos(angle)), float(1.00011 * width * std::sin(angle)),
                         float(1.00011 * z), 1e-4f});
  }
  return p;
}

TEST(RadiusRatio, OfTenThousandMissesNoPair) {
  const auto packing = std::make_shared<const Packing>(dustyBall());
  const CollisionModel model(packing);
  PairQuery query;
  query.a = query.b = &model;
  QueryContext context;
  for (const double apart : {1e-5, 1e-4, 1e-3, 0.5, 1.0, 1.9999, 2.0002}) {
    query.placement_b.translation = {apart, 0, 0};
    std::uint64_t pairs = 0;
    long double volume = 0;
    for (const Sphere& a : packing->spheres) {
      for (const Sphere& b : packing->spheres) {
        const long double x = (long double)(b.x) + apart - a.x, y = (long double)(b.y) - a.y,
                          z = (long double)(b.z) - a.z;
        const long double d = std::sqrt(x * x + y * y + z * z), sum = (long double)(a.radius) + b.radius,
                          difference = (long double)(a.radius) - b.radius, s = sum - d;
        if (!(s > 0)) continue;
        ++pairs;
        const long double smaller = std::min(a.radius, b.radius);
        volume += d <= std::fabs(difference)
                      ? 4.0L / 3 * M_PIl * smaller * smaller * smaller
                      : M_PIl * s * s * (d * d + 2 * d * sum - 3 * difference * difference) / (12 * d);
      }
    }
    const Overlap overlap = context.overlap(query);
    EXPECT_EQ(overlap.pair_count, pairs) << apart;
    EXPECT_NEAR(overlap.volume, double(volume), 1e-5 * double(volume)) << apart;
  }
}

TEST(SizeRatio, OfTenThousandRests) {
  constexpr double kSmall = 1e-4, kDt = 0.01 / 240;  // [m], [s]
  WatchedWorld world;
  world.add(makeShape(latticeBox({1, 1, 1}, 10)), 0, btVector3(0, 0, btScalar(-0.5)));
  const btRigidBody& small = world.add(makeShape(latticeBox({kSmall, kSmall, kSmall}, 4)), 1e-9,
                                       btVector3(btScalar(0.2), btScalar(0.1), btScalar(0.7 * kSmall)));
  world.watch(0.02, kDt);
  EXPECT_TRUE(world.finite());
  EXPECT_NEAR(small.getWorldTransform().getOrigin().z(), kSmall / 2, 0.01 * kSmall);
  EXPECT_LE(world.gain(), 0.01 * 1e-9 * 9.81 * 0.2 * kSmall);
}

}  // namespace
}  // namespace innersphere::test
