// The walk of one body's spheres through the other's grid: what both backends share of it.
//
// Each sphere of A meets the spheres of B that are at least as large as it, and each sphere of B those of A
// that are strictly larger: every pair once. A partner that is at least as large lives on the walker's level
// or a coarser one, where few spheres are near the walker, so the work for one sphere does not depend on how
// many there are.
//
// A cluster of neighbours walks together. It looks up the blocks of each level that its box reaches, keeps
// the spheres that meet the box, and tests each of them against each of its own. What passes is a candidate;
// pair.hpp decides it in double precision.
#pragma once

#include <cstdint>

#include "core/grid_view.hpp"
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

/// True if a cluster of a setup, of all of A's and then all of B's, is one of A's.
INNERSPHERE_HD inline bool isFromA(const Setup& setup, std::uint32_t cluster) {
  return cluster < setup.a.clusters;
}

/// Who walks, and where.
struct Walker {
  const GridView& own;
  const GridView& grid;
  const Search& search;
};

INNERSPHERE_HD inline Walker walkerOf(const Setup& setup, bool from_a) {
  if (from_a) return {setup.a.grid, setup.b.grid, setup.a_in_b};
  return {setup.b.grid, setup.a.grid, setup.b_in_a};
}

/// False if no sphere of the cluster can meet one of the grid.
INNERSPHERE_HD inline bool clusterMeets(const Walker& walker, const Cluster& cluster) {
  const Probe around = makeProbe(walker.search, cluster.ball);
  return meetsBounds(walker.grid, around.p,
                     around.radius + walker.search.grid_margin + walker.search.tolerance);
}

/// The finest level of the grid on which spheres can be at least as large as the smallest of the cluster.
INNERSPHERE_HD inline int firstLevel(const Walker& walker, const Cluster& cluster) {
  const Search& search = walker.search;
  const float smallest = search.ratio * cluster.smallest + search.margin;
  const int level = levelOf(smallest * (1 - 1e-6f) - search.grid_margin) - walker.grid.finest;
  return level > 0 ? level : 0;
}

/// The blocks of a level that hold the centres of all spheres that may meet the box from lo to hi; false if
/// there are none.
INNERSPHERE_HD inline bool blockBox(const GridView& grid, const Level& level, const Search& search,
                                    const Vec3f& lo, const Vec3f& hi, CellBox& box) {
  const float r = level.largest + search.grid_margin + search.tolerance;
  if (!cellBox(grid, {lo.x - r, lo.y - r, lo.z - r}, {hi.x + r, hi.y + r, hi.z + r}, box)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] >>= level.block_shift;
    box.hi[axis] >>= level.block_shift;
  }
  return true;
}

}  // namespace innersphere::core
