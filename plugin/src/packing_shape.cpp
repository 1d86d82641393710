#include "innersphere/packing_shape.hpp"

#include <algorithm>
#include <cmath>

#include <BulletCollision/CollisionShapes/btTriangleCallback.h>
#include <LinearMath/btAabbUtil2.h>

#include "innersphere/error.hpp"
#include "packing_shape_impl.hpp"
#include "vec.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Hands triangles on in the shape's frame.
struct ToShapeFrame : btTriangleCallback {
  void processTriangle(btVector3* triangle, int part, int index) override {
    btVector3 moved[3];
    for (int i = 0; i < 3; ++i) moved[i] = from_packing(triangle[i]) * scale;
    user->processTriangle(moved, part, index);
  }
  btTransform from_packing;
  btScalar scale = 1;
  btTriangleCallback* user = nullptr;
};

/// The largest distance from the surface to the nearest sphere, at most so many places of it looked at.
btScalar measureRecess(const Packing& packing) {
  constexpr std::size_t kPlaces = 1000;
  const Surface& surface = packing.surface;
  const std::size_t stride = surface.triangles.size() / kPlaces + 1;
  btScalar recess = 0;
  const auto look = [&](const btVector3& p) {
    btScalar gap = BT_LARGE_FLOAT;
    for (const Sphere& s : packing.spheres) gap = btMin(gap, p.distance(centre(s)) - btScalar(s.radius));
    recess = btMax(recess, gap);
  };
  for (std::size_t t = 0; t < surface.triangles.size(); t += stride) {
    btVector3 corners[3];
    for (int k = 0; k < 3; ++k) corners[k] = toBullet(surface.vertices[surface.triangles[t][k]]);
    look(corners[0]);
    look((corners[0] + corners[1] + corners[2]) / 3);
  }
  return recess;
}

}  // namespace

PackingShape::Impl::Impl(std::shared_ptr<const CollisionModel> collision_model)
    : model(std::move(collision_model)) {
  if (!model) {
    throw Error(ErrorCode::bad_argument, "PackingShape needs a CollisionModel; it was given a null pointer.");
  }
  frame = principalFrame(packing());

  box_min.setValue(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  box_max = -box_min;
  for (const auto& vertex : packing().surface.vertices) {
    const btVector3 v = frame.from_packing(toBullet(vertex));
    box_min.setMin(v);
    box_max.setMax(v);
  }
  const std::vector<Sphere>& spheres = packing().spheres;
  const VolumeTrueRadii* stored = volumeTrueRadii(packing(), spheres.size());
  if (stored != nullptr && stored->count == spheres.size()) volume_true = stored->radii.data();
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (volume_true != nullptr)
      largest_bulge = btMax(largest_bulge, btScalar(volume_true[i] - spheres[i].radius));
  }
  // Without a surface the volume-true spheres are what collides.
  const btScalar bulge = hasSurface() ? btScalar(0) : largest_bulge;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const btVector3 c = frame.from_packing(centre(spheres[i]));
    const btScalar r = btScalar(spheres[i].radius) + bulge;
    box_min.setMin(c - btVector3(r, r, r));
    box_max.setMax(c + btVector3(r, r, r));
  }

  sphere_centre = (box_min + box_max) / 2;
  for (const auto& vertex : packing().surface.vertices) {
    sphere_radius = btMax(sphere_radius, sphere_centre.distance(frame.from_packing(toBullet(vertex))));
  }
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const btVector3 c = frame.from_packing(centre(spheres[i]));
    sphere_radius = btMax(sphere_radius, sphere_centre.distance(c) + btScalar(spheres[i].radius) + bulge);
  }
  median_radius = btScalar(spheres[spheres.size() / 2].radius);
}

const SphereTree& PackingShape::Impl::sphereTree() const {
  return sphere_tree_.get([this] { return std::make_unique<SphereTree>(packing().spheres); });
}

const SurfaceTree& PackingShape::Impl::surfaceTree() const {
  return surface_tree_.get([this] { return std::make_unique<SurfaceTree>(packing().surface); });
}

const NearestTriangle& PackingShape::Impl::nearestTriangle() const {
  return nearest_triangle_.get([this] { return std::make_unique<NearestTriangle>(packing().surface); });
}

const VertexClimb& PackingShape::Impl::vertexClimb() const {
  return vertex_climb_.get([this] { return std::make_unique<VertexClimb>(packing().surface); });
}

btScalar PackingShape::Impl::recess() const {
  if (packing().quality.gap_max > 0) return btScalar(packing().quality.gap_max);
  return recess_.get([this] { return std::make_unique<btScalar>(measureRecess(packing())); });
}

btTransform PackingShape::Impl::toWorld(const btTransform& body) const {
  const btTransform& local = frame.from_packing;
  return body * btTransform(local.getBasis(), local.getOrigin() * scaling.x());
}

PackingShape::PackingShape(std::shared_ptr<const CollisionModel> model)
    : impl_(std::make_unique<Impl>(std::move(model))) {
  m_shapeType = kPackingShapeType;
}

PackingShape::~PackingShape() = default;

const CollisionModel& PackingShape::model() const {
  return *impl_->model;
}

const btTransform& PackingShape::principalTransform() const {
  return impl_->frame.from_packing;
}

const PackingShape* PackingShape::from(const btCollisionShape* shape) {
  if (shape == nullptr || shape->getShapeType() != kPackingShapeType) return nullptr;
  return dynamic_cast<const PackingShape*>(shape);
}

void PackingShape::getAabb(const btTransform& t, btVector3& min, btVector3& max) const {
  const btScalar scale = impl_->scaling.x();
  btTransformAabb(impl_->box_min * scale, impl_->box_max * scale, getMargin(), t, min, max);
}

void PackingShape::getBoundingSphere(btVector3& centre, btScalar& radius) const {
  centre = impl_->sphere_centre * impl_->scaling.x();
  radius = impl_->sphere_radius * impl_->scaling.x() + getMargin();
}

btScalar PackingShape::getAngularMotionDisc() const {
  return (impl_->sphere_radius + impl_->sphere_centre.length()) * impl_->scaling.x() + getMargin();
}

btScalar PackingShape::getContactBreakingThreshold(btScalar factor) const {
  // Bullet merges contact points closer than this: fine features must stay apart in large solids.
  return btMin(getAngularMotionDisc() * factor, impl_->median_radius * impl_->scaling.x());
}

void PackingShape::setLocalScaling(const btVector3& scaling) {
  const btScalar tolerance = btScalar(1e-5) * scaling.x();
  const bool uniform = isFinite(scaling) && scaling.x() > 0 &&
                       btFabs(scaling.y() - scaling.x()) <= tolerance &&
                       btFabs(scaling.z() - scaling.x()) <= tolerance;
  if (!uniform) {
    throw Error(ErrorCode::bad_argument,
                "PackingShape can only be scaled by the same positive factor on every axis; pack a stretched "
                "mesh instead.");
  }
  impl_->scaling = scaling;
}

const btVector3& PackingShape::getLocalScaling() const {
  return impl_->scaling;
}

void PackingShape::calculateLocalInertia(btScalar mass, btVector3& inertia) const {
  const btScalar scale = impl_->scaling.x();
  inertia = impl_->frame.moments * (mass * scale * scale);
}

const char* PackingShape::getName() const {
  return "InnerSpherePacking";
}

void PackingShape::processAllTriangles(btTriangleCallback* callback, const btVector3& min,
                                       const btVector3& max) const {
  if (!impl_->hasSurface()) return;
  ToShapeFrame to_shape;
  to_shape.from_packing = impl_->frame.from_packing;
  to_shape.scale = impl_->scaling.x();
  to_shape.user = callback;
  btVector3 packing_min, packing_max;
  btTransformAabb(min / to_shape.scale, max / to_shape.scale, 0, to_shape.from_packing.inverse(), packing_min,
                  packing_max);
  impl_->surfaceTree().processTriangles(&to_shape, packing_min, packing_max);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
