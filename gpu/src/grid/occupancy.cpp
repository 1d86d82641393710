#include "grid/occupancy.hpp"

#include <algorithm>
#include <cmath>

namespace innersphere {

void Occupancy::build(const core::GridView& grid) {
  constexpr float kBeyond = kReach + 1;  // cells
  const float widest = std::max({grid.half.x, grid.half.y, grid.half.z});
  const float cell = widest / (kSide / 2 - kBeyond);
  inverse_cell_ = 1 / cell;
  reach_ = kReach * cell;
  lowest_ = {-grid.half.x - kBeyond * cell, -grid.half.y - kBeyond * cell, -grid.half.z - kBeyond * cell};
  rows_.fill(0);
  if (!std::isfinite(inverse_cell_)) reach_ = -1;  // too small to be told apart
  for (const core::Cluster* c = grid.clusters; c < grid.clusters + grid.cluster_count; ++c) {
    if (c->ball.radius <= 2 * reach_) {
      add(grid, c->ball);
    } else {  // large spheres are far apart
      for (std::uint32_t k = c->first; k < c->first + c->count; ++k) add(grid, grid.spheres[k]);
    }
  }
}

void Occupancy::add(const core::GridView& grid, const Sphere& ball) {
  // In cells; a little more than the ball, for all that is rounded here and in the lookup.
  const float far = ball.radius * inverse_cell_ + kReach + 1e-3f, far2 = far * far;
  const float x = (ball.x - grid.centre.x - lowest_.x) * inverse_cell_;
  const float y = (ball.y - grid.centre.y - lowest_.y) * inverse_cell_;
  const float z = (ball.z - grid.centre.z - lowest_.z) * inverse_cell_;
  static constexpr int kLast = kSide - 1;
  const auto first = [](float at) { return std::clamp(static_cast<int>(at), 0, kLast); };
  const auto gap2 = [](float at, int k) {
    const float outside = std::fabs(at - static_cast<float>(k) - 0.5f) - 0.5f;
    const float gap = 0.5f * (outside + std::fabs(outside));
    return gap * gap;
  };
  const int first_y = first(y - far), last_y = first(y + far);
  float gaps_y[kSide];
  for (int j = first_y; j <= last_y; ++j) gaps_y[j] = gap2(y, j);
  for (int k = first(z - far), last_z = first(z + far); k <= last_z; ++k) {
    const float left_z = far2 - gap2(z, k);
    for (int j = first_y; j <= last_y; ++j) {
      if (left_z < gaps_y[j]) continue;
      const float wide = std::sqrt(left_z - gaps_y[j]);
      rows_[static_cast<std::size_t>(k) * kSide + static_cast<std::size_t>(j)] |=
          ~0u >> (kLast - first(x + wide)) & ~0u << first(x - wide);
    }
  }
}

}  // namespace innersphere
