// The tree passes over nothing that meets.
#include "grid/cluster_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sphere_sets.hpp"

namespace innersphere::test {
namespace {

bool meet(const Sphere& a, const Sphere& b) {
  return std::hypot(double{a.x} - b.x, double{a.y} - b.y, double{a.z} - b.z) <= double{a.radius} + b.radius;
}

/// Clusters along a traversal through space, as a curve would bring them.
std::vector<core::Cluster> clustersAlongAWalk(std::size_t count) {
  Random random(count);
  std::vector<core::Cluster> clusters(count);
  Vec3d at{};
  for (core::Cluster& cluster : clusters) {
    const Vec3d step = random.direction();
    for (int i = 0; i < 3; ++i) at[i] += step[i];
    cluster.ball = {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2]),
                    static_cast<float>(random.uniform(0.1, 2))};
  }
  return clusters;
}

TEST(ClusterTree, FindsAllThatMeet) {
  for (const std::size_t count : {1, 31, 32, 33, 1024, 1025, 3000}) {
    const std::vector<core::Cluster> clusters = clustersAlongAWalk(count);
    ClusterTree tree;
    tree.build(clusters);
    Random random(7);
    for (int i = 0; i < 50; ++i) {
      const Sphere& some =
          clusters[static_cast<std::size_t>(random.uniform(0, 0.999) * static_cast<double>(count))].ball;
      const Sphere probe{some.x + 1, some.y, some.z, static_cast<float>(random.uniform(0, 20))};
      const auto first = static_cast<std::size_t>(random.uniform(0, 0.5) * static_cast<double>(count));
      const auto end =
          first + static_cast<std::size_t>(random.uniform(0, 1) * static_cast<double>(count - first));
      std::size_t tests = 0;
      const auto meeting = [&](const Sphere* balls, std::uint32_t n) {
        EXPECT_LE(n, ClusterTree::kRun);
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < n; ++k) bits |= meet(balls[k], probe) ? 1u << k : 0;
        tests += n;
        return bits;
      };
      std::vector<std::size_t> found, expected;
      EXPECT_TRUE(tree.forMeeting(first, end, meeting, [&](std::size_t c) {
        found.push_back(c);
        return true;
      }));
      for (std::size_t c = first; c < end; ++c) {
        if (meet(clusters[c].ball, probe)) expected.push_back(c);
      }
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(ClusterTree, PassesOverWhatIsFarAway) {
  const std::vector<core::Cluster> clusters = clustersAlongAWalk(100000);
  ClusterTree tree;
  tree.build(clusters);
  std::size_t tests = 0;
  const auto meeting = [&](const Sphere* balls, std::uint32_t n) {
    tests += n;
    std::uint32_t bits = 0;
    for (std::uint32_t k = 0; k < n; ++k) bits |= meet(balls[k], clusters[5000].ball) ? 1u << k : 0;
    return bits;
  };
  std::size_t found = 0;
  tree.forMeeting(0, clusters.size(), meeting, [&](std::size_t) { return ++found > 0; });
  EXPECT_GE(found, 1u);
  EXPECT_LT(tests, clusters.size() / 10);
}

TEST(ClusterTree, StopsWhenAsked) {
  const std::vector<core::Cluster> clusters = clustersAlongAWalk(2000);
  ClusterTree tree;
  tree.build(clusters);
  const auto all = [](const Sphere*, std::uint32_t n) { return n < 32 ? (1u << n) - 1 : ~0u; };
  std::size_t found = 0;
  EXPECT_FALSE(tree.forMeeting(0, clusters.size(), all, [&](std::size_t) { return ++found < 700; }));
  EXPECT_EQ(found, 700u);
}

}  // namespace
}  // namespace innersphere::test
