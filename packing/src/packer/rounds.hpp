// The packing in rounds.
#pragma once

#include <tbb/task_arena.h>

#include <functional>
#include <vector>

#include "packer/cell_search.hpp"

namespace innersphere {

/// Inserts spheres greedily, in rounds. A round with bounds top and threshold knows that no sphere larger
/// than `top` fits, and inserts spheres larger than `threshold` until none of these fits either; that makes
/// the next top. Within a round all bricks of the octree that may hold such a sphere are searched in
/// parallel. Of the candidates that overlap, the larger one wins, or the one that comes first along the
/// Z-order curve, so the result does not depend on threads.
class Rounds {
 public:
  /// What has been placed, in the order of placing.
  struct Placed {
    SphereGrid grid;
    std::vector<float> top;     ///< for each ball: nothing larger was possible when it was placed
    float largest_missing = 0;  ///< nothing larger is possible now
  };

  Rounds(const Container& container, double delta, double min_radius)
      : container_(container), delta_(delta), min_radius_(min_radius) {}

  /// `stop` is asked after every sphere; `pause` between the parallel parts, from this thread, with the
  /// threshold, and it may throw. Both end the packing by returning true. Searches run in `arena`.
  Placed run(tbb::task_arena& arena, const std::function<bool(const Placed&)>& stop,
             const std::function<bool(const Placed&, float)>& pause);

 private:
  const Container& container_;
  double delta_;
  double min_radius_;
};

}  // namespace innersphere
