// Finds the cells of one grid level, and which of them list a sphere.
#pragma once

#include <cstdint>
#include <limits>

#include "core/grid_plan.hpp"

namespace innersphere::core {

/// Returns the squared distance from x to the cell number `cell` of an axis, in cells; it has no branch.
INNERSPHERE_HD inline float gap2(float x, std::uint32_t cell) {
  const float middle =
      static_cast<float>(static_cast<std::int32_t>(cell)) - 0.5f;  // number 0 is before the first
  const float outside = fabsf(x - middle) - 0.5f;
  const float gap = 0.5f * (outside + fabsf(outside));
  return gap * gap;
}

/// Returns the room for a list of `count` spheres, in whole steps of kListStep.
INNERSPHERE_HD inline std::uint32_t padded(std::uint32_t count) {
  return (count + kListStep - 1) / kListStep * kListStep;
}

/// Says where to look for the cells that list a sphere: those with a point that is not farther away than its
/// radius and the reach of the grid level's query spheres, by the squares of three gaps, added up in this
/// order.
struct CellsNear {
  float centre[3];  ///< in cells
  float far2;
  std::uint32_t lo[3], hi[3];

  INNERSPHERE_HD bool isFar(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return gap2(centre[2], z) + gap2(centre[1], y) + gap2(centre[0], x) > far2;
  }
};

/// Describes one grid level. Cells are numbered along x, then y, then z: in the order of their keys.
struct GridLevel {
  int number;
  std::uint32_t first_place;  ///< of the spheres that it may list
  std::uint32_t size[3];
  float scale;  ///< cells in a metre: squares of lengths in cells are neither too small nor too large
  float reach;  ///< of query spheres, in cells
  Vec3f half;
  std::uint64_t count;  ///< of cells

  INNERSPHERE_HD std::uint64_t cellAt(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return (static_cast<std::uint64_t>(z) * size[1] + y) * size[0] + x;
  }

  INNERSPHERE_HD std::uint64_t keyOf(std::uint64_t cell) const {
    const std::uint64_t row = cell / size[0];
    return cellKey(number, static_cast<std::uint32_t>(cell % size[0]),
                   static_cast<std::uint32_t>(row % size[1]), static_cast<std::uint32_t>(row / size[1]));
  }

  /// Returns where to look for the cells that list `s`, which is relative to the centre of the grid.
  INNERSPHERE_HD CellsNear near(const Sphere& s) const {
    const float far = s.radius * scale + reach;
    CellsNear cells{
        {(s.x + half.x) * scale, (s.y + half.y) * scale, (s.z + half.z) * scale}, far * far, {}, {}};
    for (int axis = 0; axis < 3; ++axis) {
      const float lo = cells.centre[axis] - far + 1;
      const auto hi = static_cast<std::uint32_t>(cells.centre[axis] + far + 1);
      cells.lo[axis] = static_cast<std::uint32_t>(lo > 0 ? lo : 0.0f);
      cells.hi[axis] = hi < size[axis] - 1 ? hi : size[axis] - 1;
    }
    return cells;
  }
};

inline GridLevel makeGridLevel(const GridPlan& plan, int number) {
  constexpr float kMax = std::numeric_limits<float>::max();
  GridLevel grid_level{};
  grid_level.number = number;
  grid_level.first_place = plan.firstPlace(number);
  grid_level.scale = powerOfTwo(-(plan.view.finest + number));
  grid_level.reach = reachOf(plan.view, number) * grid_level.scale;
  grid_level.half = plan.view.half;
  grid_level.count = 1;
  CellBox all{};
  cellBox(plan.view, number, {-kMax, -kMax, -kMax}, {kMax, kMax, kMax}, all);
  for (int axis = 0; axis < 3; ++axis) {
    grid_level.size[axis] = all.hi[axis] + 1;
    grid_level.count *= grid_level.size[axis];
  }
  return grid_level;
}

/// Returns true if each cell of the level has a counter. In other levels only cells that list something have
/// one.
inline bool isDense(const GridLevel& grid_level, std::uint32_t spheres) {
  const std::uint64_t most = 64 + std::uint64_t{8} * spheres, limit = std::uint64_t{1} << 31;
  return grid_level.count <= (most < limit ? most : limit);
}

}  // namespace innersphere::core
