// Solids with thin parts.
#pragma once

#include "innersphere/geometry.hpp"

namespace innersphere::test {

/// A cup about z, 0.1 m high, with walls of 1 mm.
Mesh cupMesh();
/// A ball of 0.1 m with a horn along z, 0.2 m long, that ends in a point.
Mesh hornMesh();

}  // namespace innersphere::test
