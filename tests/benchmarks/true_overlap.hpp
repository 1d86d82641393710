// Overlap volumes of solids without an exact boolean of theirs, by sampling.
#pragma once

#include <cstddef>

#include "innersphere/placement.hpp"
#include "innersphere/solid.hpp"

namespace innersphere::benchmarks {

struct SampledVolume {
  double volume = 0;  ///< [m^3]
  double error = 0;   ///< half the difference of two halves of the samples, relative to the volume
};

/// The volume that a solid shares with a copy of it. Points of a lattice of low discrepancy fill the box that
/// the two boxes share; their error falls almost with their number.
SampledVolume sampledOverlap(const Solid& solid, const Placement& copy, std::size_t samples);

}  // namespace innersphere::benchmarks
