// Finds mass properties and surface of a solid of which only a signed distance is known.
#pragma once

#include <functional>

#include "innersphere/geometry.hpp"

namespace innersphere {

/// The distance is negative inside, and never farther from 0 than the surface is; beyond `cutoff` only the
/// sign has to be right.
using SignedDistance = std::function<double(const Vec3d& p, double cutoff)>;

/// Measures a solid by summing cells of 1 / resolution of the longest side; the relative error of the volume
/// is about 1 / resolution^2 for smooth solids of compact shape.
MassProperties sampledMass(const SignedDistance& field, const Bounds& bounds, int resolution);

/// Returns surface nets (Gibson 1998): closed, with a vertex in each of the cells that the surface passes
/// through. Edges are rounded and parts thinner than a cell can be lost.
Mesh sampledSurface(const SignedDistance& field, const Bounds& bounds, int resolution);

}  // namespace innersphere
