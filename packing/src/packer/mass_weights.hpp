// Masses that make spheres weigh like their solid.
#pragma once

#include <vector>

#include "innersphere/packing.hpp"

namespace innersphere {

/// The density of each sphere, relative to the solid's, with which the spheres have the volume, the centre of
/// mass and the inertia of the solid. Of all such densities those that change the masses least, relative to
/// `shares`, the parts of the solid's volume that the spheres stand for [m^3]; no mass falls below a
/// hundredth of its share. Empty if there are none: too few spheres, or a solid whose inertia they cannot
/// reach.
std::vector<float> findMassWeights(const std::vector<Sphere>& spheres, const std::vector<double>& shares,
                                   const MassProperties& solid);

}  // namespace innersphere
