// Finds radii with which spheres stand for the whole solid.
#pragma once

#include <span>
#include <vector>

#include "innersphere/packing.hpp"
#include "packer/cell_volumes.hpp"
#include "packer/container.hpp"

namespace innersphere {

/// Returns the radii [m] of balls with the volumes of their cells, then adjusted near the surface (see
/// VolumeTrueRadii). Runs in the current TBB arena.
VolumeTrueRadii volumeTrueRadii(const Container& container, std::span<const Ball> balls,
                                const CellVolumes& cells);

}  // namespace innersphere
