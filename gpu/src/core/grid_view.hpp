// Shows the hierarchical hash grid as a query reads it (Weller, Frese, Zachmann 2013, with their level rule
// corrected).
//
// A sphere of radius r has the size level e with 2r <= 2^e < 4r. The paper has a grid for each size level and
// lists a sphere in the at most eight cells that it touches. So a query sphere looks into up to eight cells
// of its own level and of every coarser one, and nearly all of them are empty.
//
// Here a query sphere looks into one cell. The cells of its grid level are 2^t metres wide, four times the
// radius of the largest query spheres that look there. A cell lists all spheres, of that size level and of
// all coarser ones, that a query sphere with its centre in the cell can meet. What the paper proves of cells
// holds for these, too: only so many spheres that do not overlap and are not smaller than a part of the cell
// can be there. Size levels so fine that there would be many more cells than spheres share the finest grid
// level.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "innersphere/geometry.hpp"
#include "innersphere/vec3.hpp"

namespace innersphere::core {

/// Returns the size level of a radius: the smallest exponent e with 2 radius <= 2^e. It rises with the
/// radius.
INNERSPHERE_HD inline int levelOf(float radius) {
  constexpr float kTiny = 1e-37f;  // keeps 2^-e finite
  if (!(radius > kTiny)) radius = kTiny;
  std::uint32_t bits;
  memcpy(&bits, &radius, sizeof bits);
  const int floor_log2 = static_cast<int>(bits >> 23) - 127;
  const bool power_of_two = (bits & 0x7fffffu) == 0;
  return power_of_two ? floor_log2 + 1 : floor_log2 + 2;
}

constexpr int kAxisBits = 19;  ///< a cell coordinate has at most so many bits, whatever the packing
constexpr std::uint32_t kClusterSize = 32;

/// Lists begin at multiples of this number, and are filled up with places of no sphere.
constexpr std::uint32_t kListStep = 4;

/// This is a cell, which lists a run of GridView::listed. An empty slot of the table has count 0.
struct alignas(16) Cell {
  std::uint64_t key;
  std::uint32_t first;
  std::uint32_t count;
};

/// Holds up to kClusterSize neighbours of one size level: a run of spheres with a ball around them.
struct alignas(16) Cluster {
  Sphere ball;
  std::uint32_t first;
  std::uint32_t count;
};

INNERSPHERE_HD inline std::uint64_t cellKey(int grid_level, std::uint32_t x, std::uint32_t y,
                                            std::uint32_t z) {
  return static_cast<std::uint64_t>(grid_level) << (3 * kAxisBits) |
         static_cast<std::uint64_t>(z) << (2 * kAxisBits) | static_cast<std::uint64_t>(y) << kAxisBits | x;
}

/// Returns 2^exponent, for exponents from -126 to 127.
INNERSPHERE_HD inline float powerOfTwo(int exponent) {
  const std::uint32_t bits = static_cast<std::uint32_t>(exponent + 127) << 23;
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

/// Holds the cells of a grid level in a box, both ends included.
struct CellBox {
  std::uint32_t lo[3];
  std::uint32_t hi[3];
};

/// This is a grid in the memory of whoever queries it. Lengths are those of the packing; cells are laid out
/// relative to `centre`, so that positions keep their digits in single precision where the packing is far
/// from its origin.
struct GridView {
  const Sphere* spheres;     ///< The `count` spheres by size level and, within one, along a Hilbert curve.
  const Sphere* centred;     ///< The spheres relative to `centre`, and one that meets nothing. CPU only.
  const std::uint32_t* ids;  ///< The indices of the spheres in the packing.
  const Cluster* clusters;
  const Cell* cells;            ///< The hash table, at most half full.
  const std::uint32_t* listed;  ///< The lists of all cells: places of spheres.
  std::uint32_t count;
  std::uint32_t cluster_count;
  std::uint32_t listed_count;
  int hash_shift;  ///< 64 minus the bits of the table's size.
  int finest;      ///< The exponent of the width of the finest grid level's cells.
  int grid_levels;
  Vec3f centre;
  Vec3f half;     ///< Half the size of the box around all spheres.
  float radius;   ///< The radius of a ball about `centre` around all spheres.
  float reach;    ///< The radius of a ball about the packing's origin around all spheres.
  float largest;  ///< The largest radius of any sphere.
  double volume;  ///< The volume of the solid that the spheres stand for; 0: not known.
};

/// Returns the grid level where a sphere of this size level looks for partners that are at least as large.
/// Beyond the last grid level there are none.
INNERSPHERE_HD inline int gridLevelOf(const GridView& grid, int level) {
  const int grid_level = level + 1 - grid.finest;
  return grid_level > 0 ? grid_level : 0;
}

/// Returns how far query spheres of a grid level may reach if they are to look into one cell only.
INNERSPHERE_HD inline float reachOf(const GridView& grid, int grid_level) {
  return powerOfTwo(grid.finest + grid_level - 2);
}

constexpr std::uint64_t kHashFactor = 0x9e3779b97f4a7c15u;

INNERSPHERE_HD inline std::uint32_t hashCell(const GridView& grid, std::uint64_t key) {
  return static_cast<std::uint32_t>(key * kHashFactor >> grid.hash_shift);
}

/// Returns the cell with this key, or an empty slot if there is none. The table is never full, so probing
/// ends.
INNERSPHERE_HD inline Cell findCell(const GridView& grid, std::uint64_t key) {
  const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << (64 - grid.hash_shift)) - 1);
  for (std::uint32_t at = hashCell(grid, key);; at = (at + 1) & mask) {
    const Cell cell = grid.cells[at];
    if (cell.count == 0 || cell.key == key) return cell;
  }
}

namespace detail {

/// Finds the cells of one axis between lo and hi, relative to the centre. Returns false if they are all
/// outside the grid, which goes one cell beyond the box around the spheres. Comparisons are such that a
/// number that is not one gives the whole axis.
INNERSPHERE_HD inline bool cellRange(float lo, float hi, float half, float inverse_cell, std::uint32_t& first,
                                     std::uint32_t& end) {
  const float last = floorf(2 * half * inverse_cell) + 2;
  lo = floorf((lo + half) * inverse_cell) + 1;
  hi = floorf((hi + half) * inverse_cell) + 1;
  if (hi < 0 || lo > last) return false;
  first = static_cast<std::uint32_t>(lo > 0 ? (lo < last ? lo : last) : 0.0f);
  end = static_cast<std::uint32_t>(hi < last ? hi : last);
  return true;
}

}  // namespace detail

/// Finds the cells of a grid level between two points, relative to the centre. Returns false if all are
/// outside the grid.
INNERSPHERE_HD inline bool cellBox(const GridView& grid, int grid_level, const Vec3f& lo, const Vec3f& hi,
                                   CellBox& box) {
  const float k = powerOfTwo(-(grid.finest + grid_level));
  return detail::cellRange(lo.x, hi.x, grid.half.x, k, box.lo[0], box.hi[0]) &&
         detail::cellRange(lo.y, hi.y, grid.half.y, k, box.lo[1], box.hi[1]) &&
         detail::cellRange(lo.z, hi.z, grid.half.z, k, box.lo[2], box.hi[2]);
}

/// Returns false if the ball about p (relative to the centre) cannot meet the box or the ball around the
/// grid's spheres.
INNERSPHERE_HD inline bool meetsBounds(const GridView& grid, const Vec3f& p, float r) {
  const Vec3f a{fabsf(p.x) - grid.half.x, fabsf(p.y) - grid.half.y, fabsf(p.z) - grid.half.z};
  const Vec3f out{a.x > 0 ? a.x : 0, a.y > 0 ? a.y : 0, a.z > 0 ? a.z : 0};
  const float reach = grid.radius + r;
  return !(dot(out, out) > r * r) && !(dot(p, p) > reach * reach);
}

}  // namespace innersphere::core
