// Builds balls around the clusters of a grid, around runs of them, around runs of those, and so on: whole
// parts of a packing that are far from the other one are passed over at once.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/grid_view.hpp"

namespace innersphere {

/// Returns a ball around all of some balls, rounded outwards. There must be one.
Sphere ballAround(const Sphere* begin, const Sphere* end);

/// Holds the balls of all levels. Clusters that follow each other are neighbours, because they follow a curve
/// that fills space.
class ClusterTree {
 public:
  static constexpr std::uint32_t kRun = 32;  ///< balls in one of the next level

  /// Builds the balls, rounded outwards. There must be a cluster.
  void build(const std::vector<core::Cluster>& clusters);

  /// Calls f(cluster) for those of the clusters first..end that meet, by rising number, until it returns
  /// false. `meeting`(balls, count) returns a bit for each of up to kRun balls.
  template <typename Meeting, typename F>
  bool forMeeting(std::size_t first, std::size_t end, const Meeting& meeting, const F& f) const {
    return visit(depth_ - 1, first, end, meeting, f);
  }

 private:
  /// Visits the balls of one level, and what is below those that meet. `first` and `end` are numbers of
  /// clusters.
  template <typename Meeting, typename F>
  bool visit(std::size_t level, std::size_t first, std::size_t end, const Meeting& meeting,
             const F& f) const {
    std::size_t size = 1;  // clusters in a ball of this level
    for (std::size_t l = 0; l < level; ++l) size *= kRun;
    for (std::size_t ball = first / size, last = (end + size - 1) / size; ball < last; ball += kRun) {
      const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(kRun, last - ball));
      for (std::uint32_t bits = meeting(levels_[level].data() + ball, count); bits != 0; bits &= bits - 1) {
        const std::size_t met = ball + static_cast<std::size_t>(std::countr_zero(bits));
        const bool go_on = level == 0 ? f(met)
                                      : visit(level - 1, std::max(first, met * size),
                                              std::min(end, (met + 1) * size), meeting, f);
        if (!go_on) return false;
      }
    }
    return true;
  }

  std::vector<std::vector<Sphere>> levels_;  ///< those of the clusters first
  std::size_t depth_ = 0;                    ///< levels in use
};

}  // namespace innersphere
