// Finds the place of a cell on a Hilbert curve through a cube: neighbours on the curve are neighbours in
// space.
#pragma once

#include <cstdint>

#include "innersphere/vec3.hpp"

namespace innersphere::core {

/// Describes the curve as a machine. In each of 24 orientations of a cube it visits the eight octants in an
/// order, and each of them in an orientation of its own. An orientation is the octant where the curve enters
/// and the axis along which it leaves (C. H. Hamilton, "Compact Hilbert Indices", 2006).
struct alignas(8) HilbertTable {
  std::uint8_t digit[24][8];  ///< when an octant is visited
  std::uint8_t next[24][8];   ///< the orientation in it
};

namespace detail {

constexpr unsigned rotateLeft3(unsigned x, unsigned by) {
  by %= 3;
  return (x << by | x >> (3 - by)) & 7u;
}

constexpr HilbertTable makeHilbertTable() {
  HilbertTable table{};
  for (unsigned entry = 0; entry < 8; ++entry) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      for (unsigned w = 0; w < 8; ++w) {
        const unsigned octant = rotateLeft3(w ^ w >> 1, axis + 1) ^ entry;
        const unsigned even = w == 0 ? 0 : (w - 1) / 2 * 2;
        const unsigned next_entry = entry ^ rotateLeft3(even ^ even >> 1, axis + 1);
        unsigned turn = 0;  // trailing ones of w, or of w - 1
        for (unsigned bits = w == 0 ? 0 : w % 2 ? w : w - 1; bits & 1; bits >>= 1) ++turn;
        table.digit[3 * entry + axis][octant] = static_cast<std::uint8_t>(w);
        table.next[3 * entry + axis][octant] =
            static_cast<std::uint8_t>(3 * next_entry + (axis + turn + 1) % 3);
      }
    }
  }
  return table;
}

}  // namespace detail

constexpr HilbertTable kHilbertTable = detail::makeHilbertTable();

/// Returns the place of the cell (x, y, z) of 2^bits along each axis: of its 3 * bits bits, the upper 3 k are
/// the place of the cube of 2^(bits - k) cells along each axis that it is in. `table` is kHilbertTable, or a
/// copy of it.
INNERSPHERE_HD inline std::uint64_t hilbertPlace(const HilbertTable& table, std::uint32_t x, std::uint32_t y,
                                                 std::uint32_t z, int bits) {
  std::uint64_t place = 0;
  unsigned state = 0;
  for (int bit = bits - 1; bit >= 0; --bit) {
    const unsigned octant = (x >> bit & 1) | (y >> bit & 1) << 1 | (z >> bit & 1) << 2;
    place = place << 3 | table.digit[state][octant];
    state = table.next[state][octant];
  }
  return place;
}

}  // namespace innersphere::core
