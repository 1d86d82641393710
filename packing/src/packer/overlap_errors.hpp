// Measures how far overlap volumes found with the spheres are from the truth.
#pragma once

#include <span>
#include <vector>

#include "innersphere/packing.hpp"
#include "packer/container.hpp"

namespace innersphere {

/// Overlaps the solid with copies of itself at poses that are the same for every run, eight for each bin of
/// kOverlapBins, and compares the sums of lenses with what sample points say. `balls` and `radii` are a
/// packing and its volume-true radii [m]; `volume` is the solid's, in units of the unit cube. Runs in the
/// current TBB arena.
OverlapErrors findOverlapErrors(const Container& container, std::span<const Ball> balls,
                                const std::vector<VolumeTrueRadii>& radii, double volume,
                                const Point& centre_of_mass);

}  // namespace innersphere
