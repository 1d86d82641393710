// The packing in rounds.
#pragma once

#include <functional>
#include <vector>

#include "innersphere/packer.hpp"
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
    std::vector<Ball> balls;
    std::vector<float> top;     ///< for each ball: nothing larger was possible when it was placed
    float largest_missing = 0;  ///< nothing larger is possible now
  };

  /// `stop` is asked after every sphere, `pause` between the parallel parts (it may throw).
  Rounds(const Container& container, const PackOptions& options, double min_radius)
      : container_(container), options_(options), min_radius_(min_radius) {}

  Placed run(const std::function<bool(const Placed&)>& stop,
             const std::function<bool(const Placed&, float)>& pause);

 private:
  const Container& container_;
  const PackOptions& options_;
  double min_radius_;
};

}  // namespace innersphere
