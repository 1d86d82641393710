// Small packings whose every number is known.
#pragma once

#include <memory>

#include "innersphere/collision_model.hpp"
#include "innersphere/packing_shape.hpp"

namespace innersphere::test {

/// A box about the origin filled with n x n x n equal spheres, with its surface and exact mass properties.
Packing latticeBox(const Vec3d& size, int n);

/// The surface of a ball, cut into so many rings of twice as many parts.
Surface ballSurface(double radius, std::uint32_t rings);

/// One sphere, with a finely cut surface.
Packing singleBall(double radius);

/// The same packing without its surface, as an import has it.
Packing withoutSurface(Packing packing);

/// Moved as a whole: x + offset.
Packing moved(Packing packing, const Vec3d& offset);

std::shared_ptr<PackingShape> makeShape(Packing packing);

}  // namespace innersphere::test
