#include "innersphere/packing_shape.hpp"

#include <algorithm>
#include <cmath>
#include <typeinfo>

#include <BulletCollision/CollisionShapes/btTriangleCallback.h>
#include <LinearMath/btAabbUtil2.h>

#include "common/bullet_vectors.hpp"
#include "innersphere/error.hpp"
#include "shape/packing_shape_impl.hpp"

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

}  // namespace

PackingShape::Impl::Impl(std::shared_ptr<const CollisionModel> model) {
  if (!model) {
    throw Error(ErrorCode::bad_argument, "PackingShape needs a CollisionModel; it was given a null pointer.");
  }
  solid = PackedModel::of(std::move(model));
  prefix = &solid->prefix(packing().spheres.size());
}

btTransform PackingShape::Impl::toWorld(const btTransform& body) const {
  const btTransform& local = solid->frame.from_packing;
  return body * btTransform(local.getBasis(), local.getOrigin() * scaling.x());
}

PackingShape::PackingShape(std::shared_ptr<const CollisionModel> model)
    : impl_(std::make_unique<Impl>(std::move(model))) {
  m_shapeType = kPackingShapeType;
  noteChange();
}

PackingShape::~PackingShape() = default;

const CollisionModel& PackingShape::model() const {
  return *impl_->solid->model;
}

const btTransform& PackingShape::principalTransform() const {
  return impl_->solid->frame.from_packing;
}

const PackingShape* PackingShape::from(const btCollisionShape* shape) {
  if (shape == nullptr || shape->getShapeType() != kPackingShapeType) return nullptr;
  if (typeid(*shape) == typeid(PackingShape)) return static_cast<const PackingShape*>(shape);
  return dynamic_cast<const PackingShape*>(shape);
}

void PackingShape::setSphereCount(std::size_t count) {
  const std::size_t all = impl_->packing().spheres.size();
  impl_->prefix = &impl_->solid->prefix(count == 0 ? all : std::min(count, all));
  noteChange();
}

std::size_t PackingShape::sphereCount() const {
  return impl_->prefix->count;
}

void PackingShape::getAabb(const btTransform& t, btVector3& min, btVector3& max) const {
  impl_->watch.notice(t, impl_->disc);
  const btScalar scale = impl_->scaling.x();
  btTransformAabb(impl_->solid->box_min * scale, impl_->solid->box_max * scale,
                  impl_->overshoot() * scale + getMargin(), t, min, max);
}

void PackingShape::getBoundingSphere(btVector3& centre, btScalar& radius) const {
  centre = impl_->solid->sphere_centre * impl_->scaling.x();
  radius = (impl_->solid->sphere_radius + impl_->overshoot()) * impl_->scaling.x() + getMargin();
}

btScalar PackingShape::getAngularMotionDisc() const {
  return impl_->disc;
}

void PackingShape::setMargin(btScalar margin) {
  btConcaveShape::setMargin(margin);
  noteChange();
}

void PackingShape::noteChange() {
  btVector3 centre;
  btScalar radius;
  PackingShape::getBoundingSphere(centre, radius);
  impl_->disc = radius + centre.length();
  ++impl_->version;
}

btScalar PackingShape::getContactBreakingThreshold(btScalar factor) const {
  // Bullet merges contact points closer than this: fine features must stay apart in large solids.
  return btMin(getAngularMotionDisc() * factor, impl_->prefix->median_radius * impl_->scaling.x());
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
  noteChange();
}

const btVector3& PackingShape::getLocalScaling() const {
  return impl_->scaling;
}

void PackingShape::calculateLocalInertia(btScalar mass, btVector3& inertia) const {
  const btScalar scale = impl_->scaling.x();
  inertia = impl_->solid->frame.moments * (mass * scale * scale);
}

const char* PackingShape::getName() const {
  return "InnerSpherePacking";
}

void PackingShape::processAllTriangles(btTriangleCallback* callback, const btVector3& min,
                                       const btVector3& max) const {
  if (!impl_->hasSurface()) return;
  ToShapeFrame to_shape;
  to_shape.from_packing = impl_->solid->frame.from_packing;
  to_shape.scale = impl_->scaling.x();
  to_shape.user = callback;
  btVector3 packing_min, packing_max;
  btTransformAabb(min / to_shape.scale, max / to_shape.scale, 0, to_shape.from_packing.inverse(), packing_min,
                  packing_max);
  impl_->surfaceQueries().processTriangles(&to_shape, packing_min, packing_max);
}

int PackingShape::calculateSerializeBufferSize() const {
  return impl_->serialized.bufferSize();
}

const char* PackingShape::serialize(void* buffer, btSerializer* serializer) const {
  return impl_->serialized.write(*this, buffer, serializer);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
