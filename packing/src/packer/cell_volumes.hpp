// Which part of the solid each sphere stands for.
#pragma once

#include <span>
#include <vector>

#include "packer/container.hpp"
#include "packer/sphere_grid.hpp"

namespace innersphere {

struct Shares {
  std::vector<double> volumes;  ///< one for each ball, in units of the unit cube; they sum to the solid's
  double sampling_error = 0;    ///< standard error of one share relative to the mean share
};

/// The volume of the solid that is nearer to each ball's surface than to any other's, sorted or not. `volume`
/// is the solid's, in units of the unit cube. A sphere's own volume is known; only the gaps between the
/// spheres are sampled, by jittered points of a lattice, and each point counts for the sphere whose surface
/// is nearest. Runs in the current TBB arena.
Shares findShares(const Container& container, std::span<const Ball> balls, double volume);

}  // namespace innersphere
