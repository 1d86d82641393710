// Declares the Bullet collision shape of a packed solid.
#pragma once

#include <memory>

#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <LinearMath/btTransform.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/collision_model.hpp"
#include "innersphere/contact_options.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// This is a non-convex solid that may move. Register PackingCollisionAlgorithm with the dispatcher, or
/// bodies fall through.
///
/// The frame of the shape is that of its body. Bullet's dynamic bodies have their centre of mass at the
/// origin of their frame, and turn as if its axes were principal axes of inertia. So the shape has the
/// principal frame of the solid, unless another one is asked for, and that is not the frame of the mesh.
/// meshTransform() and bodyTransform() lead from one to the other.
///
/// Contacts are on the triangles of the mesh, or on the curved surface that was cut into them: triangles that
/// meet at less than 30 degrees are facets of one if it bends on, in the same sense and about as much, at the
/// far side of at least one of the two. Faces that only meet at an angle, as on a roof, are flat at any
/// angle.
class PackingShape : public btConcaveShape {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// Says which frame a shape, and so its body, has.
  enum class Frame {
    /// The origin is at the centre of mass, and the axes are principal axes of inertia: for dynamic bodies.
    principal,
    /// The frame is the mesh's own: for static and kinematic bodies, btCollisionObject, and children of
    /// compounds. A dynamic body would turn about the mesh's origin, as if its mass were there.
    mesh
  };

  /// Makes a shape with all spheres, no margin, scale 1 and no options of its own. Bodies of the same solid
  /// can share one shape, and shapes can share one model. Throws Error bad_argument if `model` is null.
  explicit PackingShape(std::shared_ptr<const CollisionModel> model, Frame frame = Frame::principal);

  /// Makes a shape in a frame that the caller gives: `mesh_to_body` leads from the mesh's frame, unscaled, to
  /// the shape's. For a link of a robot, for example, give the frame that its inertia is given in: a link of
  /// a btMultiBody is a dynamic body, too, and wants its centre of mass at the origin. The inertia may be the
  /// caller's own; calculateLocalInertia() says what the shape knows of it. Throws Error: bad_argument (a
  /// null pointer, or more than a rotation and a translation), not_finite.
  PackingShape(std::shared_ptr<const CollisionModel> model, const btTransform& mesh_to_body);
  ~PackingShape() override;

  /// Returns the model that the shape was made of.
  const CollisionModel& model() const;

  /// Returns where the scaled mesh lies in the frame of the shape: a vertex x of the mesh, times the scaling,
  /// is at meshToBody() * (scaling * x). It is the second argument of a btDefaultMotionState that takes and
  /// gives the places of the mesh. It changes with setLocalScaling().
  btTransform meshToBody() const;
  /// Returns where the body has to be for the scaled mesh to be at `mesh`: mesh * meshToBody().inverse(). It
  /// is for poses that belong to the mesh: start transforms, saved games, kinematic targets. A pivot of a
  /// constraint that is given in the frame of the mesh is moved by meshToBody().
  btTransform bodyTransform(const btTransform& mesh) const;
  /// Returns where the scaled mesh is, to be drawn, when the body is at `body`: body * meshToBody().
  btTransform meshTransform(const btTransform& body) const;

  /// Returns the transform from the packing's frame to the principal frame, for scale 1. The packing's frame
  /// is the mesh's, moved by Packing::origin, which is zero unless the mesh is far from its own origin.
  const btTransform& principalTransform() const;

  /// Returns the packing shape behind a btCollisionShape. Returns null if that is null or none of ours,
  /// whatever its type number.
  static const PackingShape* from(const btCollisionShape* shape);

  /// Makes the shape collide with its first, largest spheres only: the knob between speed and accuracy. 0, or
  /// more than there are, means all of them, as at first. Fewer spheres feel fine features later or not at
  /// all; depths are measured on the solid's surface all the same. It takes effect with the next step; do not
  /// call it during one. For one body alone, give it a shape of its own from the same model: shapes share all
  /// data, so that it costs nothing. See also ContactOptions::accuracy.
  void setSphereCount(std::size_t count);
  /// Returns how many spheres the shape collides with.
  std::size_t sphereCount() const;

  /// Sets options for all pairs of bodies with this shape, in place of those that the dispatcher was
  /// registered with; combine() says what holds for a pair in which both shapes have their own. Backend,
  /// estimator and reuse are always the dispatcher's. For one body alone, give it a shape of its own from the
  /// same model. It takes effect with the next step; do not call it during one. Throws Error bad_argument if
  /// stiffness, damping or accuracy is negative or not finite.
  void setContactOptions(const ContactOptions& options);
  /// Makes the dispatcher's options hold again, as at first.
  void resetContactOptions();
  /// Returns the shape's own options, or null if the dispatcher's hold.
  const ContactOptions* contactOptions() const;

  // As btCollisionShape:

  /// Gives a box around the solid at `t`, with its margin, in the world [m]. It takes constant time, as all
  /// bounds here do.
  void getAabb(const btTransform& t, btVector3& min, btVector3& max) const override;
  /// Gives a ball around the solid, with its margin, in the frame of the shape [m].
  void getBoundingSphere(btVector3& centre, btScalar& radius) const override;
  /// Returns a distance from the origin of the shape that no point of the solid exceeds [m], with the margin.
  btScalar getAngularMotionDisc() const override;
  /// Sets the margin [m], 0 at first, which makes the solid that much larger on all sides: contacts come that
  /// much earlier. Mass properties do not follow it, nor does it scale. Throws Error bad_argument if it is
  /// negative or not finite: spheres can be searched with more than their radii, not with less.
  void setMargin(btScalar margin) override;
  /// Returns how far apart two points of a contact may be until Bullet drops it [m]: `factor` times the
  /// solid's size, but no more than the median radius of the spheres in use, so that fine features of a large
  /// solid stay apart.
  btScalar getContactBreakingThreshold(btScalar factor) const override;
  /// Scales the shape about the origin of its frame, in place of the scaling before, which is 1 at first.
  /// Throws Error bad_argument unless the factors are finite, positive and equal to within a relative 1e-5.
  /// It also throws from btCompoundShape::setLocalScaling, which has scaled the children before it by then.
  void setLocalScaling(const btVector3& scaling) override;
  /// Returns the scaling: the same factor on each axis.
  const btVector3& getLocalScaling() const override;
  /// Gives the exact moments of a homogeneous body of this mass [kg m^2] about the axes of the shape's frame,
  /// through its origin. In the principal frame they are the principal moments. In another frame they are the
  /// diagonal of the inertia tensor, and Bullet takes the rest of it for zero: right for turning about one of
  /// the axes, or where the body's symmetry makes the axes principal; else use the principal frame.
  void calculateLocalInertia(btScalar mass, btVector3& inertia) const override;
  /// Returns the name of this kind of shape, "InnerSpherePacking".
  const char* getName() const override;
  /// Returns how many bytes serialize() writes to its buffer. A packing is saved as a btCompoundShape of
  /// spheres, sphereCount() of them, which any Bullet can load; their radii include the margin.
  int calculateSerializeBufferSize() const override;
  /// Writes the compound of spheres to `buffer` and returns the name of Bullet's structure for it.
  const char* serialize(void* buffer, btSerializer* serializer) const override;
  // As btConcaveShape:

  /// Calls `callback` with the triangles of the solid's surface near a box in the shape's frame, for rays,
  /// sweeps, debug drawing and soft bodies. There are none if the packing has no surface: such a body
  /// collides, but rays pass through it. Rays of Bullet's that start inside the solid do not meet the side by
  /// which they leave.
  void processAllTriangles(btTriangleCallback* callback, const btVector3& min,
                           const btVector3& max) const override;

  struct Impl;
  /// Returns what is private to the plug-in.
  const Impl& impl() const { return *impl_; }

 private:
  void noteChange();

  std::unique_ptr<Impl> impl_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
