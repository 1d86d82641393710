// Declares what the collision algorithm knows of a PackingShape beyond its public face.
#pragma once

#include <optional>

#include "innersphere/packing_shape.hpp"
#include "shape/packed_model.hpp"
#include "shape/registration_check.hpp"
#include "shape/serialized_spheres.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Bullet's table has no free type numbers. This one is used by no shape of Bullet's, and where our algorithm
/// is not registered it leads to the triangle path, which is safe; CUSTOM_CONCAVE_SHAPE_TYPE would lead to a
/// cast to btSdfCollisionShape.
constexpr int kPackingShapeType = FAST_CONCAVE_MESH_PROXYTYPE;

struct PackingShape::Impl {
  explicit Impl(std::shared_ptr<const PackedModel> packed_solid);
  Impl(std::shared_ptr<const PackedModel> packed_solid, const btTransform& mesh_to_body);

  const Packing& packing() const { return solid->packing(); }
  bool hasSurface() const { return solid->hasSurface(); }
  const SurfaceQueries& surfaceQueries() const { return solid->surfaceQueries(); }
  const VertexHillClimb& vertexHillClimb() const { return solid->vertexHillClimb(); }
  /// Returns by how much volume-true spheres reach out of the solid's bounds: without a surface they are what
  /// collides.
  btScalar overshoot() const { return hasSurface() ? btScalar(0) : prefix->largest_overshoot; }
  /// Returns the spheres to use where gaps of `accuracy` [m] at the surface are allowed; 0: those the user
  /// chose.
  const Prefix& prefixFor(btScalar accuracy) const {
    return accuracy > 0 ? solid->prefixWithin(accuracy / scaling.x(), *prefix) : *prefix;
  }
  /// Returns half the thickness of the solid where it is thickest [m].
  btScalar halfThickness() const { return prefix->largest_radius * scaling.x(); }
  /// Returns the transform from the packing's frame to the world for a body at `body`: x_world = result(scale
  /// * x).
  btTransform toWorld(const btTransform& body) const;

  /// Returns the moments for mass 1 and scale 1 in the shape's frame [m^2].
  btVector3 moments() const;

  const std::shared_ptr<const PackedModel> solid;
  const ShapeFrame frame;
  const btTransform from_principal;  ///< to the shape's frame, for scale 1
  const Prefix* prefix;              ///< that the user chose
  btVector3 scaling{1, 1, 1};
  btScalar disc = 0;  ///< the angular motion disc, asked for many times in a step [m]
  /// The same in the principal frame: it says how large the solid is, wherever the origin lies [m].
  btScalar size = 0;
  std::optional<ContactOptions> options;  ///< of its own
  std::uint64_t version = 0;              ///< another one after each change, and for each shape
  mutable SerializedSpheres serialized;
  mutable RegistrationCheck check;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
