// The order in which the tree's triangles are visited, against a walk in the plainest way. Of triangles that
// share a nearest point it decides which one counts, and so how bodies move.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "surface/triangle_bvh.hpp"

namespace innersphere::test {
namespace {

using Lanes = TriangleBvh::Lanes;
using Path = std::vector<std::size_t>;
constexpr float kLimit = 10;
const Lanes kNone = Lanes{} + kFar;

Surface scatteredTriangles(std::size_t count, std::mt19937& rng) {
  std::uniform_real_distribution<float> uniform(-1, 1);
  Surface surface;
  for (std::size_t t = 0; t < count; ++t) {
    const float x = uniform(rng), y = uniform(rng), z = uniform(rng);
    const auto v = static_cast<std::uint32_t>(surface.vertices.size());
    surface.vertices.insert(surface.vertices.end(), {{x, y, z}, {x + 0.1F, y, z}, {x, y + 0.1F, z}});
    surface.triangles.push_back({v, v + 1, v + 2});
  }
  return surface;
}

/// Few numbers, so that many are equal, some too far, and zeros of both signs. They rise with x.
float distanceOf(float x) {
  const float steps = std::floor(6 * (x + 1));
  return steps < 1 ? -0.0F : steps > 10 ? 2 * kLimit : std::floor(steps / 2);
}

/// No box is nearer than one around it.
Lanes distancesOf(const TriangleBvh::Boxes& boxes) {
  Lanes distances{};
  for (std::size_t k = 0; k < TriangleBvh::kWidth; ++k) {
    const float x = boxes.min[0][k];
    distances[k] = std::isinf(x) ? kFar : distanceOf(x);
  }
  return distances;
}

Lanes distancesOf(const TriangleBvh::Leaf& leaf) {
  Lanes distances{};
  for (std::size_t k = 0; k < TriangleBvh::kWidth; ++k) distances[k] = distanceOf(leaf.faces.offset[k]);
  return distances;
}

/// After so many visits.
float limitAfter(std::size_t visits) {
  return std::max(0.0F, kLimit - 0.1F * static_cast<float>(visits));
}

/// Shows the node or leaf at the end of a path through numbers of children: all others are kept out of reach.
template <typename OnNode, typename OnLeaf>
struct Guide {
  Lanes operator()(const TriangleBvh::Boxes& boxes) const {
    Lanes distances = kNone;
    if (depth < path.size()) {
      distances[path[depth++]] = 0;
    } else {
      on_node(boxes);
    }
    return distances;
  }
  Lanes operator()(const TriangleBvh::Leaf& leaf) const {
    on_leaf(leaf);
    return kNone;
  }
  const Path& path;
  const OnNode& on_node;
  const OnLeaf& on_leaf;
  mutable std::size_t depth = 0;
};

std::vector<std::uint32_t> visitedPlainly(const TriangleBvh& tree) {
  std::vector<std::uint32_t> visited;
  Path path;
  const std::function<void()> walk = [&] {
    Lanes distances = kNone;
    const auto on_node = [&](const TriangleBvh::Boxes& boxes) { distances = distancesOf(boxes); };
    const auto on_leaf = [&](const TriangleBvh::Leaf& leaf) {
      const Lanes of_leaf = distancesOf(leaf);
      for (std::size_t k = 0; k < TriangleBvh::kWidth; ++k) {
        if ((leaf.used >> k & 1) != 0 && of_leaf[k] <= limitAfter(visited.size()))
          visited.push_back(leaf.triangles[k]);
      }
    };
    tree.search(kLimit, Guide<decltype(on_node), decltype(on_leaf)>{path, on_node, on_leaf},
                [](std::uint32_t) { return btScalar(kLimit); });
    std::vector<std::size_t> children{0, 1, 2, 3};
    std::stable_sort(children.begin(), children.end(),
                     [&](std::size_t a, std::size_t b) { return distances[a] < distances[b]; });
    for (const std::size_t k : children) {
      if (!(distances[k] <= limitAfter(visited.size()))) continue;
      path.push_back(k);
      walk();
      path.pop_back();
    }
  };
  walk();
  return visited;
}

TEST(TriangleBvh, VisitsNearerBoxesFirstAndEqualOnesInTheirOrder) {
  std::mt19937 rng(11);
  const auto bound = [](const auto& of) { return distancesOf(of); };
  for (std::size_t count = 1; count < 700; count += 1 + count / 8) {
    const TriangleBvh tree(scatteredTriangles(count, rng));
    std::vector<std::uint32_t> visited;
    tree.search(kLimit, bound, [&](std::uint32_t triangle) {
      visited.push_back(triangle);
      return btScalar(limitAfter(visited.size()));
    });
    EXPECT_EQ(visited, visitedPlainly(tree)) << count;
  }
}

TEST(TriangleBvh, VisitsEachTriangleOnce) {
  std::mt19937 rng(12);
  const auto bound = [](const auto&) { return Lanes{}; };
  for (const std::size_t count : {0, 1, 4, 5, 8, 9, 16, 17, 600, 5000}) {
    const TriangleBvh tree(scatteredTriangles(count, rng));
    std::vector<int> visits(count);
    tree.search(0, bound, [&](std::uint32_t triangle) {
      ++visits[triangle];
      return btScalar(0);
    });
    EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), static_cast<std::ptrdiff_t>(count)) << count;
  }
}

}  // namespace
}  // namespace innersphere::test
