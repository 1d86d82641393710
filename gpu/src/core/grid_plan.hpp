// Holds what is known of a grid before its spheres are in order: bounds, size levels and grid levels. With it
// any processor can build the rest, and all of them build the same.
#pragma once

#include <cstdint>

#include "core/grid_view.hpp"
#include "core/hilbert.hpp"

namespace innersphere::core {

/// This is the number of size levels, at most: finer ones would need more bits of a coordinate than a key
/// has.
constexpr int kMostLevels = kAxisBits - 1;

/// Says what a grid is going to be like. It depends on the spheres, not on their order.
struct GridPlan {
  GridView view;  ///< Without arrays, and without what depends on the cells: listed_count and hash_shift.
  int lowest_level;
  int levels;
  int curve_bits;  ///< The bits of a coordinate on the Hilbert curve.
  std::uint32_t
      level_first[kMostLevels + 1];  ///< The place of the first sphere of each size level; then count.

  /// Returns the place of the first sphere that a grid level may list: smaller spheres are found on finer
  /// grid levels.
  INNERSPHERE_HD std::uint32_t firstPlace(int grid_level) const {
    return grid_level == 0 ? 0 : level_first[view.finest + grid_level - 1 - lowest_level];
  }

  /// Returns how many size levels one is above the first that a grid level lists; it is negative if it is not
  /// listed there. The first grid level lists all.
  INNERSPHERE_HD int levelsAbove(int level, int grid_level) const {
    const int first = view.finest + grid_level - 1 - lowest_level;
    return grid_level == 0 && level < first ? 0 : level - first;
  }

  INNERSPHERE_HD int levelAt(float radius) const {
    const int level = levelOf(radius) - lowest_level;
    return level > 0 ? level : 0;
  }

  /// Returns the number of bits of keyOf().
  INNERSPHERE_HD int keyBits() const {
    int bits = 3 * curve_bits;
    for (int last = levels - 1; last != 0; last >>= 1) ++bits;
    return bits;
  }

  /// Returns a sphere's key. Spheres come by this key, equal ones by their index.
  INNERSPHERE_HD std::uint64_t keyOf(const Sphere& s, const HilbertTable& table) const {
    const float inverse_cell = powerOfTwo(-lowest_level);
    const Vec3f p = Vec3f{s.x, s.y, s.z} - view.centre + view.half;
    const std::uint64_t place = hilbertPlace(table, static_cast<std::uint32_t>(p.x * inverse_cell),
                                             static_cast<std::uint32_t>(p.y * inverse_cell),
                                             static_cast<std::uint32_t>(p.z * inverse_cell), curve_bits);
    return static_cast<std::uint64_t>(levelAt(s.radius)) << (3 * curve_bits) | place;
  }

  INNERSPHERE_HD Sphere centred(const Sphere& s) const {
    return {s.x - view.centre.x, s.y - view.centre.y, s.z - view.centre.z, s.radius};
  }
};

/// Returns the middle of a box. Zeros have no sign, whichever of them was found first.
INNERSPHERE_HD inline Vec3f middleOf(const Vec3f& lo, const Vec3f& hi) {
  return 0.5f * (lo + hi) + Vec3f{0, 0, 0};
}

}  // namespace innersphere::core
