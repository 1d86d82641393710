// Finds masses that make spheres weigh like their solid.
#pragma once

#include <vector>

#include "innersphere/packing.hpp"

namespace innersphere {

/// Returns the density of each sphere, relative to the solid's, with which the spheres have the volume, the
/// centre of mass and the inertia of the solid. Of all such densities these change the masses least, relative
/// to `cell_volumes`, the parts of the solid's volume that the spheres stand for [m^3]. No mass falls below a
/// hundredth of its cell's. The result is empty if there are no such densities: too few spheres, or a solid
/// whose inertia they cannot reach.
std::vector<float> findMassWeights(const std::vector<Sphere>& spheres,
                                   const std::vector<double>& cell_volumes, const MassProperties& solid);

}  // namespace innersphere
