// The walk on the CPU. Many walkers go together, so that each step is done for all of them side by side:
// where they are, where their cells are, and the tests. Cells that were loaded are kept, as neighbours share
// them.
#pragma once

#include <algorithm>
#include <cmath>

#include "cell_lists.hpp"
#include "cpu_lanes.hpp"
#include "occupancy.hpp"

namespace innersphere {

static_assert(kLanes <= CellLists::kPastEnd, "lists are read in groups");

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
  static constexpr std::uint32_t kSize = 128;
  alignas(64) float x[kSize], y[kSize], z[kSize], reach[kSize], smallest[kSize];
  std::uint32_t self[kSize];  ///< place
  std::uint32_t count = 0;

  bool hasRoom() const { return count + core::kClusterSize <= kSize; }
  core::Lookup lookup(std::uint32_t k) const { return {{x[k], y[k], z[k]}, reach[k], smallest[k]}; }

  /// What core::makeLookup does, for the spheres of a cluster.
  void add(const core::Walker& walker, const core::Cluster& cluster) {
    constexpr std::uint32_t kAll = core::kClusterSize;
    alignas(64) float px[kAll], py[kAll], pz[kAll], r[kAll];
    alignas(64) std::int32_t active[kAll];
    const core::Search search = walker.search;
    const core::GridView grid = walker.grid;
    const Sphere* spheres = walker.own.spheres + cluster.first;
    for (std::uint32_t k = 0; k < cluster.count; ++k) {
      const core::Probe probe = core::makeProbe(search, spheres[k]);
      px[k] = probe.p.x;
      py[k] = probe.p.y;
      pz[k] = probe.p.z;
      r[k] = probe.radius;
    }
    for (std::uint32_t k = 0; k < cluster.count; ++k) {
      const float all = r[k] + search.grid_margin + search.tolerance;
      const std::int32_t meets = core::meetsBounds(grid, {px[k], py[k], pz[k]}, all) ? 1 : 0;
      active[k] = core::smallestPartner(search, r[k]) > grid.largest ? 0 : meets;
    }
    std::uint32_t numbers[kAll], n = 0;
    for (std::uint32_t k = 0; k < cluster.count; ++k) {
      numbers[n] = k;
      n += static_cast<std::uint32_t>(active[k]);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t k = numbers[i], at = count + i;
      x[at] = px[k];
      y[at] = py[k];
      z[at] = pz[k];
      reach[at] = r[k] + search.grid_margin + search.tolerance;
      smallest[at] = core::smallestPartner(search, r[k]);
      self[at] = cluster.first + k;
    }
    count += n;
  }
};

/// The cells where they look: what core::cellsOf does where that is one.
struct WalkerCells {
  static constexpr std::uint32_t kSize = Walkers::kSize;
  alignas(64) std::int32_t tier[kSize], x[kSize], y[kSize], z[kSize];
  alignas(64) std::int32_t one[kSize];  ///< they look into one cell
  core::Cell cells[kSize];

  std::uint64_t key(std::uint32_t k) const {
    return core::cellKey(tier[k], static_cast<std::uint32_t>(x[k]), static_cast<std::uint32_t>(y[k]),
                         static_cast<std::uint32_t>(z[k]));
  }

  void find(const core::GridView& view, const Walkers& walkers) {
    const core::GridView grid = view;
    for (std::uint32_t k = 0; k < walkers.count; ++k) {
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
    for (std::uint32_t k = 0; k < walkers.count; ++k)
      __builtin_prefetch(grid.cells + core::hashCell(grid, key(k)));
    for (std::uint32_t k = 0; k < walkers.count; ++k) {
      cells[k] = core::findCell(grid, key(k));
      __builtin_prefetch(grid.listed + cells[k].first);
    }
  }
};

/// Spheres of the grid as columns, cell by cell: the last cells that were looked into, those that are small.
class LoadedCells {
 public:
  static constexpr std::uint32_t kLargest = 512;  ///< spheres of a cell

  LoadedCells() { clear(); }

  /// A cell's spheres, in groups of kLanes.
  template <typename Lanes>
  Columns load(const core::GridView& grid, const core::Cell& cell) {
    Kept& kept = kept_[cell.first / core::kListStep % kKept];
    if (kept.first != cell.first) {
      if (used_ + cell.count + kLanes > kRoom) clear();
      kept = {cell.first, used_};
      for (std::uint32_t k = 0; k < cell.count; k += kLanes, used_ += kLanes)
        Lanes::load(grid.centred, grid.listed + cell.first + k, cell.count - k, columns(used_));
    }
    return columns(kept.at);
  }

 private:
  static constexpr std::uint32_t kRoom = 2048;  ///< spheres
  static constexpr std::uint32_t kKept = 128;   ///< cells
  struct Kept {
    std::uint32_t first;  ///< of the cell's list
    std::uint32_t at;     ///< of its spheres
  };

  Columns columns(std::uint32_t k) { return {x_ + k, y_ + k, z_ + k, radius_ + k}; }

  void clear() {
    used_ = 0;
    for (Kept& kept : kept_) kept = {0xffffffffu, 0};
  }

  std::uint32_t used_;
  Kept kept_[kKept];
  alignas(64) float x_[kRoom], y_[kRoom], z_[kRoom], radius_[kRoom];
};

/// Tests a walker against listed[0 .. count); `counts` has the last word on those that it meets.
template <typename Lanes, typename Counts>
inline bool testList(const core::GridView& grid, const core::Lookup& lookup, std::uint32_t self,
                     const std::uint32_t* listed, std::uint32_t count, const Counts& counts,
                     Candidates& candidates, CandidateSink& sink) {
  alignas(64) float x[kLanes], y[kLanes], z[kLanes], radius[kLanes];
  const Columns columns{x, y, z, radius};
  for (std::uint32_t k = 0; k < count; k += kLanes) {
    if (candidates.count + kLanes > Candidates::kSize && !sink.take(candidates)) return false;
    Lanes::load(grid.centred, listed + k, count - k, columns);
    for (std::uint32_t met = Lanes::meeting(lookup, columns); met != 0; met &= met - 1) {
      const std::uint32_t place = listed[k + static_cast<std::uint32_t>(std::countr_zero(met))];
      candidates.walker[candidates.count] = self;
      candidates.partner[candidates.count] = place;
      candidates.count += counts(grid.centred[place]) ? 1 : 0;
    }
  }
  return true;
}

inline bool always(const Sphere&) {
  return true;
}

/// Tests a walker against the spheres in all cells where it looks.
template <typename Lanes>
inline bool walkCells(const core::GridView& grid, const core::Lookup& lookup, std::uint32_t self,
                      Candidates& candidates, CandidateSink& sink) {
  const core::Cells cells = core::cellsOf(grid, lookup);
  if (cells.all) {
    for (std::uint32_t begin = 0; begin < grid.count; begin += kLanes) {
      std::uint32_t places[kLanes];
      for (std::uint32_t k = 0; k < kLanes; ++k) places[k] = std::min(begin + k, grid.count);
      if (!testList<Lanes>(grid, lookup, self, places, kLanes, always, candidates, sink)) return false;
    }
    return true;
  }
  for (std::uint32_t number = 0; number < cells.count; ++number) {
    std::uint32_t at[3];
    cells.coordinates(number, at);
    const core::Cell cell = core::findCell(grid, core::cellKey(cells.tier, at[0], at[1], at[2]));
    const auto here = [&](const Sphere& s) { return core::countsIn(grid, cells, at, s); };
    if (!testList<Lanes>(grid, lookup, self, grid.listed + cell.first, cell.count, here, candidates, sink))
      return false;
  }
  return true;
}

/// Takes all walkers through the grid.
template <typename Lanes>
inline bool walkTogether(const core::GridView& grid, Walkers& walkers, LoadedCells& loaded,
                         Candidates& candidates, CandidateSink& sink) {
  WalkerCells where;
  where.find(grid, walkers);
  for (std::uint32_t w = 0; w < walkers.count; ++w) {
    const core::Cell cell = where.cells[w];
    const core::Lookup lookup = walkers.lookup(w);
    const std::uint32_t self = walkers.self[w];
    const std::uint32_t* const listed = grid.listed + cell.first;
    if (!where.one[w]) {
      if (!walkCells<Lanes>(grid, lookup, self, candidates, sink)) return false;
    } else if (cell.count > LoadedCells::kLargest) {
      if (!testList<Lanes>(grid, lookup, self, listed, cell.count, always, candidates, sink)) return false;
    } else if (cell.count > 0) {
      const Columns spheres = loaded.load<Lanes>(grid, cell);
      std::size_t count = candidates.count;
      for (std::uint32_t k = 0; k < cell.count; k += kLanes) {
        if (count + kLanes > Candidates::kSize) {
          candidates.count = count;
          if (!sink.take(candidates)) return false;
          count = 0;
        }
        const std::uint32_t met =
            Lanes::meeting(lookup, {spheres.x + k, spheres.y + k, spheres.z + k, spheres.radius + k});
        count = Lanes::append(self, listed + k, met, candidates, count);
      }
      candidates.count = count;
    }
  }
  walkers.count = 0;
  return true;
}

/// Takes some clusters through the grid.
template <typename Lanes>
inline bool walkClusters(const core::Walker& walker, const std::uint32_t* clusters, std::size_t count,
                         Candidates& candidates, CandidateSink& sink) {
  Walkers walkers;
  LoadedCells loaded;
  for (std::size_t c = 0; c < count; ++c) {
    if (!walkers.hasRoom() && !walkTogether<Lanes>(walker.grid, walkers, loaded, candidates, sink))
      return false;
    walkers.add(walker, walker.own.clusters[clusters[c]]);
  }
  return walkTogether<Lanes>(walker.grid, walkers, loaded, candidates, sink);
}

}  // namespace innersphere
