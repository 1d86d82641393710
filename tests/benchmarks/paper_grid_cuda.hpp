// The paper's query on a device as it is written there: a thread for each sphere, level after level, cell
// after cell.
#pragma once

#include <cstddef>
#include <vector>

#include "paper_grid.hpp"

namespace innersphere::benchmarks {

/// Where a pair's bodies are, each in the frame of the other.
struct PaperPose {
  Placement a_in_b, b_in_a;
};

struct PaperCuda {
  double kernel = 0;      ///< median time of the launch, by events [us]
  double host = 0;        ///< the same with the copy of the poses, that of the sums and the wait [us]
  std::size_t pairs = 0;  ///< of the first pose
  double volume = 0;
};

/// All pairs of poses in one launch, `runs` times. Sums volumes in floating point, in no fixed order.
PaperCuda runPaperOnDevice(const PaperGrid& a, const PaperGrid& b, const std::vector<PaperPose>& poses,
                           std::size_t runs);

}  // namespace innersphere::benchmarks
