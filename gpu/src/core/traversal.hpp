// Holds what both backends share of the traversal of one body's spheres through the other's grid.
//
// Each sphere of A meets the spheres of B that are at least as large as it, and each sphere of B those of A
// that are strictly larger: every pair once. All of them are listed in one cell of the query sphere's grid
// level, so the work for one sphere does not depend on how many there are. What overlaps in lower precision
// is a candidate; pair.hpp decides it in double precision.
//
// Margins make query spheres larger than their grid level foresees. Then they look into all cells near them,
// and a sphere that is listed in several of these counts in one.
#pragma once

#include <cstdint>

#include "core/grid_view.hpp"
#include "core/setup.hpp"

namespace innersphere::core {

/// Says where a sphere or cluster of one body is in the other's grid.
struct Probe {
  Vec3f p;       ///< centre, relative to that of the grid
  float radius;  ///< with its margin
};

INNERSPHERE_HD inline Probe makeProbe(const Search& search, const Sphere& s) {
  const Vec3d p = search.matrix * Vec3d{s.x, s.y, s.z} + search.offset;
  return {{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)},
          search.ratio * s.radius + search.margin};
}

/// Returns true if a cluster of a setup, of all of A's and then all of B's, is one of A's.
INNERSPHERE_HD inline bool isFromA(const Setup& setup, std::uint32_t cluster) {
  return cluster < setup.clusters[0];
}

/// Describes one direction of a query: the spheres of a body in the grid of the other.
struct Traversal {
  const GridView& own;
  const GridView& grid;
  const Search& search;
};

INNERSPHERE_HD inline Traversal traversalOf(const Setup& setup, bool from_a) {
  if (from_a) return {setup.a, setup.b, setup.searches[0]};
  return {setup.b, setup.a, setup.searches[1]};
}

/// Returns a ball around spheres of the searching body, larger by all margins and tolerances. It may be much
/// larger than the grid, and its place is rounded by a part of the way to it.
INNERSPHERE_HD inline Probe makeBallProbe(const Search& search, const Sphere& ball) {
  constexpr float kRounded = 1 + 1.0f / (1 << 20);
  const Probe around = makeProbe(search, ball);
  return {around.p, kRounded * around.radius + search.grid_margin + search.tolerance};
}

/// Returns false if nothing in such a ball can meet the grid.
INNERSPHERE_HD inline bool ballMeets(const Search& search, const GridView& grid, const Sphere& ball) {
  const Probe around = makeBallProbe(search, ball);
  return meetsBounds(grid, around.p, around.radius);
}

/// Returns false if no sphere of the cluster can meet one of the grid.
INNERSPHERE_HD inline bool clusterMeets(const Traversal& traversal, const Cluster& cluster) {
  return ballMeets(traversal.search, traversal.grid, cluster.ball);
}

/// Describes a query sphere in the other body's grid.
struct Lookup {
  Vec3f p;         ///< The centre, relative to that of the grid.
  float reach;     ///< The radius with all margins and tolerances.
  float smallest;  ///< The smallest partner that this query sphere has to find.
};

/// Returns a radius a little below that of the smallest partner which a query sphere of this radius need look
/// for: pair.hpp has the last word on equals.
INNERSPHERE_HD inline float smallestPartner(const Search& search, float radius) {
  return radius * (1 - 1e-6f) - search.grid_margin;
}

/// Brings a sphere into the other's grid. Returns false if it cannot meet any sphere there.
INNERSPHERE_HD inline bool makeLookup(const Traversal& traversal, const Sphere& sphere, Lookup& lookup) {
  const Search& search = traversal.search;
  const Probe probe = makeProbe(search, sphere);
  lookup.p = probe.p;
  lookup.reach = probe.radius + search.grid_margin + search.tolerance;
  lookup.smallest = smallestPartner(search, probe.radius);
  return meetsBounds(traversal.grid, lookup.p, lookup.reach) && !(lookup.smallest > traversal.grid.largest);
}

/// Says where a query sphere looks.
struct Cells {
  int grid_level;
  CellBox box;
  std::uint32_t count;  ///< of cells
  bool all;  ///< they would be too many: it looks at all spheres of the grid instead, as if in one cell

  /// Gives the coordinates of one of the cells.
  INNERSPHERE_HD void coordinates(std::uint32_t number, std::uint32_t (&cell)[3]) const {
    const std::uint32_t nx = box.hi[0] - box.lo[0] + 1, ny = box.hi[1] - box.lo[1] + 1;
    cell[0] = box.lo[0] + number % nx;
    cell[1] = box.lo[1] + number / nx % ny;
    cell[2] = box.lo[2] + number / nx / ny;
  }
};

INNERSPHERE_HD inline Cells cellsOf(const GridView& grid, const Lookup& lookup) {
  Cells cells;
  cells.grid_level = gridLevelOf(grid, levelOf(lookup.smallest));
  const float beyond = lookup.reach - reachOf(grid, cells.grid_level);
  const float e = beyond > 0 ? beyond : 0;
  const Vec3f& p = lookup.p;
  cells.all = false;
  cells.count = 0;
  if (!cellBox(grid, cells.grid_level, {p.x - e, p.y - e, p.z - e}, {p.x + e, p.y + e, p.z + e}, cells.box))
    return cells;
  std::uint64_t count = 1;
  for (int axis = 0; axis < 3; ++axis) count *= cells.box.hi[axis] - cells.box.lo[axis] + 1;
  cells.all = count > grid.count;
  cells.count = cells.all ? 1 : static_cast<std::uint32_t>(count);
  return cells;
}

/// Returns true if a partner counts in this cell. A pair found in several cells is reported once: in the
/// visited cell nearest to the partner's centre, which is relative to that of the grid.
INNERSPHERE_HD inline bool countsIn(const GridView& grid, const Cells& cells, const std::uint32_t (&cell)[3],
                                    const Sphere& partner) {
  const Vec3f p{partner.x, partner.y, partner.z};
  CellBox own;
  if (!cellBox(grid, cells.grid_level, p, p, own)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t lo = cells.box.lo[axis], hi = cells.box.hi[axis], x = own.lo[axis];
    if (cell[axis] != (x < lo ? lo : x > hi ? hi : x)) return false;
  }
  return true;
}

}  // namespace innersphere::core
