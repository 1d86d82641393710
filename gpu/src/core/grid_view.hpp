// The hierarchical hash grid as a query reads it (Weller, Frese, Zachmann 2013, with their level rule
// corrected).
//
// Level e has cubic cells with edges of 2^e metres. A sphere of radius r lives on the level with
// 2r <= 2^e < 4r. All levels share one origin, so the cell of a coarse level is that of a finer one shifted
// right.
//
// The paper lists a sphere in each of the at most eight cells that it touches, for walkers that come one by
// one. Here neighbours walk together: a cluster of them looks up all cells near it at once, so a sphere is
// listed once, in the cell of its centre, and the lookup reaches farther by the largest radius of the level.
// Spheres are stored level by level along a Hilbert curve. On it each cube of 2^k cells along each axis is
// one run, so the hash table holds blocks of so many cells, chosen for each level such that few are nearly
// empty.
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

constexpr int kAxisBits = 19;  ///< a cell coordinate has at most so many bits, whatever the packing
constexpr int kLevelBits = 5;
constexpr std::uint32_t kClusterSize = 32;

/// A cube of cells: a run of spheres. An empty slot of the table has none.
struct alignas(16) Block {
  std::uint64_t key;
  std::uint32_t first;
  std::uint32_t count;
};

/// The spheres of one level: a run, too.
struct Level {
  std::uint32_t first;
  std::uint32_t count;
  std::uint32_t blocks;  ///< that hold something
  int block_shift;       ///< a block has 2^block_shift cells of the finest level along each axis
  float largest;         ///< radius
};

/// Up to kClusterSize neighbours on one level: a run of spheres with a ball around them.
struct alignas(16) Cluster {
  Sphere ball;
  float smallest;  ///< radius
  std::uint32_t first;
  std::uint32_t count;
};

INNERSPHERE_HD inline std::uint64_t blockKey(int level, std::uint32_t bx, std::uint32_t by,
                                             std::uint32_t bz) {
  return static_cast<std::uint64_t>(level) << (3 * kAxisBits) |
         static_cast<std::uint64_t>(bz) << (2 * kAxisBits) | static_cast<std::uint64_t>(by) << kAxisBits | bx;
}

/// Cells of the finest level, or blocks of some level, that a box touches, both ends included.
struct CellBox {
  std::uint32_t lo[3];
  std::uint32_t hi[3];
};

/// A grid in the memory of whoever queries it. Lengths are those of the packing; cells are laid out relative
/// to `centre`, so that positions keep their digits in single precision where the packing is far from its
/// origin.
struct GridView {
  const Sphere* spheres;     ///< `count` of them
  const std::uint32_t* ids;  ///< their indices in the packing
  const Cluster* clusters;
  const Block* blocks;  ///< the hash table, at most half full
  const Level* levels;  ///< `level_count` of them, from the finest to the coarsest
  std::uint32_t count;
  std::uint32_t cluster_count;
  int level_count;
  int hash_shift;      ///< 64 minus the bits of the table's size
  int finest;          ///< level, as exponent
  float inverse_cell;  ///< 2^-finest
  Vec3f centre;
  Vec3f half;          ///< half the size of the box around all spheres
  float last_cell[3];  ///< of the finest level
  float radius;        ///< of a ball about `centre` around all spheres
  float reach;         ///< of a ball about the packing's origin around all spheres
  float largest;       ///< radius of any sphere
};

INNERSPHERE_HD inline std::uint32_t hashBlock(const GridView& grid, std::uint64_t key) {
  return static_cast<std::uint32_t>(key * 0x9e3779b97f4a7c15u >> grid.hash_shift);
}

/// The block with this key; an empty slot if there is none. The table is never full, so probing ends.
INNERSPHERE_HD inline Block findBlock(const GridView& grid, std::uint64_t key) {
  const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << (64 - grid.hash_shift)) - 1);
  for (std::uint32_t at = hashBlock(grid, key);; at = (at + 1) & mask) {
    const Block block = grid.blocks[at];
    if (block.count == 0 || block.key == key) return block;
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

/// The cells of the finest level between two points (relative to the centre); false if all are outside the
/// grid.
INNERSPHERE_HD inline bool cellBox(const GridView& grid, const Vec3f& lo, const Vec3f& hi, CellBox& box) {
  const float k = grid.inverse_cell;
  return detail::cellRange(lo.x, hi.x, grid.half.x, k, grid.last_cell[0], box.lo[0], box.hi[0]) &&
         detail::cellRange(lo.y, hi.y, grid.half.y, k, grid.last_cell[1], box.lo[1], box.hi[1]) &&
         detail::cellRange(lo.z, hi.z, grid.half.z, k, grid.last_cell[2], box.lo[2], box.hi[2]);
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
