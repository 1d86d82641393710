// What the collision algorithm knows of a PackingShape beyond its public face.
#pragma once

#include "innersphere/packing_shape.hpp"
#include "lazy.hpp"
#include "nearest_triangle.hpp"
#include "principal_frame.hpp"
#include "sphere_tree.hpp"
#include "surface_tree.hpp"
#include "vertex_climb.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Bullet's table has no free type numbers. This one is used by no shape of Bullet's, and where our algorithm
/// is not registered it leads to the triangle path, which is safe; CUSTOM_CONCAVE_SHAPE_TYPE would lead to a
/// cast to btSdfCollisionShape.
constexpr int kPackingShapeType = FAST_CONCAVE_MESH_PROXYTYPE;

struct PackingShape::Impl {
  explicit Impl(std::shared_ptr<const CollisionModel> collision_model);

  const Packing& packing() const { return model->packing(); }
  bool hasSurface() const { return !packing().surface.triangles.empty(); }
  const SphereTree& sphereTree() const;
  /// Only if hasSurface(). In the packing's frame.
  const SurfaceTree& surfaceTree() const;
  const NearestTriangle& nearestTriangle() const;
  const VertexClimb& vertexClimb() const;
  /// How far the spheres may end inside of the surface, for scale 1 [m].
  btScalar recess() const;
  /// From the packing's frame to the world for a body at `body`: x_world = result(scale * x).
  btTransform toWorld(const btTransform& body) const;

  std::shared_ptr<const CollisionModel> model;
  PrincipalFrame frame;
  btVector3 box_min{0, 0, 0};  ///< of the surface and the spheres, in the shape's frame, for scale 1
  btVector3 box_max{0, 0, 0};
  btVector3 sphere_centre{0, 0, 0};
  btScalar sphere_radius = 0;
  btScalar median_radius = 0;
  const float* volume_true = nullptr;  ///< radii of all spheres, or null if the packing has none
  btScalar largest_bulge = 0;          ///< largest volume-true radius minus own radius
  btVector3 scaling{1, 1, 1};

 private:
  Lazy<SphereTree> sphere_tree_;
  Lazy<SurfaceTree> surface_tree_;
  Lazy<NearestTriangle> nearest_triangle_;
  Lazy<VertexClimb> vertex_climb_;
  Lazy<btScalar> recess_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
