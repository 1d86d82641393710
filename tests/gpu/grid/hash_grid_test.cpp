// What must hold of every grid, found out by walking through all of its cells.
#include "grid/hash_grid.hpp"

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

using core::GridView;

/// Coordinates of a cell of the Hilbert curve.
using Place = std::array<std::uint32_t, 3>;

int levelIn(const HashGrid& grid, std::uint32_t place) {
  return std::max(core::levelOf(grid.view().spheres[place].radius), grid.lowestLevel());
}

/// Spheres come by level, and each level looks in a grid level that has cells of its own size or of finer
/// ones.
void expectSoundLevels(const HashGrid& grid) {
  const GridView& view = grid.view();
  for (std::uint32_t k = 1; k < view.count; ++k) EXPECT_LE(levelIn(grid, k - 1), levelIn(grid, k));
  EXPECT_EQ(core::gridLevelOf(view, levelIn(grid, view.count - 1)), view.grid_levels - 1);
  for (int grid_level = 0; grid_level < view.grid_levels; ++grid_level)
    EXPECT_EQ(4 * core::reachOf(view, grid_level), std::ldexp(1.0f, view.finest + grid_level));
}

/// What the cell of a point lists.
std::set<std::uint32_t> listedAt(const GridView& view, int grid_level, const Vec3f& p) {
  core::CellBox box;
  std::set<std::uint32_t> places;
  if (!core::cellBox(view, grid_level, p, p, box)) return places;
  const core::Cell cell = core::findCell(view, core::cellKey(grid_level, box.lo[0], box.lo[1], box.lo[2]));
  places.insert(view.listed + cell.first, view.listed + cell.first + cell.count);
  EXPECT_EQ(places.size(), cell.count);
  return places;
}

/// A sphere is listed in the cells of all points that a query sphere of the grid level can reach it from, and
/// each cell's list is in order and near it.
void expectSoundLists(const HashGrid& grid) {
  const GridView& view = grid.view();
  Random random(1);
  for (int grid_level = 0; grid_level < view.grid_levels; ++grid_level) {
    for (std::uint32_t k = 0; k < view.count; k += 1 + view.count / 200) {
      if (grid_level > 0 && levelIn(grid, k) < view.finest + grid_level - 1) continue;
      const Sphere& s = view.centred[k];
      const double reach = (double{s.radius} + core::reachOf(view, grid_level)) * (1 - 1e-5);
      for (int i = 0; i < 20; ++i) {
        double d[3], length = 0;
        for (double& x : d) x = random.uniform(-1, 1), length += x * x;
        const double step = reach * std::cbrt(random.uniform(0, 1)) / std::max(std::sqrt(length), 1e-3);
        const Vec3f p{static_cast<float>(s.x + step * d[0]), static_cast<float>(s.y + step * d[1]),
                      static_cast<float>(s.z + step * d[2])};
        const double slack = 1e-6 * view.radius;  // what rounding of the point may add
        if (step * std::sqrt(length) + slack < reach) {
          EXPECT_TRUE(listedAt(view, grid_level, p).count(k));
        }
      }
    }
  }
  std::size_t used = 0, listed = 0;
  for (std::size_t slot = 0; slot < grid.tableSize(); ++slot) {
    const core::Cell& cell = view.cells[slot];
    if (cell.count == 0) continue;
    ++used;
    listed += cell.count;
    EXPECT_EQ(core::findCell(view, cell.key).first, cell.first);
    EXPECT_EQ(cell.first % core::kListStep, 0u);
    const std::uint32_t* places = view.listed + cell.first;
    EXPECT_TRUE(std::is_sorted(places, places + cell.count));
    EXPECT_LT(places[cell.count - 1], view.count);
    for (std::uint32_t i = cell.count; i % core::kListStep != 0; ++i) EXPECT_EQ(places[i], view.count);
  }
  EXPECT_LE(2 * used, grid.tableSize());
  EXPECT_LE(listed, view.listed_count);
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
    EXPECT_EQ(view.centred[k].x, s.x - view.centre.x);
    EXPECT_EQ(view.centred[k].y, s.y - view.centre.y);
    EXPECT_EQ(view.centred[k].z, s.z - view.centre.z);
    EXPECT_EQ(view.centred[k].radius, s.radius);
  }
  EXPECT_EQ(seen.size(), spheres.size());
  std::uint32_t next = 0;
  for (std::uint32_t c = 0; c < view.cluster_count; ++c) {
    const core::Cluster& cluster = view.clusters[c];
    EXPECT_EQ(cluster.first, next);
    next += cluster.count;
    EXPECT_GE(cluster.count, 1u);
    EXPECT_LE(cluster.count, core::kClusterSize);
    EXPECT_EQ(levelIn(grid, cluster.first), levelIn(grid, next - 1));
    for (std::uint32_t k = cluster.first; k < next; ++k) {
      const Sphere &s = view.spheres[k], &ball = cluster.ball;
      const double dx = s.x - double{ball.x}, dy = s.y - double{ball.y}, dz = s.z - double{ball.z};
      EXPECT_LE(std::sqrt(dx * dx + dy * dy + dz * dz) + s.radius, ball.radius);
    }
  }
  EXPECT_EQ(next, view.count);
}

void expectSound(const HashGrid& grid, const Spheres& spheres) {
  expectSoundLevels(grid);
  expectSoundLists(grid);
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

/// The memory of a grid and the work of a query sphere stay proportional to the packing.
TEST(HashGrid, ListsOfAPackingAreShort) {
  for (std::size_t n : {500u, 4000u}) {
    const HashGrid grid(randomSpheres(n, 0.2, 30, n));
    EXPECT_LE(grid.view().listed_count, 20 * n);
    for (std::size_t slot = 0; slot < grid.tableSize(); ++slot)
      EXPECT_LE(grid.view().cells[slot].count, 200u);
  }
}

TEST(HashGrid, NothingOverflows) {
  const Spheres same(5000, Sphere{0.1f, 0.2f, 0.3f, 0.5f});
  const HashGrid grid(same);
  expectSound(grid, same);
  EXPECT_EQ(grid.view().grid_levels, 1);
}

TEST(HashGrid, IsTheSameEveryTime) {
  const Spheres spheres = randomSpheres(3000, 0.2, 30, 1);
  const HashGrid a(spheres), b(spheres);
  ASSERT_EQ(a.tableSize(), b.tableSize());
  ASSERT_EQ(a.view().cluster_count, b.view().cluster_count);
  EXPECT_EQ(std::memcmp(a.view().cells, b.view().cells, a.tableSize() * sizeof(core::Cell)), 0);
  ASSERT_EQ(a.view().listed_count, b.view().listed_count);
  EXPECT_EQ(std::memcmp(a.view().listed, b.view().listed, a.view().listed_count * sizeof(std::uint32_t)), 0);
  EXPECT_EQ(std::memcmp(a.view().ids, b.view().ids, a.view().count * sizeof(std::uint32_t)), 0);
}

/// The curve visits every cell once, in steps to a neighbour, and every cube of 2^k cells in one run.
TEST(HashGrid, HilbertCurve) {
  for (int bits : {1, 2, 4}) {
    const std::uint32_t n = 1u << bits;
    std::map<std::uint64_t, Place> cells;
    for (std::uint32_t x = 0; x < n; ++x) {
      for (std::uint32_t y = 0; y < n; ++y) {
        for (std::uint32_t z = 0; z < n; ++z)
          cells[core::hilbertPlace(core::kHilbertTable, x, y, z, bits)] = {x, y, z};
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
      EXPECT_EQ(core::hilbertPlace(core::kHilbertTable, cell[0] >> 1, cell[1] >> 1, cell[2] >> 1, bits - 1),
                place >> 3);
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
  const GridView& view = grid.view();
  core::CellBox box;
  EXPECT_FALSE(core::cellBox(view, 0, {3e38f, -1, -1}, {3e38f, 1, 1}, box));
  EXPECT_FALSE(core::cellBox(view, 0, {-1, -3e38f, -1}, {1, -3e38f, 1}, box));
  ASSERT_TRUE(core::cellBox(view, 0, {-3e38f, -3e38f, -3e38f}, {3e38f, 3e38f, 3e38f}, box));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(box.lo[axis], 0u);
    EXPECT_LT(box.hi[axis], 1u << core::kAxisBits);
  }
}

}  // namespace
}  // namespace innersphere::test
