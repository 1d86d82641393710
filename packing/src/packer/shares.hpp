// Which part of the solid each sphere stands for.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "innersphere/packing.hpp"
#include "packer/container.hpp"
#include "packer/sphere_grid.hpp"

namespace innersphere {

/// Volume-true radii (see VolumeTrueRadii) of all `balls` together, sorted or not. `volume` is the solid's,
/// in units of the unit cube. A sphere's own volume is known; only the gaps between the spheres are sampled,
/// by jittered points of a lattice, and each point counts for the sphere whose surface is nearest. Runs in
/// the current TBB arena.
VolumeTrueRadii findVolumeTrueRadii(const Container& container, std::span<const Ball> balls, double volume);

}  // namespace innersphere
