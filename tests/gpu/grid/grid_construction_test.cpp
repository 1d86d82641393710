// A grid depends on its spheres only: not on threads, not on what its memory held before, not on the order in
// which cells are found.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "grid/hash_grid.hpp"
#include "sphere_sets.hpp"

namespace innersphere::test {
namespace {

/// Many spheres that do not overlap, of radii that differ by up to `ratio`, made in no time.
Spheres jitteredLattice(int n, double ratio, std::uint64_t seed) {
  Random random(seed);
  Spheres spheres;
  for (int i = 0; i < n * n * n; ++i) {
    const double radius = 0.5 * std::pow(ratio, -random.uniform());
    const double room = 0.5 - radius;
    const auto place = [&](int cell) { return static_cast<float>(cell + room * random.uniform(-1, 1)); };
    spheres.push_back({place(i % n), place(i / n % n), place(i / n / n), static_cast<float>(radius)});
  }
  return spheres;
}

template <typename T>
void expectSame(const T* a, const T* b, std::size_t count) {
  EXPECT_EQ(std::memcmp(a, b, count * sizeof(T)), 0);
}

void expectSame(const HashGrid& a, const HashGrid& b) {
  const core::GridView &x = a.view(), &y = b.view();
  ASSERT_EQ(x.count, y.count);
  ASSERT_EQ(x.cluster_count, y.cluster_count);
  ASSERT_EQ(x.listed_count, y.listed_count);
  ASSERT_EQ(a.tableSize(), b.tableSize());
  EXPECT_EQ(x.hash_shift, y.hash_shift);
  EXPECT_EQ(x.finest, y.finest);
  EXPECT_EQ(x.grid_levels, y.grid_levels);
  EXPECT_EQ(x.radius, y.radius);
  EXPECT_EQ(x.reach, y.reach);
  expectSame(x.spheres, y.spheres, x.count);
  expectSame(x.centred, y.centred, x.count + 1);
  expectSame(x.ids, y.ids, x.count);
  expectSame(x.cells, y.cells, a.tableSize());
  expectSame(x.listed, y.listed, x.listed_count);
  for (std::uint32_t c = 0; c < x.cluster_count; ++c) {
    EXPECT_EQ(x.clusters[c].first, y.clusters[c].first);
    expectSame(&x.clusters[c].ball, &y.clusters[c].ball, 1);
  }
}

TEST(GridConstruction, SameForAnyNumberOfThreads) {
  for (const double ratio : {1.0, 20.0}) {
    const Spheres spheres = jitteredLattice(36, ratio, 1);
    const HashGrid some(spheres);
    for (const int threads : {1, 2, 3, 5}) {
      tbb::task_arena arena(threads);
      arena.execute([&] { expectSame(some, HashGrid(spheres)); });
    }
  }
}

TEST(GridConstruction, MemoryOfOtherGridsDoesNotMatter) {
  const Spheres sets[] = {jitteredLattice(12, 3, 1),       dust(300, 2),
                          randomSpheres(500, 0.3, 1e4, 3), {{1, 2, 3, 4}},
                          jitteredLattice(20, 10, 4),      lattice(3, 0.5)};
  HashGrid grid;
  GridScratch scratch;
  for (int round = 0; round < 2; ++round) {
    for (const Spheres& spheres : sets) {
      grid.build(spheres.data(), planGrid(spheres.data(), spheres.size()), scratch);
      expectSame(grid, HashGrid(spheres));
    }
  }
}

/// Lists come by rising key. In the table, whatever is between a cell and where its key would be has a
/// smaller key; there is one such table for any set of keys.
TEST(GridConstruction, CellsAreWhereTheirKeysSay) {
  for (const Spheres& spheres : {jitteredLattice(15, 10, 1), dust(500, 2), randomSpheres(500, 0.3, 1e4, 3)}) {
    const HashGrid grid(spheres);
    const core::GridView& view = grid.view();
    std::vector<core::Cell> cells;
    for (std::size_t slot = 0; slot < grid.tableSize(); ++slot) {
      const core::Cell& cell = view.cells[slot];
      if (cell.count == 0) continue;
      cells.push_back(cell);
      for (std::size_t at = core::hashCell(view, cell.key); at != slot; at = (at + 1) % grid.tableSize()) {
        EXPECT_GT(view.cells[at].count, 0u);
        EXPECT_LT(view.cells[at].key, cell.key);
      }
    }
    std::sort(cells.begin(), cells.end(),
              [](const core::Cell& a, const core::Cell& b) { return a.key < b.key; });
    std::uint32_t end = 0;
    for (const core::Cell& cell : cells) {
      EXPECT_EQ(cell.first, end);
      end += (cell.count + core::kListStep - 1) / core::kListStep * core::kListStep;
    }
    EXPECT_EQ(end, view.listed_count);
  }
}

/// By brute force in double precision: which cells list a sphere.
TEST(GridConstruction, ACellListsWhatItsQuerySpheresCanMeet) {
  const Spheres spheres = jitteredLattice(6, 30, 7);
  const HashGrid grid(spheres);
  const core::GridView& view = grid.view();
  std::size_t checked = 0;
  for (int grid_level = 0; grid_level < view.grid_levels; ++grid_level) {
    const double edge = std::ldexp(1.0, view.finest + grid_level);
    core::CellBox all;
    constexpr float kMax = 3e38f;
    ASSERT_TRUE(core::cellBox(view, grid_level, {-kMax, -kMax, -kMax}, {kMax, kMax, kMax}, all));
    for (std::uint32_t z = 0; z <= all.hi[2]; ++z) {
      for (std::uint32_t y = 0; y <= all.hi[1]; ++y) {
        for (std::uint32_t x = 0; x <= all.hi[0]; ++x) {
          const core::Cell cell = core::findCell(view, core::cellKey(grid_level, x, y, z));
          const std::uint32_t* const begin = view.listed + cell.first;
          for (std::uint32_t place = 0; place < view.count; ++place) {
            const Sphere& s = view.centred[place];
            const bool looked_for =
                grid_level == 0 || core::levelOf(s.radius) >= view.finest + grid_level - 1;
            const double p[3] = {s.x, s.y, s.z}, half[3] = {view.half.x, view.half.y, view.half.z};
            const std::uint32_t at[3] = {x, y, z};
            double gap2 = 0;
            for (int i = 0; i < 3; ++i) {
              const double lo = (at[i] - 1.0) * edge - half[i];
              const double gap = std::max({lo - p[i], p[i] - lo - edge, 0.0});
              gap2 += gap * gap;
            }
            const double reach = s.radius + edge / 4, gap = std::sqrt(gap2);
            if (std::fabs(gap - reach) < 1e-5 * edge) continue;  // either is right
            const bool listed = std::binary_search(begin, begin + cell.count, place);
            EXPECT_EQ(listed, looked_for && gap < reach);
            ++checked;
          }
        }
      }
    }
  }
  EXPECT_GT(checked, 10000u);
}

}  // namespace
}  // namespace innersphere::test
