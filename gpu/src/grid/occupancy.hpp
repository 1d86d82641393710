// Says where a grid has spheres at all, coarsely: it has a bit for each of 32^3 cells around it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/grid_view.hpp"

namespace innersphere {

/// Tells which parts of a body need no look. Bodies whose bounds meet may still be far apart, as links of a
/// chain are: this says so of most parts of them, with one lookup.
class Occupancy {
 public:
  /// Marks the cells near the spheres of a grid, of which only clusters and bounds are used.
  void build(const core::GridView& grid);

  /// Returns false if the ball, which meets the bounds of the grid, meets none of its spheres. `p` is
  /// relative to the centre of the grid.
  bool mayMeet(const Vec3f& p, float radius) const {
    if (!(radius <= reach_)) return true;
    const auto cell = [&](float x, float lowest) {
      return static_cast<std::uint32_t>((x - lowest) * inverse_cell_);
    };
    return rows_[(cell(p.z, lowest_.z) * kSide + cell(p.y, lowest_.y)) % rows_.size()] >>
               cell(p.x, lowest_.x) % kSide &
           1u;
  }

 private:
  static constexpr std::uint32_t kSide = 32;
  static constexpr float kReach = 2;  ///< cells

  void add(const core::GridView& grid, const Sphere& ball);

  Vec3f lowest_{0, 0, 0};  ///< corner of the first cell
  float inverse_cell_ = 0;
  float reach_ = 0;  ///< a cell is set if a ball of this radius with its centre there can meet a sphere
  std::array<std::uint32_t, kSide * kSide> rows_{};  ///< along x; by z, then y
};

}  // namespace innersphere
