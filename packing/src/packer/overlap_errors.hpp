// Measures how far overlap volumes found with the spheres are from the truth.
#pragma once

#include <span>
#include <vector>

#include "innersphere/packing.hpp"
#include "packer/container.hpp"
#include "packer/surface_samples.hpp"

namespace innersphere {

/// Overlaps the solid with copies of itself, planes and balls that are the same for every run, and compares
/// sums of lenses with the true volumes (see OverlapErrors). `surface` is the solid's, in the packing's
/// frame, `samples` are points of it; `balls` and `radii` are a packing and its volume-true radii [m];
/// `volume` is the solid's, in units of the unit cube. Returns nothing if the solid cannot be overlapped
/// often enough. Runs in the current TBB arena.
OverlapErrors findOverlapErrors(const Container& container, const Surface& surface,
                                const SurfaceSamples& samples, std::span<const Ball> balls,
                                const std::vector<VolumeTrueRadii>& radii, double volume);

}  // namespace innersphere
