// What is known of a grid before its spheres are in order: bounds, levels and tiers. With it any processor
// can build the rest, and all of them build the same.
#pragma once

#include <cstdint>

#include "core/grid_view.hpp"
#include "core/hilbert.hpp"

namespace innersphere::core {

/// No packing has more: levels that are finer would need more bits of a coordinate than a key has.
constexpr int kMostLevels = kAxisBits - 1;

struct GridPlan {
  GridView view;  ///< without arrays, and without what depends on the cells: listed_count and hash_shift
  int lowest_level;
  int levels;
  int curve_bits;                              ///< of a coordinate on the Hilbert curve
  std::uint32_t level_first[kMostLevels + 1];  ///< place of the first sphere of each level; after them: count

  /// Levels below a tier's look for partners elsewhere.
  INNERSPHERE_HD std::uint32_t firstPlace(int tier) const {
    return tier == 0 ? 0 : level_first[view.finest + tier - 1 - lowest_level];
  }

  /// By how many levels one is above the first that a tier lists; negative for those that it does not list.
  /// The first tier lists all.
  INNERSPHERE_HD int levelsAbove(int level, int tier) const {
    const int first = view.finest + tier - 1 - lowest_level;
    return tier == 0 && level < first ? 0 : level - first;
  }

  INNERSPHERE_HD int levelAt(float radius) const {
    const int level = levelOf(radius) - lowest_level;
    return level > 0 ? level : 0;
  }

  /// Of keyOf().
  INNERSPHERE_HD int keyBits() const {
    int bits = 3 * curve_bits;
    for (int last = levels - 1; last != 0; last >>= 1) ++bits;
    return bits;
  }

  /// Spheres come by this key, equal ones by their index.
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

/// The middle of a box. Zeros have no sign, whichever of them was found first.
INNERSPHERE_HD inline Vec3f middleOf(const Vec3f& lo, const Vec3f& hi) {
  return 0.5f * (lo + hi) + Vec3f{0, 0, 0};
}

}  // namespace innersphere::core
