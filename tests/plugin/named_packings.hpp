// Solids, packed: any, and the project's own.
#pragma once

#include <memory>
#include <string>

#include "innersphere/packing_shape.hpp"
#include "innersphere/solid.hpp"

namespace innersphere::test {

/// Any solid, packed with n spheres.
std::shared_ptr<PackingShape> makePackedShape(const Solid& solid, std::size_t n);

/// A named solid of the project, packed with n spheres and scaled so that its bounding sphere has the radius
/// [m].
std::shared_ptr<PackingShape> makeNamedShape(const std::string& name, std::size_t n, double bounding_radius);

/// A torus about the z axis, packed with n spheres. Radii of the ring and of the tube [m].
std::shared_ptr<PackingShape> makeTorusShape(double ring, double tube, std::size_t n);

/// The same with three times as many triangles along each circle as the packer's mesh has.
std::shared_ptr<PackingShape> makeFineTorusShape(double ring, double tube, std::size_t n);

/// A thick disc about the z axis with a tube in it that is bent to a ring. Radii of the ring and of the tube
/// [m].
std::shared_ptr<PackingShape> makeRingTubeShape(double ring, double tube, std::size_t n);

/// With 16,000 triangles.
std::shared_ptr<PackingShape> makeFineBallShape(double radius, std::size_t n);

/// Packed as what it is, a mesh of 960 triangles: the ball itself is one sphere.
std::shared_ptr<PackingShape> makeMeshBallShape(double radius, std::size_t n);

/// About z, of this full height, with 192 sides.
std::shared_ptr<PackingShape> makeFineCylinderShape(double radius, double height, std::size_t n);

}  // namespace innersphere::test
