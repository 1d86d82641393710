// The hierarchical hash grid as a query reads it (Weller, Frese, Zachmann 2013, with their level rule
// corrected).
//
// Level e has cubic cells with edges of 2^e metres. A sphere of radius r lives on the level with
// 2r <= 2^e < 4r, so it touches at most two cells along each axis: eight in all. All levels share one origin,
// so the cell of a coarse level is that of a finer one shifted right.
//
// Most cells are empty, and neighbours are looked up together. So the hash table holds blocks of 4 x 4 x 4
// cells with a bit for each occupied one: mostly one lookup serves a sphere on one level, and an empty cell
// costs no access to memory of its own.
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
constexpr int kBlockBits = 2;   ///< a block has 2^kBlockBits cells along each axis
constexpr int kIndexBits = 29;  ///< of an entry that are the place of a sphere, see GridView::entries
constexpr std::uint32_t kClusterSize = 32;

/// The cells of a block that hold something, as bits, and where the first of them is in GridView::cells. An
/// empty slot of the table has no bits.
struct Block {
  std::uint64_t key;
  std::uint64_t occupied;
  std::uint32_t first;
};

INNERSPHERE_HD inline std::uint64_t blockKey(int level, std::uint32_t bx, std::uint32_t by,
                                             std::uint32_t bz) {
  constexpr int kBits = kAxisBits - kBlockBits;
  return static_cast<std::uint64_t>(level) << (3 * kBits) | static_cast<std::uint64_t>(bz) << (2 * kBits) |
         static_cast<std::uint64_t>(by) << kBits | bx;
}

/// Number of a cell in its block.
INNERSPHERE_HD inline int bitOfCell(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  constexpr std::uint32_t kMask = (1u << kBlockBits) - 1;
  return static_cast<int>((z & kMask) << (2 * kBlockBits) | (y & kMask) << kBlockBits | (x & kMask));
}

INNERSPHERE_HD inline int countBits(std::uint64_t bits) {
#if defined(__CUDA_ARCH__)
  return __popcll(bits);
#else
  return __builtin_popcountll(bits);
#endif
}

/// The cells of the finest level that a box touches, both ends included.
struct CellBox {
  std::uint32_t lo[3];
  std::uint32_t hi[3];
};

/// A grid in the memory of whoever queries it. Lengths are those of the packing; cells are laid out relative
/// to `centre`, so that positions keep their digits in single precision where the packing is far from its
/// origin. Spheres are in an order of their own, level by level along a space-filling curve.
struct GridView {
  const Sphere* spheres;       ///< `count` of them
  const std::uint32_t* ids;    ///< their indices in the packing
  const Sphere* clusters;      ///< balls around every kClusterSize spheres
  const Block* blocks;         ///< the hash table, at most half full
  const std::uint32_t* cells;  ///< first entry of each occupied cell, and the number of entries at the end
  const std::uint32_t*
      entries;  ///< place in `spheres`; above it a bit for each axis: is this its first cell?
  std::uint32_t count;
  std::uint32_t cluster_count;
  int hash_shift;  ///< 64 minus the bits of the table's size
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

INNERSPHERE_HD inline std::uint32_t hashBlock(const GridView& grid, std::uint64_t key) {
  return static_cast<std::uint32_t>(key * 0x9e3779b97f4a7c15u >> grid.hash_shift);
}

/// A block, or null if all of its cells are empty. The table is never full, so probing ends.
INNERSPHERE_HD inline const Block* findBlock(const GridView& grid, std::uint64_t key) {
  const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << (64 - grid.hash_shift)) - 1);
  for (std::uint32_t at = hashBlock(grid, key);; at = (at + 1) & mask) {
    const Block& block = grid.blocks[at];
    if (block.occupied == 0) return nullptr;
    if (block.key == key) return &block;
  }
}

/// The occupied cell number `bit` of a block, as an index into GridView::cells.
INNERSPHERE_HD inline std::uint32_t cellIndex(const Block& block, int bit) {
  const std::uint64_t before = (std::uint64_t{1} << bit) - 1;
  return block.first + static_cast<std::uint32_t>(countBits(block.occupied & before));
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
