// The hierarchical hash grid as a query reads it (Weller, Frese, Zachmann 2013, with their level rule
// corrected).
//
// A sphere of radius r has the level e with 2r <= 2^e < 4r. The paper has a grid for each level and lists a
// sphere in the at most eight cells that it touches, so a walker looks into up to eight cells of its own
// level and of every coarser one, and nearly all of them are empty.
//
// Here a walker looks into one cell. Its tier has cells of 2^t metres, four times the radius of the largest
// walkers that come there, and a cell lists all spheres, of that level and of all coarser ones, that a walker
// with its centre in the cell can meet. What the paper proves of cells holds for these, too: spheres that do
// not overlap and are not smaller than a part of the cell can only be so many. Levels so fine that there
// would be many more cells than spheres share the finest tier.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "innersphere/geometry.hpp"
#include "innersphere/vec3.hpp"

namespace innersphere::core {

/// Exponent e of the level of a radius: the smallest with 2 radius <= 2^e. Rises with the radius.
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

/// Lists begin at multiples of it, and are filled up with places of no sphere.
constexpr std::uint32_t kListStep = 4;

/// A cell: a run of GridView::listed. An empty slot of the table has none.
struct alignas(16) Cell {
  std::uint64_t key;
  std::uint32_t first;
  std::uint32_t count;
};

/// Up to kClusterSize neighbours on one level: a run of spheres with a ball around them.
struct alignas(16) Cluster {
  Sphere ball;
  std::uint32_t first;
  std::uint32_t count;
};

INNERSPHERE_HD inline std::uint64_t cellKey(int tier, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return static_cast<std::uint64_t>(tier) << (3 * kAxisBits) |
         static_cast<std::uint64_t>(z) << (2 * kAxisBits) | static_cast<std::uint64_t>(y) << kAxisBits | x;
}

/// 2^exponent, for exponents from -126 to 127.
INNERSPHERE_HD inline float powerOfTwo(int exponent) {
  const std::uint32_t bits = static_cast<std::uint32_t>(exponent + 127) << 23;
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

/// Cells of a tier, both ends included.
struct CellBox {
  std::uint32_t lo[3];
  std::uint32_t hi[3];
};

/// A grid in the memory of whoever queries it. Lengths are those of the packing; cells are laid out relative
/// to `centre`, so that positions keep their digits in single precision where the packing is far from its
/// origin.
struct GridView {
  const Sphere* spheres;     ///< `count` of them, by level and, within one, along a Hilbert curve
  const Sphere* centred;     ///< the same, relative to `centre`, and one that meets nothing; CPU only
  const std::uint32_t* ids;  ///< their indices in the packing
  const Cluster* clusters;
  const Cell* cells;            ///< the hash table, at most half full
  const std::uint32_t* listed;  ///< places of spheres: the lists of all cells
  std::uint32_t count;
  std::uint32_t cluster_count;
  std::uint32_t listed_count;
  int hash_shift;  ///< 64 minus the bits of the table's size
  int finest;      ///< exponent of the finest tier's cells
  int tiers;
  Vec3f centre;
  Vec3f half;     ///< half the size of the box around all spheres
  float radius;   ///< of a ball about `centre` around all spheres
  float reach;    ///< of a ball about the packing's origin around all spheres
  float largest;  ///< radius of any sphere
};

/// The tier where a sphere of this level looks for partners that are at least as large; beyond the last one
/// there are none.
INNERSPHERE_HD inline int tierOf(const GridView& grid, int level) {
  const int tier = level + 1 - grid.finest;
  return tier > 0 ? tier : 0;
}

/// How far walkers of a tier may reach if they are to look into one cell only.
INNERSPHERE_HD inline float reachOf(const GridView& grid, int tier) {
  return powerOfTwo(grid.finest + tier - 2);
}

constexpr std::uint64_t kHashFactor = 0x9e3779b97f4a7c15u;

INNERSPHERE_HD inline std::uint32_t hashCell(const GridView& grid, std::uint64_t key) {
  return static_cast<std::uint32_t>(key * kHashFactor >> grid.hash_shift);
}

/// The cell with this key; an empty slot if there is none. The table is never full, so probing ends.
INNERSPHERE_HD inline Cell findCell(const GridView& grid, std::uint64_t key) {
  const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << (64 - grid.hash_shift)) - 1);
  for (std::uint32_t at = hashCell(grid, key);; at = (at + 1) & mask) {
    const Cell cell = grid.cells[at];
    if (cell.count == 0 || cell.key == key) return cell;
  }
}

namespace detail {

/// Cells of one axis between lo and hi, relative to the centre; false if they are all outside the grid, which
/// goes one cell beyond the box around the spheres. Comparisons are such that a number that is not one gives
/// the whole axis.
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

/// The cells of a tier between two points (relative to the centre); false if all are outside the grid.
INNERSPHERE_HD inline bool cellBox(const GridView& grid, int tier, const Vec3f& lo, const Vec3f& hi,
                                   CellBox& box) {
  const float k = powerOfTwo(-(grid.finest + tier));
  return detail::cellRange(lo.x, hi.x, grid.half.x, k, box.lo[0], box.hi[0]) &&
         detail::cellRange(lo.y, hi.y, grid.half.y, k, box.lo[1], box.hi[1]) &&
         detail::cellRange(lo.z, hi.z, grid.half.z, k, box.lo[2], box.hi[2]);
}

/// False if the ball about p (relative to the centre) cannot meet the box or the ball around the grid's
/// spheres.
INNERSPHERE_HD inline bool meetsBounds(const GridView& grid, const Vec3f& p, float r) {
  const Vec3f a{fabsf(p.x) - grid.half.x, fabsf(p.y) - grid.half.y, fabsf(p.z) - grid.half.z};
  const Vec3f out{a.x > 0 ? a.x : 0, a.y > 0 ? a.y : 0, a.z > 0 ? a.z : 0};
  const float reach = grid.radius + r;
  return !(dot(out, out) > r * r) && !(dot(p, p) > reach * reach);
}

}  // namespace innersphere::core
