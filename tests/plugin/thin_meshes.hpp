// Solids with thin parts.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "innersphere/geometry.hpp"
#include "innersphere/solid.hpp"

namespace innersphere::test {

/// A cup about z, 0.1 m high, with walls of 1 mm, of so many flat faces around.
Mesh cupMesh(std::uint32_t around = 48);
/// A ball of 0.1 m with a horn along z, 0.2 m long, that ends in a point.
Mesh hornMesh();
/// A solid like a cow of 0.5 m that stands along x: a body with head, legs, ears, horns, udder and tail, of
/// which the thinnest measures 6 mm.
std::unique_ptr<Solid> makeCow();

}  // namespace innersphere::test
