// The Bullet collision shape of a packed solid.
#pragma once

#include <memory>

#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <LinearMath/btTransform.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/collision_model.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A moving non-convex solid. Its frame is the solid's principal frame: origin at the centre of mass, axes
/// along the principal axes of inertia, as Bullet's rigid bodies need it. principalTransform() places the
/// packing, and so the user's graphics, in that frame. Register PackingCollisionAlgorithm with the
/// dispatcher, or bodies fall through.
class PackingShape : public btConcaveShape {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// Bodies of the same solid can share one shape, and shapes can share one model. Throws Error if `model` is
  /// null.
  explicit PackingShape(std::shared_ptr<const CollisionModel> model);
  ~PackingShape() override;

  const CollisionModel& model() const;

  /// From the packing's frame to the shape's, for scale 1: graphics are drawn at
  /// bodyTransform * (scale * (principalTransform() * (x - origin))), with the packing's origin, which is
  /// zero unless the mesh is far from its own.
  const btTransform& principalTransform() const;

  /// The shape behind a btCollisionShape, or null if it is none of ours, whatever its type number.
  static const PackingShape* from(const btCollisionShape* shape);

  /// Collide with the first, largest spheres only: the knob between speed and accuracy. 0, or more than there
  /// are: all of them, as at first. Fewer spheres feel fine features later or not at all; depths are measured
  /// on the solid's surface all the same. Takes effect with the next step; not during one. For one body
  /// alone, give it a shape of its own from the same model: shapes share all data, so that it costs nothing.
  /// See also ContactOptions::accuracy.
  void setSphereCount(std::size_t count);
  std::size_t sphereCount() const;

  // btCollisionShape: all bounds take constant time. The margin, 0 at first, makes the solid that much larger
  // on all sides: contacts come that much earlier. Mass properties do not follow it, nor does it scale.
  void getAabb(const btTransform& t, btVector3& min, btVector3& max) const override;
  void getBoundingSphere(btVector3& centre, btScalar& radius) const override;
  btScalar getAngularMotionDisc() const override;
  void setMargin(btScalar margin) override;
  btScalar getContactBreakingThreshold(btScalar factor) const override;
  /// About the centre of mass; replaces the scaling before. Uniform and positive only: throws Error
  /// bad_argument otherwise. From btCompoundShape::setLocalScaling too, which has scaled the children before
  /// it by then.
  void setLocalScaling(const btVector3& scaling) override;
  const btVector3& getLocalScaling() const override;
  /// Exact moments of the solid for a homogeneous body of this mass [kg m^2].
  void calculateLocalInertia(btScalar mass, btVector3& inertia) const override;
  const char* getName() const override;
  /// As a btCompoundShape of spheres, sphereCount() of them, which any Bullet can load; their radii include
  /// the margin.
  int calculateSerializeBufferSize() const override;
  const char* serialize(void* buffer, btSerializer* serializer) const override;
  // btConcaveShape
  /// Triangles of the solid's surface near a box, for rays, sweeps, debug drawing and soft bodies. None if
  /// the packing has no surface: such a body collides, but rays pass through it.
  void processAllTriangles(btTriangleCallback* callback, const btVector3& min,
                           const btVector3& max) const override;

  struct Impl;  ///< private to the plug-in
  const Impl& impl() const { return *impl_; }

 private:
  void noteChange();

  std::unique_ptr<Impl> impl_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
