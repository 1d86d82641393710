// The walk of one body's spheres through the other's grid.
//
// Each sphere of A meets the spheres of B that are at least as large as it, and each sphere of B those of A
// that are strictly larger: every pair once. A partner that is at least as large lives on the walker's level
// or a coarser one, where the walker touches at most eight cells, so the work for one sphere does not depend
// on how many there are.
#pragma once

#include <cstdint>

#include "core/grid_view.hpp"
#include "core/pair.hpp"
#include "core/setup.hpp"

namespace innersphere::core {

/// Where a sphere or cluster of one body is in the other's grid.
struct Probe {
  Vec3f p;       ///< centre, relative to that of the grid
  float radius;  ///< with its margin
};

INNERSPHERE_HD inline Probe makeProbe(const Search& search, const Sphere& s) {
  const Vec3r p = search.matrix * Vec3r{s.x, s.y, s.z} + search.offset;
  return {{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)},
          search.ratio * s.radius + search.margin};
}

/// The spheres of one cell. `first`: along which axes the probe's box begins here, as bits.
template <typename Visit>
INNERSPHERE_HD inline bool visitCell(const GridView& grid, std::uint32_t cell, std::uint32_t first,
                                     const Probe& probe, float reach, Visit&& visit) {
  const std::uint32_t end = grid.cells[cell + 1];
  for (std::uint32_t k = grid.cells[cell]; k < end; ++k) {
    const std::uint32_t entry = grid.entries[k];
    // Two boxes that share several cells meet in the first of them: where, along each axis, one of them
    // begins.
    if ((entry >> kIndexBits | first) != 7u) continue;
    const std::uint32_t j = entry & ((1u << kIndexBits) - 1);
    const Sphere s = grid.spheres[j];
    const Vec3f d = Vec3f{s.x, s.y, s.z} - grid.centre - probe.p;
    const float sum = s.radius + reach;
    if (dot(d, d) > sum * sum) continue;
    if (!visit(j)) return false;
  }
  return true;
}

/// Calls visit(j) for the place j of every sphere of the grid that may be at least as large as the probe and
/// may overlap it: each of them once. Stops and returns false when visit does.
template <typename Visit>
INNERSPHERE_HD inline bool walk(const GridView& grid, const Search& search, const Probe& probe,
                                Visit&& visit) {
  CellBox box;
  if (!cellBox(grid, probe.p, probe.radius + search.tolerance, box)) return true;
  const float reach = probe.radius + search.grid_margin + search.tolerance;
  int level = levelOf(probe.radius * (1 - 1e-6f)) - grid.finest;
  if (level < 0) level = 0;
  for (; level <= grid.coarsest - grid.finest; ++level) {
    const std::uint32_t x0 = box.lo[0] >> level, y0 = box.lo[1] >> level, z0 = box.lo[2] >> level;
    const std::uint32_t x1 = box.hi[0] >> level, y1 = box.hi[1] >> level, z1 = box.hi[2] >> level;
    const Block* block = nullptr;
    std::uint64_t known = ~std::uint64_t{0};  // key of `block`; the cells of one block come in runs
    for (std::uint32_t z = z0; z <= z1; ++z) {
      for (std::uint32_t y = y0; y <= y1; ++y) {
        for (std::uint32_t x = x0; x <= x1; ++x) {
          const std::uint64_t key = blockKey(level, x >> kBlockBits, y >> kBlockBits, z >> kBlockBits);
          if (key != known) block = findBlock(grid, known = key);
          const int bit = bitOfCell(x, y, z);
          if (!block || !(block->occupied >> bit & 1)) continue;
          const std::uint32_t first = (x == x0 ? 1u : 0u) | (y == y0 ? 2u : 0u) | (z == z0 ? 4u : 0u);
          if (!visitCell(grid, cellIndex(*block, bit), first, probe, reach, visit)) return false;
        }
      }
    }
  }
  return true;
}

/// True if a cluster of a setup, of all of A's and then all of B's, is one of A's.
INNERSPHERE_HD inline bool isFromA(const Setup& setup, std::uint32_t cluster) {
  return cluster < setup.a.clusters;
}

/// Walks the spheres of one cluster. Takes every `step`-th sphere from `lane` on, so that the lanes of a warp
/// can share a cluster. Calls visit(ia, ib), with places in the grids, for every pair that is to be tested;
/// stops when visit returns false.
template <typename Visit>
INNERSPHERE_HD inline void walkCandidates(const Setup& setup, std::uint32_t cluster, std::uint32_t lane,
                                          std::uint32_t step, Visit&& visit) {
  const bool from_a = isFromA(setup, cluster);
  if (!from_a) cluster -= setup.a.clusters;
  const GridView& own = from_a ? setup.a.grid : setup.b.grid;
  const GridView& grid = from_a ? setup.b.grid : setup.a.grid;
  const Search& search = from_a ? setup.a_in_b : setup.b_in_a;

  const Probe around = makeProbe(search, own.clusters[cluster]);
  if (!meetsBox(grid, around.p, around.radius + search.tolerance)) return;

  const std::uint32_t begin = cluster * kClusterSize;
  const std::uint32_t end = begin + kClusterSize < own.count ? begin + kClusterSize : own.count;
  for (std::uint32_t k = begin + lane; k < end; k += step) {
    const Probe probe = makeProbe(search, own.spheres[k]);
    if (!walk(grid, search, probe, [&](std::uint32_t j) { return visit(from_a ? k : j, from_a ? j : k); }))
      return;
  }
}

/// Decides a candidate of a cluster: true if it overlaps and is this side's to report. Gives the pair.
INNERSPHERE_HD inline bool isHit(const Setup& setup, bool from_a, std::uint32_t ia, std::uint32_t ib,
                                 Pair& pair) {
  pair = makePair(setup, ia, ib);
  return walksToPartner(pair, from_a) && overlaps(pair);
}

}  // namespace innersphere::core
