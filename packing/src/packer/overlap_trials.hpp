// Places copies of a solid so that they share given parts of it, and tells exactly how much they share.
#pragma once

#include <cstddef>
#include <vector>

#include "innersphere/packing.hpp"
#include "packer/container.hpp"
#include "packer/voxels.hpp"

namespace innersphere {

/// Says where a copy is, and which part of the solid both share.
struct OverlapTrial {
  Pose pose;
  Voxels::Shared truth;
};

/// Holds copies at poses that are the same for every run, by rising depth.
struct OverlapTrials {
  std::vector<OverlapTrial> trials;
  double shallowest = 0;  ///< See OverlapErrors::shallowest.
};

/// Turns `count` copies at random, puts a random point of each on one of the solid, and moves it in a random
/// direction until it is as deep as wanted: the logarithms of depths are evenly spread. Overlaps of less than
/// 1 % of the solid are found from `surface`, in the packing's frame, if it is closed, others from sample
/// points. `volume` is the solid's, in units of the unit cube. Runs in the current TBB arena.
OverlapTrials makeOverlapTrials(const Container& container, const Surface& surface, const Voxels& voxels,
                                double volume, std::size_t count);

}  // namespace innersphere
