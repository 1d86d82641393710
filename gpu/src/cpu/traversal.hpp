// Traverses grids on the CPU. Many query spheres go together, so that each step is done for all of them side
// by side: where they are, where their cells are, and the tests.
#pragma once

#include <algorithm>
#include <cmath>

#include "cpu/simd.hpp"
#include "grid/cell_lists.hpp"
#include "grid/occupancy.hpp"

namespace innersphere {

static_assert(kLanes <= CellLists::kPastEnd, "lists are read in groups");

/// Holds what a traversal goes through: a grid, and the spheres that its cells list.
struct TraversedGrid {
  const core::GridView& grid;
  SphereColumns listed;
};

/// Returns a bit for each of up to 32 balls of the searching body that can meet the grid.
inline std::uint32_t ballsMeeting(const core::Traversal& traversal, const Occupancy& occupancy,
                                  const Sphere* balls, std::uint32_t count) {
  constexpr std::uint32_t kMost = 32;
  const core::Search search = traversal.search;
  const core::GridView grid = traversal.grid;
  float x[kMost], y[kMost], z[kMost], radius[kMost];
  std::uint32_t met = 0;
  for (std::uint32_t k = 0; k < count; ++k) {
    const core::Probe probe = core::makeBallProbe(search, balls[k]);
    x[k] = probe.p.x;
    y[k] = probe.p.y;
    z[k] = probe.p.z;
    radius[k] = probe.radius;
    met |= (core::meetsBounds(grid, probe.p, probe.radius) ? 1u : 0u) << k;
  }
  std::uint32_t left = 0;
  for (; met != 0; met &= met - 1) {
    const auto k = static_cast<std::uint32_t>(std::countr_zero(met));
    left |= (occupancy.mayMeet({x[k], y[k], z[k]}, radius[k]) ? 1u : 0u) << k;
  }
  return left;
}

/// Holds query spheres that can meet the grid.
struct QuerySpheres {
  static constexpr std::uint32_t kSize = kMostCells;
  static constexpr std::uint32_t kRoom = kSize + kLanes;  ///< whole groups are written
  alignas(64) float x[kRoom], y[kRoom], z[kRoom], reach[kRoom], smallest[kRoom];
  alignas(64) std::uint32_t self[kRoom];  ///< place
  std::uint32_t count = 0;

  bool hasRoom() const { return count + core::kClusterSize <= kSize; }
  core::Lookup lookup(std::uint32_t k) const { return {{x[k], y[k], z[k]}, reach[k], smallest[k]}; }

  void add(const core::Lookup& lookup, std::uint32_t place) {
    x[count] = lookup.p.x;
    y[count] = lookup.p.y;
    z[count] = lookup.p.z;
    reach[count] = lookup.reach;
    smallest[count] = lookup.smallest;
    self[count++] = place;
  }

  /// Does what core::makeLookup() does, for the spheres of a cluster.
  template <typename Lanes>
  void add(const core::Traversal& traversal, const core::Cluster& cluster) {
    constexpr std::uint32_t kAll = core::kClusterSize;
    static_assert(kAll % kLanes == 0);
    alignas(64) float px[kAll], py[kAll], pz[kAll], all[kAll], least[kAll];
    alignas(64) std::uint32_t place[kAll];
    alignas(64) std::uint32_t active[kAll] = {};
    const core::Search search = traversal.search;
    const core::GridView grid = traversal.grid;
    const Sphere* spheres = traversal.own.spheres + cluster.first;
    for (std::uint32_t k = 0; k < cluster.count; ++k) {
      const core::Probe probe = core::makeProbe(search, spheres[k]);
      px[k] = probe.p.x;
      py[k] = probe.p.y;
      pz[k] = probe.p.z;
      all[k] = probe.radius + search.grid_margin + search.tolerance;
      least[k] = core::smallestPartner(search, probe.radius);
    }
    for (std::uint32_t k = 0; k < cluster.count; ++k) {
      const std::uint32_t meets = core::meetsBounds(grid, {px[k], py[k], pz[k]}, all[k]) ? 1 : 0;
      active[k] = least[k] > grid.largest ? 0 : meets;
    }
    for (std::uint32_t k = 0; k < kAll; ++k) place[k] = cluster.first + k;
    for (std::uint32_t k = 0; k < cluster.count; k += kLanes) {
      const std::uint32_t bits = Lanes::bitsOf(active + k);
      const typename Lanes::Kept kept(bits);
      kept.copy(px + k, x + count);
      kept.copy(py + k, y + count);
      kept.copy(pz + k, z + count);
      kept.copy(all + k, reach + count);
      kept.copy(least + k, smallest + count);
      kept.copy(place + k, self + count);
      count += static_cast<std::uint32_t>(std::popcount(bits));
    }
  }
};

/// Holds the lists where they look. It does what core::cellsOf() does, where that is one cell.
struct QuerySphereLists {
  static constexpr std::uint32_t kSize = QuerySpheres::kSize;
  alignas(64) std::int32_t one[kSize];  ///< they look into one cell
  alignas(64) ListRange lists[kSize];

  template <typename Lanes>
  void find(const core::GridView& view, const QuerySpheres& query_spheres) {
    alignas(64) std::int32_t grid_level[kSize], x[kSize], y[kSize], z[kSize];
    alignas(64) std::uint64_t keys[kSize + kLanes];
    const core::GridView grid = view;
    const std::uint32_t count = query_spheres.count;
    for (std::uint32_t k = 0; k < count; ++k) {
      constexpr float kEnd = 1 << core::kAxisBits;
      const int t = core::gridLevelOf(grid, core::levelOf(query_spheres.smallest[k]));
      const float inverse = core::powerOfTwo(-(grid.finest + t));
      const float beyond = query_spheres.reach[k] - core::reachOf(grid, t), e = beyond > 0 ? beyond : 0;
      const auto cellAt = [inverse](float at, float half) { return std::floor((at + half) * inverse) + 1; };
      const float cx = cellAt(query_spheres.x[k] - e, grid.half.x);
      const float cy = cellAt(query_spheres.y[k] - e, grid.half.y);
      const float cz = cellAt(query_spheres.z[k] - e, grid.half.z);
      const float lowest = std::min(std::min(cx, cy), cz), highest = std::max(std::max(cx, cy), cz);
      std::int32_t single = cx == cellAt(query_spheres.x[k] + e, grid.half.x) ? 1 : 0;
      single = cy == cellAt(query_spheres.y[k] + e, grid.half.y) ? single : 0;
      single = cz == cellAt(query_spheres.z[k] + e, grid.half.z) ? single : 0;
      single = lowest >= 0 ? single : 0;
      one[k] = highest < kEnd ? single : 0;
      grid_level[k] = t;
      x[k] = static_cast<std::int32_t>(std::min(std::max(cx, 0.0f), kEnd));
      y[k] = static_cast<std::int32_t>(std::min(std::max(cy, 0.0f), kEnd));
      z[k] = static_cast<std::int32_t>(std::min(std::max(cz, 0.0f), kEnd));
    }
    for (std::uint32_t k = 0; k < count; ++k)
      keys[k] = core::cellKey(grid_level[k], static_cast<std::uint32_t>(x[k]),
                              static_cast<std::uint32_t>(y[k]), static_cast<std::uint32_t>(z[k]));
    for (std::uint32_t k = count; k % kLanes != 0; ++k) keys[k] = 0;
    Lanes::findCells(grid, keys, count, lists);
  }
};

/// Holds query spheres whose lists are tested, a group of up to kLanes spheres of each at a time: no branch
/// hangs on how long the list of a query sphere is.
struct Testing {
  static constexpr std::uint32_t kRoom = QuerySpheres::kRoom;
  alignas(64) std::uint32_t query_sphere[kRoom], first[kRoom],
      left[kRoom];  ///< number; what is left of its list
  std::uint32_t count = 0;

  template <typename Lanes>
  void begin(const QuerySpheres& query_spheres, const QuerySphereLists& where) {
    alignas(64) std::uint32_t number[kRoom], from[kRoom], length[kRoom] = {};
    for (std::uint32_t k = 0; k < query_spheres.count; ++k) {
      number[k] = k;
      from[k] = where.lists[k].first;
      length[k] = where.one[k] ? where.lists[k].count : 0;
    }
    keep<Lanes>(number, from, length, query_spheres.count);
  }

  /// Goes to the next group of each.
  template <typename Lanes>
  void next() {
    for (std::uint32_t k = 0; k < count; ++k) {
      const std::uint32_t tested = std::min<std::uint32_t>(left[k], kLanes);
      first[k] += tested;
      left[k] -= tested;
    }
    for (std::uint32_t k = count; k % kLanes != 0; ++k) left[k] = 0;
    keep<Lanes>(query_sphere, first, left, count);
  }

 private:
  /// Keeps those with something left; `lefts` is zero beyond the last one.
  template <typename Lanes>
  void keep(const std::uint32_t* numbers, const std::uint32_t* firsts, const std::uint32_t* lefts,
            std::uint32_t all) {
    count = 0;
    for (std::uint32_t k = 0; k < all; k += kLanes) {
      const std::uint32_t bits = Lanes::bitsOf(lefts + k);
      const typename Lanes::Kept kept(bits);
      kept.copy(numbers + k, query_sphere + count);
      kept.copy(firsts + k, first + count);
      kept.copy(lefts + k, left + count);
      count += static_cast<std::uint32_t>(std::popcount(bits));
    }
  }
};

/// Tests a group of each query sphere. Most groups meet none, so those that do are told apart before they are
/// written: without a branch, which would be foretold badly. `windows`: of each query sphere, null if it
/// looks into no other cell.
template <typename Lanes>
inline bool testGroups(const TraversedGrid& traversed, const QuerySpheres& query_spheres,
                       const CellWindow* windows, const Testing& testing, Candidates& candidates,
                       CandidateSink& sink) {
  alignas(64) std::uint32_t met[Testing::kRoom], numbers[Testing::kRoom], meeting[Testing::kRoom];
  for (std::uint32_t k = 0; k < testing.count; ++k)
    met[k] = (1u << std::min<std::uint32_t>(testing.left[k], kLanes)) - 1;  // a bit for each sphere
  for (std::uint32_t k = 0; k < testing.count; ++k)
    met[k] &= Lanes::meeting(query_spheres.lookup(testing.query_sphere[k]),
                             traversed.listed.from(testing.first[k]));
  for (std::uint32_t k = testing.count; k % kLanes != 0; ++k) met[k] = 0;
  for (std::uint32_t k = 0; k < testing.count; ++k) numbers[k] = k;
  std::uint32_t groups = 0;
  for (std::uint32_t k = 0; k < testing.count; k += kLanes) {
    const std::uint32_t bits = Lanes::bitsOf(met + k);
    typename Lanes::Kept(bits).copy(numbers + k, meeting + groups);
    groups += static_cast<std::uint32_t>(std::popcount(bits));
  }
  std::size_t count = candidates.count;
  for (std::uint32_t g = 0; g < groups; ++g) {
    if (count + kLanes > Candidates::kSize) {
      candidates.count = count;
      if (!sink.take(candidates)) return false;
      count = 0;
    }
    const std::uint32_t k = meeting[g];
    if (windows != nullptr)
      met[k] &= Lanes::within(windows[testing.query_sphere[k]], traversed.listed.from(testing.first[k]));
    count = Lanes::append(query_spheres.self[testing.query_sphere[k]],
                          traversed.grid.listed + testing.first[k], met[k], candidates, count);
  }
  candidates.count = count;
  return true;
}

/// Tests query spheres against the lists where they look.
template <typename Lanes>
inline bool testLists(const TraversedGrid& traversed, const QuerySpheres& query_spheres,
                      const QuerySphereLists& where, const CellWindow* windows, Candidates& candidates,
                      CandidateSink& sink) {
  Testing testing;
  for (testing.begin<Lanes>(query_spheres, where); testing.count > 0; testing.next<Lanes>()) {
    if (!testGroups<Lanes>(traversed, query_spheres, windows, testing, candidates, sink)) return false;
  }
  return true;
}

/// Tests a query sphere against all spheres of the grid.
template <typename Lanes>
inline bool testAll(const core::GridView& grid, const core::Lookup& lookup, std::uint32_t self,
                    Candidates& candidates, CandidateSink& sink) {
  alignas(64) float x[kLanes], y[kLanes], z[kLanes], radius[kLanes];
  const Columns columns{x, y, z, radius};
  for (std::uint32_t begin = 0; begin < grid.count; begin += kLanes) {
    std::uint32_t places[kLanes];
    for (std::uint32_t k = 0; k < kLanes; ++k) places[k] = std::min(begin + k, grid.count);
    Lanes::load(grid.centred, places, columns);
    const std::uint32_t met = Lanes::meeting(lookup, columns);
    if (met == 0) continue;
    if (candidates.count + kLanes > Candidates::kSize && !sink.take(candidates)) return false;
    candidates.count = Lanes::append(self, places, met, candidates, candidates.count);
  }
  return true;
}

/// Holds query spheres that look into several cells, once for each of these.
struct QuerySphereCells {
  static constexpr std::uint32_t kSize = QuerySpheres::kSize;
  QuerySpheres query_spheres;
  QuerySphereLists where;
  alignas(64) std::uint64_t keys[kSize];
  CellWindow windows[kSize];

  void add(const core::GridView& grid, const core::Cells& cells, const std::uint32_t (&cell)[3],
           const core::Lookup& lookup, std::uint32_t self) {
    const std::uint32_t k = query_spheres.count;
    keys[k] = core::cellKey(cells.grid_level, cell[0], cell[1], cell[2]);
    windows[k] = CellWindow(grid, cells, cell);
    where.one[k] = 1;
    query_spheres.add(lookup, self);
  }

  /// Tests them and holds none then.
  template <typename Lanes>
  bool test(const TraversedGrid& traversed, Candidates& candidates, CandidateSink& sink) {
    for (std::uint32_t k = query_spheres.count; k % kLanes != 0; ++k) keys[k] = 0;
    Lanes::findCells(traversed.grid, keys, query_spheres.count, where.lists);
    const bool go_on = testLists<Lanes>(traversed, query_spheres, where, windows, candidates, sink);
    query_spheres.count = 0;
    return go_on;
  }
};

/// Takes those of the query spheres that look into several cells through the grid.
template <typename Lanes>
inline bool traverseCells(const TraversedGrid& traversed, const QuerySpheres& query_spheres,
                          const QuerySphereLists& where, Candidates& candidates, CandidateSink& sink) {
  const core::GridView& grid = traversed.grid;
  QuerySphereCells several;
  for (std::uint32_t w = 0; w < query_spheres.count; ++w) {
    if (where.one[w]) continue;
    const core::Lookup lookup = query_spheres.lookup(w);
    const core::Cells cells = core::cellsOf(grid, lookup);
    if (cells.all && !testAll<Lanes>(grid, lookup, query_spheres.self[w], candidates, sink)) return false;
    if (cells.all || cells.count == 0) continue;
    const auto &lo = cells.box.lo, &hi = cells.box.hi;
    std::uint32_t at[3];
    for (at[2] = lo[2]; at[2] <= hi[2]; ++at[2]) {
      for (at[1] = lo[1]; at[1] <= hi[1]; ++at[1]) {
        for (at[0] = lo[0]; at[0] <= hi[0]; ++at[0]) {
          const bool full = several.query_spheres.count == QuerySphereCells::kSize;
          if (full && !several.test<Lanes>(traversed, candidates, sink)) return false;
          several.add(grid, cells, at, lookup, query_spheres.self[w]);
        }
      }
    }
  }
  return several.test<Lanes>(traversed, candidates, sink);
}

/// Takes all query spheres through the grid.
template <typename Lanes>
inline bool traverseTogether(const TraversedGrid& traversed, QuerySpheres& query_spheres,
                             Candidates& candidates, CandidateSink& sink) {
  QuerySphereLists where;
  where.find<Lanes>(traversed.grid, query_spheres);
  const bool go_on = testLists<Lanes>(traversed, query_spheres, where, nullptr, candidates, sink) &&
                     traverseCells<Lanes>(traversed, query_spheres, where, candidates, sink);
  query_spheres.count = 0;
  return go_on;
}

/// Takes some clusters through the grid.
template <typename Lanes>
inline bool traverseClusters(const core::Traversal& traversal, const SphereColumns& listed,
                             const std::uint32_t* clusters, std::size_t count, Candidates& candidates,
                             CandidateSink& sink) {
  const TraversedGrid traversed{traversal.grid, listed};
  QuerySpheres query_spheres;
  for (std::size_t c = 0; c < count; ++c) {
    if (!query_spheres.hasRoom() && !traverseTogether<Lanes>(traversed, query_spheres, candidates, sink))
      return false;
    query_spheres.add<Lanes>(traversal, traversal.own.clusters[clusters[c]]);
  }
  return traverseTogether<Lanes>(traversed, query_spheres, candidates, sink);
}

}  // namespace innersphere
