// Finds which part of the solid each sphere stands for.
#pragma once

#include <span>
#include <vector>

#include "packer/container.hpp"

namespace innersphere {

/// Holds the volumes of the balls' cells. A ball's cell is the part of the solid that is nearer to its
/// surface than to any other ball's (an Apollonius diagram, also called additively weighted Voronoi diagram).
struct CellVolumes {
  std::vector<double> volumes;  ///< One for each ball, in units of the unit cube. They sum to the solid's.
  double sampling_error = 0;    ///< The standard error of one volume, relative to the mean volume.
};

/// Finds the volumes of the cells of balls in any order. `volume` is the solid's, in units of the unit cube.
/// A sphere's own volume is known; only the gaps between the spheres are sampled, by jittered points of a
/// lattice, and each point counts for the sphere whose surface is nearest. Runs in the current TBB arena.
CellVolumes findCellVolumes(const Container& container, std::span<const Ball> balls, double volume);

}  // namespace innersphere
