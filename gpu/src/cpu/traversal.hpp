// The walk on the CPU. Many walkers go together, so that each step is done for all of them side by side:
// where they are, where their cells are, and the tests.
#pragma once

#include <algorithm>
#include <cmath>

#include "cpu/simd.hpp"
#include "grid/cell_lists.hpp"
#include "grid/occupancy.hpp"

namespace innersphere {

static_assert(kLanes <= CellLists::kPastEnd, "lists are read in groups");

/// What a walk goes through: a grid, and the spheres that its cells list.
struct WalkedGrid {
  const core::GridView& grid;
  SphereColumns listed;
};

/// A bit for each of up to 32 balls of the walking body that can meet the grid.
inline std::uint32_t ballsMeeting(const core::Walker& walker, const Occupancy& occupancy, const Sphere* balls,
                                  std::uint32_t count) {
  constexpr std::uint32_t kMost = 32;
  const core::Search search = walker.search;
  const core::GridView grid = walker.grid;
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

/// Walkers that can meet the grid.
struct Walkers {
  static constexpr std::uint32_t kSize = kMostCells;
  static constexpr std::uint32_t kRoom = kSize + kLanes;  ///< whole groups are written
  alignas(64) float x[kRoom], y[kRoom], z[kRoom], reach[kRoom], smallest[kRoom];
  alignas(64) std::uint32_t self[kRoom];  ///< place
  std::uint32_t count = 0;

  bool hasRoom() const { return count + core::kClusterSize <= kSize; }
  core::Lookup lookup(std::uint32_t k) const { return {{x[k], y[k], z[k]}, reach[k], smallest[k]}; }

  /// What core::makeLookup does, for the spheres of a cluster.
  template <typename Lanes>
  void add(const core::Walker& walker, const core::Cluster& cluster) {
    constexpr std::uint32_t kAll = core::kClusterSize;
    static_assert(kAll % kLanes == 0);
    alignas(64) float px[kAll], py[kAll], pz[kAll], all[kAll], least[kAll];
    alignas(64) std::uint32_t place[kAll];
    alignas(64) std::uint32_t active[kAll] = {};
    const core::Search search = walker.search;
    const core::GridView grid = walker.grid;
    const Sphere* spheres = walker.own.spheres + cluster.first;
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

/// The lists where they look: what core::cellsOf does where that is one.
struct WalkerLists {
  static constexpr std::uint32_t kSize = Walkers::kSize;
  alignas(64) std::int32_t one[kSize];  ///< they look into one cell
  alignas(64) ListRange lists[kSize];

  template <typename Lanes>
  void find(const core::GridView& view, const Walkers& walkers) {
    alignas(64) std::int32_t tier[kSize], x[kSize], y[kSize], z[kSize];
    alignas(64) std::uint64_t keys[kSize + kLanes];
    const core::GridView grid = view;
    const std::uint32_t count = walkers.count;
    for (std::uint32_t k = 0; k < count; ++k) {
      constexpr float kEnd = 1 << core::kAxisBits;
      const int t = core::tierOf(grid, core::levelOf(walkers.smallest[k]));
      const float inverse = core::powerOfTwo(-(grid.finest + t));
      const float cx = std::floor((walkers.x[k] + grid.half.x) * inverse) + 1;
      const float cy = std::floor((walkers.y[k] + grid.half.y) * inverse) + 1;
      const float cz = std::floor((walkers.z[k] + grid.half.z) * inverse) + 1;
      const float lowest = std::min(std::min(cx, cy), cz), highest = std::max(std::max(cx, cy), cz);
      std::int32_t single = core::reachOf(grid, t) - walkers.reach[k] >= 0 ? 1 : 0;
      single = lowest >= 0 ? single : 0;
      one[k] = highest < kEnd ? single : 0;
      tier[k] = t;
      x[k] = static_cast<std::int32_t>(std::min(std::max(cx, 0.0f), kEnd));
      y[k] = static_cast<std::int32_t>(std::min(std::max(cy, 0.0f), kEnd));
      z[k] = static_cast<std::int32_t>(std::min(std::max(cz, 0.0f), kEnd));
    }
    for (std::uint32_t k = 0; k < count; ++k)
      keys[k] = core::cellKey(tier[k], static_cast<std::uint32_t>(x[k]), static_cast<std::uint32_t>(y[k]),
                              static_cast<std::uint32_t>(z[k]));
    for (std::uint32_t k = count; k % kLanes != 0; ++k) keys[k] = 0;
    Lanes::findCells(grid, keys, count, lists);
  }
};

/// Walkers whose lists are tested, a group of up to kLanes spheres of each at a time: no branch hangs on how
/// long the list of a walker is.
struct Testing {
  static constexpr std::uint32_t kRoom = Walkers::kRoom;
  alignas(64) std::uint32_t walker[kRoom], first[kRoom], left[kRoom];  ///< number; what is left of its list
  std::uint32_t count = 0;

  template <typename Lanes>
  void begin(const Walkers& walkers, const WalkerLists& where) {
    alignas(64) std::uint32_t number[kRoom], from[kRoom], length[kRoom] = {};
    for (std::uint32_t k = 0; k < walkers.count; ++k) {
      number[k] = k;
      from[k] = where.lists[k].first;
      length[k] = where.one[k] ? where.lists[k].count : 0;
    }
    keep<Lanes>(number, from, length, walkers.count);
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
    keep<Lanes>(walker, first, left, count);
  }

 private:
  /// Those with something left; `lefts` is zero beyond the last one.
  template <typename Lanes>
  void keep(const std::uint32_t* numbers, const std::uint32_t* firsts, const std::uint32_t* lefts,
            std::uint32_t all) {
    count = 0;
    for (std::uint32_t k = 0; k < all; k += kLanes) {
      const std::uint32_t bits = Lanes::bitsOf(lefts + k);
      const typename Lanes::Kept kept(bits);
      kept.copy(numbers + k, walker + count);
      kept.copy(firsts + k, first + count);
      kept.copy(lefts + k, left + count);
      count += static_cast<std::uint32_t>(std::popcount(bits));
    }
  }
};

/// Tests a group of each walker. Most groups meet none, so those that do are told apart before they are
/// written: without a branch, which would be foretold badly.
template <typename Lanes>
inline bool testGroups(const WalkedGrid& walked, const Walkers& walkers, const Testing& testing,
                       Candidates& candidates, CandidateSink& sink) {
  alignas(64) std::uint32_t met[Testing::kRoom], numbers[Testing::kRoom], meeting[Testing::kRoom];
  for (std::uint32_t k = 0; k < testing.count; ++k)
    met[k] = (1u << std::min<std::uint32_t>(testing.left[k], kLanes)) - 1;  // a bit for each sphere
  for (std::uint32_t k = 0; k < testing.count; ++k)
    met[k] &= Lanes::meeting(walkers.lookup(testing.walker[k]), walked.listed.from(testing.first[k]));
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
    count = Lanes::append(walkers.self[testing.walker[k]], walked.grid.listed + testing.first[k], met[k],
                          candidates, count);
  }
  candidates.count = count;
  return true;
}

/// Tests a walker against some spheres in columns and adds their places; `counts` has the last word on groups
/// of which it meets some.
template <typename Lanes, typename Counts>
inline bool testList(const core::Lookup& lookup, std::uint32_t self, const SphereColumns& spheres,
                     const std::uint32_t* places, std::uint32_t count, const Counts& counts,
                     Candidates& candidates, CandidateSink& sink) {
  for (std::uint32_t k = 0; k < count; k += kLanes) {
    const SphereColumns here = spheres.from(k);
    std::uint32_t met = Lanes::meeting(lookup, here);
    if (count - k < kLanes) met &= (1u << (count - k)) - 1;
    if (met == 0) continue;
    if (candidates.count + kLanes > Candidates::kSize && !sink.take(candidates)) return false;
    candidates.count = Lanes::append(self, places + k, met & counts(here), candidates, candidates.count);
  }
  return true;
}

/// Tests a walker against all spheres of the grid.
template <typename Lanes>
inline bool testAll(const core::GridView& grid, const core::Lookup& lookup, std::uint32_t self,
                    Candidates& candidates, CandidateSink& sink) {
  alignas(64) float x[kLanes], y[kLanes], z[kLanes], radius[kLanes];
  const Columns columns{x, y, z, radius};
  for (std::uint32_t begin = 0; begin < grid.count; begin += kLanes) {
    std::uint32_t places[kLanes];
    for (std::uint32_t k = 0; k < kLanes; ++k) places[k] = std::min(begin + k, grid.count);
    Lanes::load(grid.centred, places, columns);
    const auto always = [](const SphereColumns&) { return ~0u; };
    if (!testList<Lanes>(lookup, self, columns, places, kLanes, always, candidates, sink)) return false;
  }
  return true;
}

/// Some of the cells where a walker looks.
struct SomeCells {
  static constexpr std::uint32_t kSize = kMostCells;
  alignas(64) std::uint64_t keys[kSize] = {};  // all of them are looked up
  std::uint32_t at[kSize][3];
  std::uint32_t count = 0;

  void add(int tier, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    keys[count] = core::cellKey(tier, x, y, z);
    at[count][0] = x;
    at[count][1] = y;
    at[count++][2] = z;
  }
};

/// Tests a walker against the spheres in all cells where it looks.
template <typename Lanes>
inline bool walkCells(const WalkedGrid& walked, const core::Lookup& lookup, std::uint32_t self,
                      Candidates& candidates, CandidateSink& sink) {
  const core::GridView& grid = walked.grid;
  const core::Cells cells = core::cellsOf(grid, lookup);
  if (cells.all) return testAll<Lanes>(grid, lookup, self, candidates, sink);
  if (cells.count == 0) return true;
  SomeCells some;
  const auto test = [&] {
    alignas(64) ListRange lists[SomeCells::kSize];
    Lanes::findCells(grid, some.keys, some.count, lists);
    for (std::uint32_t c = 0; c < some.count; ++c) {
      if (lists[c].count == 0) continue;
      const CellWindow window(grid, cells, some.at[c]);
      const auto here = [&](const SphereColumns& spheres) { return Lanes::within(window, spheres); };
      if (!testList<Lanes>(lookup, self, walked.listed.from(lists[c].first), grid.listed + lists[c].first,
                           lists[c].count, here, candidates, sink))
        return false;
    }
    some.count = 0;
    return true;
  };
  const auto &lo = cells.box.lo, &hi = cells.box.hi;
  for (std::uint32_t z = lo[2]; z <= hi[2]; ++z) {
    for (std::uint32_t y = lo[1]; y <= hi[1]; ++y) {
      for (std::uint32_t x = lo[0]; x <= hi[0]; ++x) {
        if (some.count == SomeCells::kSize && !test()) return false;
        some.add(cells.tier, x, y, z);
      }
    }
  }
  return test();
}

/// Takes all walkers through the grid.
template <typename Lanes>
inline bool walkTogether(const WalkedGrid& walked, Walkers& walkers, Candidates& candidates,
                         CandidateSink& sink) {
  WalkerLists where;
  where.find<Lanes>(walked.grid, walkers);
  Testing testing;
  for (testing.begin<Lanes>(walkers, where); testing.count > 0; testing.next<Lanes>()) {
    if (!testGroups<Lanes>(walked, walkers, testing, candidates, sink)) return false;
  }
  for (std::uint32_t w = 0; w < walkers.count; ++w) {
    if (!where.one[w] && !walkCells<Lanes>(walked, walkers.lookup(w), walkers.self[w], candidates, sink))
      return false;
  }
  walkers.count = 0;
  return true;
}

/// Takes some clusters through the grid.
template <typename Lanes>
inline bool walkClusters(const core::Walker& walker, const SphereColumns& listed,
                         const std::uint32_t* clusters, std::size_t count, Candidates& candidates,
                         CandidateSink& sink) {
  const WalkedGrid walked{walker.grid, listed};
  Walkers walkers;
  for (std::size_t c = 0; c < count; ++c) {
    if (!walkers.hasRoom() && !walkTogether<Lanes>(walked, walkers, candidates, sink)) return false;
    walkers.add<Lanes>(walker, walker.own.clusters[clusters[c]]);
  }
  return walkTogether<Lanes>(walked, walkers, candidates, sink);
}

}  // namespace innersphere
