// The hierarchical hash grid as a query reads it (Weller, Frese, Zachmann 2013, with their level rule
// corrected).
//
// Level e has cubic cells with edges of 2^e metres. A sphere of radius r lives on the level with 2r <= 2^e <
// 4r, so it touches at most two cells along each axis: eight in all. All levels share one origin, so the cell
// of a coarse level is that of a finer one shifted right.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/vec3.hpp"
#include "innersphere/geometry.hpp"

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

/// One cell of the closed hash table: which entries it holds. Empty where count is 0.
struct CellSlot {
  std::uint64_t key;
  std::uint32_t first;
  std::uint32_t count;
};

constexpr int kAxisBits = 19;  ///< a cell coordinate has at most so many bits, whatever the packing
constexpr int kLevelBits = 5;
constexpr int kIndexBits =
    29;  ///< an entry: sphere index, and above it for each axis whether this is the sphere's first cell

INNERSPHERE_HD inline std::uint64_t cellKey(int level, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return static_cast<std::uint64_t>(level) << (3 * kAxisBits) |
         static_cast<std::uint64_t>(z) << (2 * kAxisBits) | static_cast<std::uint64_t>(y) << kAxisBits | x;
}

/// The cells of the finest level that a box touches, both ends included.
struct CellBox {
  std::uint32_t lo[3];
  std::uint32_t hi[3];
};

/// A grid in the memory of whoever queries it. Lengths are those of the packing; cells are laid out relative
/// to `centre`, so that positions keep their digits in single precision where the packing is far from its
/// origin.
struct GridView {
  const Sphere* spheres;       ///< `count` of them, in the packing's order
  const std::uint32_t* order;  ///< their indices along a space-filling curve, level by level
  const Sphere* clusters;      ///< balls around every kClusterSize spheres in that order
  const CellSlot* slots;       ///< the hash table
  const std::uint32_t* entries;
  std::uint32_t count;
  std::uint32_t cluster_count;
  int hash_shift;  ///< 64 minus the bits of the table
  int finest;      ///< levels, as exponents
  int coarsest;
  float inverse_cell;  ///< 2^-finest
  Vec3f centre;
  Vec3f half;          ///< half the size of the box around all grown spheres
  float last_cell[3];  ///< of the finest level
  float radius;        ///< of a ball about `centre` around all grown spheres
  float reach;         ///< of a ball about the packing's origin around all spheres
  float largest;       ///< radius of any sphere
};

constexpr std::uint32_t kClusterSize = 32;

INNERSPHERE_HD inline std::uint32_t hashCell(const GridView& grid, std::uint64_t key) {
  return static_cast<std::uint32_t>(key * 0x9e3779b97f4a7c15u >> grid.hash_shift);
}

/// Slot of a cell, or null if no sphere touches it. The table is never more than half full, so probing ends.
INNERSPHERE_HD inline const CellSlot* findCell(const GridView& grid, std::uint64_t key) {
  const std::uint32_t mask = static_cast<std::uint32_t>((std::uint64_t{1} << (64 - grid.hash_shift)) - 1);
  for (std::uint32_t at = hashCell(grid, key);; at = (at + 1) & mask) {
    const CellSlot& slot = grid.slots[at];
    if (slot.count == 0) return nullptr;
    if (slot.key == key) return &slot;
  }
}

namespace detail {

/// Cells of one axis between lo and hi, relative to the centre; false if they are all outside the grid.
/// Comparisons are such that a number that is not one gives the whole axis.
INNERSPHERE_HD inline bool cellRange(float lo, float hi, float half, float inverse_cell, float last,
                                     std::uint32_t& first, std::uint32_t& end) {
  lo = (lo + half) * inverse_cell;
  hi = (hi + half) * inverse_cell;
  if (hi < 0 || lo >= last + 1) return false;
  first = static_cast<std::uint32_t>(lo > 0 ? (lo < last ? lo : last) : 0.0f);
  end = static_cast<std::uint32_t>(hi < last ? hi : last);
  return true;
}

}  // namespace detail

/// The cells that a ball about p (relative to the centre) touches; false if it is outside the grid.
INNERSPHERE_HD inline bool cellBox(const GridView& grid, const Vec3f& p, float r, CellBox& box) {
  const float k = grid.inverse_cell;
  return detail::cellRange(p.x - r, p.x + r, grid.half.x, k, grid.last_cell[0], box.lo[0], box.hi[0]) &&
         detail::cellRange(p.y - r, p.y + r, grid.half.y, k, grid.last_cell[1], box.lo[1], box.hi[1]) &&
         detail::cellRange(p.z - r, p.z + r, grid.half.z, k, grid.last_cell[2], box.lo[2], box.hi[2]);
}

/// False if the ball about p (relative to the centre) cannot meet the box around the grid's spheres.
INNERSPHERE_HD inline bool meetsBox(const GridView& grid, const Vec3f& p, float r) {
  const Vec3f a{fabsf(p.x) - grid.half.x, fabsf(p.y) - grid.half.y, fabsf(p.z) - grid.half.z};
  const Vec3f out{a.x > 0 ? a.x : 0, a.y > 0 ? a.y : 0, a.z > 0 ? a.z : 0};
  return !(dot(out, out) > r * r);
}

}  // namespace innersphere::core
