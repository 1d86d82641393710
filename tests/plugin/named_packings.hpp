// The project's own solids, packed.
#pragma once

#include <memory>
#include <string>

#include "innersphere/packing_shape.hpp"

namespace innersphere::test {

/// A named solid of the project, packed with n spheres and scaled so that its bounding sphere has the radius
/// [m].
std::shared_ptr<PackingShape> makeNamedShape(const std::string& name, std::size_t n, double bounding_radius);

}  // namespace innersphere::test
