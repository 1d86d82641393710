// What must hold of every grid, found out by walking through all of its cells.
#include "hash_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <set>

#include "core/hilbert.hpp"
#include "sphere_sets.hpp"

namespace innersphere::test {
namespace {

using core::Block;
using core::GridView;
using core::Level;

using Cell = std::array<std::uint32_t, 3>;

/// The cell of the finest level that holds the centre.
Cell cellOf(const GridView& view, const Sphere& s) {
  const core::Vec3f p = core::Vec3f{s.x, s.y, s.z} - view.centre;
  core::CellBox box{};
  EXPECT_TRUE(core::cellBox(view, p, p, box));
  return {box.lo[0], box.lo[1], box.lo[2]};
}

void expectSoundLevels(const GridView& view) {
  std::uint32_t first = 0;
  for (int l = 0; l < view.level_count; ++l) {
    const Level& level = view.levels[l];
    if (level.count == 0) continue;
    EXPECT_EQ(level.first, first);
    first += level.count;
    const double cell = std::ldexp(1.0, view.finest + l);
    float largest = 0;
    for (std::uint32_t k = level.first; k < first; ++k) {
      const double r = view.spheres[k].radius;
      largest = std::max(largest, view.spheres[k].radius);
      EXPECT_LE(2 * r, cell);
      if (l > 0) {
        EXPECT_LT(cell, 4 * r);
      }
    }
    EXPECT_EQ(level.largest, largest);
    EXPECT_GE(level.block_shift, l);
  }
  EXPECT_EQ(first, view.count);
}

/// Every sphere is in exactly one block, that of its centre, and is found there.
void expectSoundBlocks(const HashGrid& grid) {
  const GridView& view = grid.view();
  std::vector<bool> seen(view.count, false);
  std::vector<std::uint32_t> blocks(static_cast<std::size_t>(view.level_count), 0);
  std::size_t used = 0;
  for (std::size_t slot = 0; slot < grid.tableSize(); ++slot) {
    const Block& block = view.blocks[slot];
    if (block.count == 0) continue;
    ++used;
    const int l = static_cast<int>(block.key >> (3 * core::kAxisBits));
    ASSERT_LT(l, view.level_count);
    ++blocks[static_cast<std::size_t>(l)];
    EXPECT_EQ(core::findBlock(view, block.key).first, block.first);
    for (std::uint32_t k = block.first; k < block.first + block.count; ++k) {
      ASSERT_LT(k, view.count);
      EXPECT_FALSE(seen[k]);
      seen[k] = true;
      const Cell cell = cellOf(view, view.spheres[k]);
      const int shift = view.levels[l].block_shift;
      EXPECT_EQ(core::blockKey(l, cell[0] >> shift, cell[1] >> shift, cell[2] >> shift), block.key);
      EXPECT_GE(k, view.levels[l].first);
      EXPECT_LT(k, view.levels[l].first + view.levels[l].count);
    }
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), false), 0);
  for (int l = 0; l < view.level_count; ++l)
    EXPECT_EQ(view.levels[l].blocks, blocks[static_cast<std::size_t>(l)]);
  EXPECT_LE(2 * used, grid.tableSize());
}

/// The order is a permutation, every sphere is in one cluster, and a cluster's ball holds its spheres.
void expectSoundOrder(const HashGrid& grid, const Spheres& spheres) {
  const GridView& view = grid.view();
  std::set<std::uint32_t> seen;
  for (std::uint32_t k = 0; k < view.count; ++k) {
    const Sphere& s = view.spheres[k];
    seen.insert(view.ids[k]);
    EXPECT_EQ(grid.placeOf(view.ids[k]), k);
    EXPECT_EQ(std::memcmp(&s, &spheres[view.ids[k]], sizeof s), 0);
    EXPECT_EQ(grid.columns().x[k], s.x - view.centre.x);
    EXPECT_EQ(grid.columns().y[k], s.y - view.centre.y);
    EXPECT_EQ(grid.columns().z[k], s.z - view.centre.z);
    EXPECT_EQ(grid.columns().radius[k], s.radius);
  }
  EXPECT_EQ(seen.size(), spheres.size());
  std::uint32_t next = 0;
  for (std::uint32_t c = 0; c < view.cluster_count; ++c) {
    const core::Cluster& cluster = view.clusters[c];
    EXPECT_EQ(cluster.first, next);
    next += cluster.count;
    EXPECT_GE(cluster.count, 1u);
    EXPECT_LE(cluster.count, core::kClusterSize);
    EXPECT_EQ(std::max(core::levelOf(view.spheres[cluster.first].radius), view.finest),
              std::max(core::levelOf(view.spheres[next - 1].radius), view.finest));
    float smallest = view.largest;
    for (std::uint32_t k = cluster.first; k < next; ++k) {
      const Sphere &s = view.spheres[k], &ball = cluster.ball;
      const double dx = s.x - double{ball.x}, dy = s.y - double{ball.y}, dz = s.z - double{ball.z};
      EXPECT_LE(std::sqrt(dx * dx + dy * dy + dz * dz) + s.radius, ball.radius);
      smallest = std::min(smallest, s.radius);
    }
    EXPECT_EQ(cluster.smallest, smallest);
  }
  EXPECT_EQ(next, view.count);
}

void expectSound(const HashGrid& grid, const Spheres& spheres) {
  expectSoundLevels(grid.view());
  expectSoundBlocks(grid);
  expectSoundOrder(grid, spheres);
}

TEST(HashGrid, IsSound) {
  const Spheres sets[] = {randomSpheres(2000, 0.2, 30, 1),
                          clusteredSpheres(800, 8, 2),
                          lattice(6, 0.25),
                          concentricSpheres(40),
                          randomSpheres(500, 0.5, 1e4, 3),
                          dust(500, 4),
                          moved(randomSpheres(500, 0.2, 30, 5), {1e5, -3e4, 2e5}),
                          {{0, 0, 0, 1}},
                          {{-3, 8, 1e6f, 1e-30f}}};
  for (const Spheres& spheres : sets) {
    SCOPED_TRACE(spheres.size());
    expectSound(HashGrid(spheres), spheres);
  }
}

/// A lookup of a cluster visits few blocks if few of them are nearly empty.
TEST(HashGrid, BlocksOfAPackingAreNeitherEmptyNorCrowded) {
  for (std::size_t n : {500u, 4000u}) {
    const HashGrid grid(randomSpheres(n, 0.2, 30, n));
    for (int l = 0; l < grid.view().level_count; ++l) {
      const Level& level = grid.view().levels[l];
      if (level.blocks < 2) continue;
      EXPECT_GE(level.count, 2 * level.blocks);
      EXPECT_LE(level.count, 200 * level.blocks);
    }
  }
}

TEST(HashGrid, NothingOverflows) {
  const Spheres same(5000, Sphere{0.1f, 0.2f, 0.3f, 0.5f});
  const HashGrid grid(same);
  expectSound(grid, same);
  EXPECT_EQ(grid.view().levels[0].blocks, 1u);
}

TEST(HashGrid, IsTheSameEveryTime) {
  const Spheres spheres = randomSpheres(3000, 0.2, 30, 1);
  const HashGrid a(spheres), b(spheres);
  ASSERT_EQ(a.tableSize(), b.tableSize());
  ASSERT_EQ(a.view().cluster_count, b.view().cluster_count);
  EXPECT_EQ(std::memcmp(a.view().blocks, b.view().blocks, a.tableSize() * sizeof(Block)), 0);
  EXPECT_EQ(std::memcmp(a.view().ids, b.view().ids, a.view().count * sizeof(std::uint32_t)), 0);
}

/// The curve visits every cell once, in steps to a neighbour, and every cube of 2^k cells in one run.
TEST(HashGrid, HilbertCurve) {
  for (int bits : {1, 2, 4}) {
    const std::uint32_t n = 1u << bits;
    std::map<std::uint64_t, Cell> cells;
    for (std::uint32_t x = 0; x < n; ++x) {
      for (std::uint32_t y = 0; y < n; ++y) {
        for (std::uint32_t z = 0; z < n; ++z) cells[core::hilbertPlace(x, y, z, bits)] = {x, y, z};
      }
    }
    ASSERT_EQ(cells.size(), std::size_t{n} * n * n);
    EXPECT_EQ(cells.rbegin()->first, cells.size() - 1);
    for (std::uint64_t place = 1; place < cells.size(); ++place) {
      int steps = 0;
      for (int i = 0; i < 3; ++i)
        steps += std::abs(static_cast<int>(cells[place][i]) - static_cast<int>(cells[place - 1][i]));
      EXPECT_EQ(steps, 1);
    }
    for (const auto& [place, cell] : cells)
      EXPECT_EQ(core::hilbertPlace(cell[0] >> 1, cell[1] >> 1, cell[2] >> 1, bits - 1), place >> 3);
  }
}

TEST(HashGrid, LevelOfARadius) {
  Random random(1);
  for (int i = 0; i < 10000; ++i) {
    const float r = static_cast<float>(std::exp(random.uniform(-60, 60)));
    const double cell = std::ldexp(1.0, core::levelOf(r));
    EXPECT_LE(2.0 * r, cell);
    EXPECT_LT(cell, 4.0 * r);
  }
  EXPECT_EQ(core::levelOf(0.5f), 0);
  EXPECT_EQ(core::levelOf(std::nextafter(0.5f, 1.0f)), 1);
  EXPECT_EQ(core::levelOf(0), core::levelOf(1e-38f));
}

TEST(HashGrid, CellCoordinatesCannotWrap) {
  Spheres spheres{{0, 0, 0, 1}, {1e9f, 1e9f, 1e9f, 1e-4f}, {-1e9f, 5, 5, 1e-4f}};
  const HashGrid grid(spheres);
  for (float last : grid.view().last_cell) EXPECT_LT(last, 1 << core::kAxisBits);
  EXPECT_LE(grid.view().level_count, 1 << core::kLevelBits);
  core::CellBox box;
  EXPECT_FALSE(core::cellBox(grid.view(), {3e38f, -1, -1}, {3e38f, 1, 1}, box));
  EXPECT_FALSE(core::cellBox(grid.view(), {-1, -3e38f, -1}, {1, -3e38f, 1}, box));
  ASSERT_TRUE(core::cellBox(grid.view(), {-3e38f, -3e38f, -3e38f}, {3e38f, 3e38f, 3e38f}, box));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(box.lo[axis], 0u);
    EXPECT_EQ(static_cast<float>(box.hi[axis]), grid.view().last_cell[axis]);
  }
}

}  // namespace
}  // namespace innersphere::test
