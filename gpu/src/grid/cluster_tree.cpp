#include "grid/cluster_tree.hpp"

#include <cmath>
#include <limits>

#include "core/grid_plan.hpp"
#include "grid/grid_plan.hpp"

namespace innersphere {

Sphere ballAround(const Sphere* begin, const Sphere* end) {
  constexpr float kMax = std::numeric_limits<float>::max();
  Vec3f lo{kMax, kMax, kMax}, hi{-kMax, -kMax, -kMax};
  for (const Sphere* s = begin; s < end; ++s) {
    lo = {std::min(lo.x, s->x), std::min(lo.y, s->y), std::min(lo.z, s->z)};
    hi = {std::max(hi.x, s->x), std::max(hi.y, s->y), std::max(hi.z, s->z)};
  }
  const Vec3f middle = core::middleOf(lo, hi);
  double radius = 0;
  for (const Sphere* s = begin; s < end; ++s) {
    const Vec3d d = Vec3d{s->x, s->y, s->z} - Vec3d{middle.x, middle.y, middle.z};
    radius = std::max(radius, std::sqrt(dot(d, d)) + s->radius);
  }
  return {middle.x, middle.y, middle.z, roundUp(radius)};
}

void ClusterTree::build(const std::vector<core::Cluster>& clusters) {
  if (levels_.empty()) levels_.emplace_back();
  levels_[0].clear();
  for (const core::Cluster& cluster : clusters) levels_[0].push_back(cluster.ball);
  for (depth_ = 1; levels_[depth_ - 1].size() > kRun; ++depth_) {
    if (levels_.size() == depth_) levels_.emplace_back();
    const std::vector<Sphere>& below = levels_[depth_ - 1];
    levels_[depth_].clear();
    for (std::size_t k = 0; k < below.size(); k += kRun) {
      const Sphere* const first = below.data() + k;
      levels_[depth_].push_back(ballAround(first, first + std::min<std::size_t>(kRun, below.size() - k)));
    }
  }
}

}  // namespace innersphere
