// What must hold of every grid, found out by walking through all of its cells.
#include "hash_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "sphere_sets.hpp"

namespace innersphere::test {
namespace {

using core::Block;
using core::GridView;

struct Cell {
  int level;
  long x, y, z;
};

Cell cellOf(std::uint64_t key, int bit) {
  constexpr int kBits = core::kAxisBits - core::kBlockBits;
  constexpr std::uint64_t kMask = (1u << kBits) - 1;
  return {static_cast<int>(key >> (3 * kBits)), static_cast<long>(4 * (key & kMask)) + (bit & 3),
          static_cast<long>(4 * (key >> kBits & kMask)) + (bit >> 2 & 3),
          static_cast<long>(4 * (key >> (2 * kBits) & kMask)) + (bit >> 4)};
}

/// Checks everything; returns the largest number of spheres in a cell.
std::size_t expectSound(const HashGrid& grid, const Spheres& spheres, float growth) {
  const GridView& view = grid.view();
  constexpr std::uint32_t kIndexMask = (1u << core::kIndexBits) - 1;
  std::map<std::uint32_t, std::vector<Cell>> cells_of;
  std::map<std::uint32_t, int> first_cells;
  std::size_t fullest = 0, total = 0, cells = 0;
  for (std::size_t slot = 0; slot < grid.tableSize(); ++slot) {
    const Block& block = view.blocks[slot];
    if (block.occupied == 0) continue;
    EXPECT_EQ(core::findBlock(view, block.key), &block);
    for (int bit = 0; bit < 64; ++bit) {
      if (!(block.occupied >> bit & 1)) continue;
      const std::uint32_t cell = core::cellIndex(block, bit), begin = view.cells[cell],
                          end = view.cells[cell + 1];
      EXPECT_LT(begin, end);
      ++cells;
      fullest = std::max<std::size_t>(fullest, end - begin);
      total += end - begin;
      for (std::uint32_t e = begin; e < end; ++e) {
        const std::uint32_t place = view.entries[e] & kIndexMask;
        if (e > begin) {
          EXPECT_LT(view.entries[e - 1] & kIndexMask, place);
        }
        cells_of[view.ids[place]].push_back(cellOf(block.key, bit));
        first_cells[view.ids[place]] += view.entries[e] >> core::kIndexBits == 7;
      }
    }
  }
  EXPECT_EQ(cells, grid.cellCount());
  EXPECT_EQ(total, grid.entryCount());
  EXPECT_EQ(cells_of.size(), spheres.size());
  for (const auto& [index, cells] : cells_of) {
    SCOPED_TRACE(index);
    const Sphere& s = spheres[index];
    const double r = s.radius + static_cast<double>(growth),
                 cell = std::ldexp(1.0, view.finest + cells[0].level);
    EXPECT_LE(cells.size(), 8u);
    EXPECT_EQ(first_cells[index], 1);
    EXPECT_LE(2 * r, cell * (1 + 1e-6));
    if (cells[0].level > 0) {
      EXPECT_LT(cell, 4 * r * (1 + 1e-6));
    }
    // Every cell that the sphere reaches into by more than rounding is there.
    const double slack = 1e-6 * view.radius;
    const double lo[3] = {s.x - view.centre.x - r, s.y - view.centre.y - r, s.z - view.centre.z - r};
    const double half[3] = {view.half.x, view.half.y, view.half.z};
    std::set<std::array<long, 3>> found;
    for (const Cell& c : cells) {
      EXPECT_EQ(c.level, cells[0].level);
      found.insert({c.x, c.y, c.z});
    }
    EXPECT_EQ(found.size(), cells.size());
    for (int corner = 0; corner < 8; ++corner) {
      std::array<long, 3> at;
      for (int axis = 0; axis < 3; ++axis) {
        const double p = lo[axis] + half[axis] + (corner >> axis & 1 ? 2 * r - slack : slack);
        at[axis] = static_cast<long>(std::floor(p / cell));
      }
      EXPECT_TRUE(found.count(at)) << at[0] << " " << at[1] << " " << at[2];
    }
  }
  // The order is a permutation, and every cluster's ball holds its spheres.
  std::set<std::uint32_t> seen;
  for (std::uint32_t k = 0; k < view.count; ++k) {
    const Sphere &s = view.spheres[k], &ball = view.clusters[k / core::kClusterSize];
    seen.insert(view.ids[k]);
    EXPECT_EQ(grid.placeOf(view.ids[k]), k);
    EXPECT_EQ(std::memcmp(&s, &spheres[view.ids[k]], sizeof s), 0);
    const double dx = s.x - double{ball.x}, dy = s.y - double{ball.y}, dz = s.z - double{ball.z};
    EXPECT_LE(std::sqrt(dx * dx + dy * dy + dz * dz) + s.radius, ball.radius);
  }
  EXPECT_EQ(seen.size(), spheres.size());
  EXPECT_EQ(view.cluster_count, (spheres.size() + core::kClusterSize - 1) / core::kClusterSize);
  return fullest;
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
    for (float growth : {0.0f, 0.01f, 10.0f}) {
      SCOPED_TRACE(testing::Message() << spheres.size() << " " << growth);
      expectSound(HashGrid(spheres, growth), spheres, growth);
    }
  }
}

/// Spheres of one level that do not overlap are at least a quarter of the cell's edge, so few of them touch
/// one cell.
TEST(HashGrid, CellsOfAPackingHoldAConstantNumber) {
  for (std::size_t n : {500u, 4000u}) {
    const Spheres spheres = randomSpheres(n, 0.2, 30, n);
    EXPECT_LE(expectSound(HashGrid(spheres, 0), spheres, 0), 32u);
  }
}

TEST(HashGrid, NoCellOverflows) {
  const Spheres same(5000, Sphere{0.1f, 0.2f, 0.3f, 0.5f});
  const HashGrid grid(same, 0);
  EXPECT_EQ(expectSound(grid, same, 0), 5000u);
}

TEST(HashGrid, IsTheSameEveryTime) {
  const Spheres spheres = randomSpheres(3000, 0.2, 30, 1);
  const HashGrid a(spheres, 0), b(spheres, 0);
  ASSERT_EQ(a.tableSize(), b.tableSize());
  ASSERT_EQ(a.cellCount(), b.cellCount());
  ASSERT_EQ(a.entryCount(), b.entryCount());
  for (std::size_t k = 0; k < a.tableSize(); ++k) {
    EXPECT_EQ(a.view().blocks[k].key, b.view().blocks[k].key);
    EXPECT_EQ(a.view().blocks[k].occupied, b.view().blocks[k].occupied);
    EXPECT_EQ(a.view().blocks[k].first, b.view().blocks[k].first);
  }
  constexpr std::size_t kSize = sizeof(std::uint32_t);
  EXPECT_EQ(std::memcmp(a.view().cells, b.view().cells, (a.cellCount() + 1) * kSize), 0);
  EXPECT_EQ(std::memcmp(a.view().entries, b.view().entries, a.entryCount() * kSize), 0);
  EXPECT_EQ(std::memcmp(a.view().ids, b.view().ids, a.view().count * kSize), 0);
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
  const HashGrid grid(spheres, 0);
  for (float last : grid.view().last_cell) EXPECT_LT(last, 1 << core::kAxisBits);
  EXPECT_LT(grid.view().coarsest - grid.view().finest, 1 << core::kLevelBits);
  core::CellBox box;
  EXPECT_FALSE(core::cellBox(grid.view(), {3e38f, 0, 0}, 1, box));
  EXPECT_FALSE(core::cellBox(grid.view(), {0, -3e38f, 0}, 1, box));
  ASSERT_TRUE(core::cellBox(grid.view(), {0, 0, 0}, 3e38f, box));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(box.lo[axis], 0u);
    EXPECT_EQ(static_cast<float>(box.hi[axis]), grid.view().last_cell[axis]);
  }
}

}  // namespace
}  // namespace innersphere::test
