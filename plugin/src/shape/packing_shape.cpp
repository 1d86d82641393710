#include "innersphere/packing_shape.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include <BulletCollision/CollisionShapes/btTriangleCallback.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <LinearMath/btAabbUtil2.h>

#include "common/bullet_vectors.hpp"
#include "innersphere/error.hpp"
#include "shape/option_rules.hpp"
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

std::shared_ptr<const PackedModel> solidOf(std::shared_ptr<const CollisionModel> model) {
  if (!model) {
    throw Error(ErrorCode::bad_argument, "PackingShape needs a CollisionModel; it was given a null pointer.");
  }
  return PackedModel::of(std::move(model));
}

const btTransform& checkedFrame(const btTransform& mesh_to_body) {
  if (!isFinite(mesh_to_body)) {
    throw Error(ErrorCode::not_finite, "The frame of a PackingShape has a number in it that is not finite.");
  }
  constexpr btScalar kTolerance = btScalar(1e-3);
  const btMatrix3x3& axes = mesh_to_body.getBasis();
  const btMatrix3x3 product = axes * axes.transpose();
  bool rotation = axes.determinant() > 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rotation = rotation && btFabs(product[i][j] - (i == j)) < kTolerance;
  }
  if (!rotation) {
    throw Error(
        ErrorCode::bad_argument,
        "The frame of a PackingShape must be turned and moved only; scale it with setLocalScaling().");
  }
  return mesh_to_body;
}

btTransform translation(const btVector3& by) {
  return btTransform(btMatrix3x3::getIdentity(), by);
}

}  // namespace

PackingShape::Impl::Impl(std::shared_ptr<const PackedModel> packed_solid)
    : solid(std::move(packed_solid)),
      frame(solid->in_principal),
      from_principal(btTransform::getIdentity()),
      prefix(&solid->prefix(packing().spheres.size())) {
  prefix->warnOnce();
}

PackingShape::Impl::Impl(std::shared_ptr<const PackedModel> packed_solid, const btTransform& mesh_to_body)
    : solid(std::move(packed_solid)),
      frame(packing(), mesh_to_body * translation(toBullet(packing().origin))),
      from_principal(frame.from_packing * solid->principal.from_packing.inverse()),
      prefix(&solid->prefix(packing().spheres.size())) {
  prefix->warnOnce();
}

btTransform PackingShape::Impl::toWorld(const btTransform& body) const {
  const btTransform& local = frame.from_packing;
  return body * btTransform(local.getBasis(), local.getOrigin() * scaling.x());
}

btVector3 PackingShape::Impl::moments() const {
  const btVector3& centre_of_mass = from_principal.getOrigin();
  btVector3 moments;
  for (int i = 0; i < 3; ++i) {
    const btVector3& axis = from_principal.getBasis()[i];
    const btScalar from_axis2 = centre_of_mass.length2() - centre_of_mass[i] * centre_of_mass[i];
    moments[i] = (axis * axis).dot(solid->principal.moments) + from_axis2;
  }
  return moments;
}

PackingShape::PackingShape(std::shared_ptr<const CollisionModel> model, Frame frame)
    : impl_(frame == Frame::principal
                ? std::make_unique<Impl>(solidOf(std::move(model)))
                : std::make_unique<Impl>(solidOf(std::move(model)), btTransform::getIdentity())) {
  m_shapeType = kPackingShapeType;
  noteChange();
}

PackingShape::PackingShape(std::shared_ptr<const CollisionModel> model, const btTransform& mesh_to_body)
    : impl_(std::make_unique<Impl>(solidOf(std::move(model)), checkedFrame(mesh_to_body))) {
  m_shapeType = kPackingShapeType;
  noteChange();
}

PackingShape::~PackingShape() = default;

const CollisionModel& PackingShape::model() const {
  return *impl_->solid->model;
}

btTransform PackingShape::meshToBody() const {
  const btTransform local = impl_->frame.from_packing * translation(-toBullet(impl_->packing().origin));
  return btTransform(local.getBasis(), local.getOrigin() * impl_->scaling.x());
}

btTransform PackingShape::bodyTransform(const btTransform& mesh) const {
  return mesh * meshToBody().inverse();
}

btTransform PackingShape::meshTransform(const btTransform& body) const {
  return body * meshToBody();
}

const btTransform& PackingShape::principalTransform() const {
  return impl_->solid->principal.from_packing;
}

const PackingShape* PackingShape::from(const btCollisionShape* shape) {
  if (shape == nullptr || shape->getShapeType() != kPackingShapeType) return nullptr;
  return dynamic_cast<const PackingShape*>(shape);
}

void PackingShape::setSphereCount(std::size_t count) {
  const std::size_t all = impl_->packing().spheres.size();
  impl_->prefix = &impl_->solid->prefix(count == 0 ? all : std::min(count, all));
  impl_->prefix->warnOnce();
  noteChange();
}

std::size_t PackingShape::sphereCount() const {
  return impl_->prefix->count;
}

void PackingShape::setContactOptions(const ContactOptions& options) {
  checkOptions(options);
  impl_->options = options;
  noteChange();
}

void PackingShape::resetContactOptions() {
  impl_->options.reset();
  noteChange();
}

const ContactOptions* PackingShape::contactOptions() const {
  return impl_->options ? &*impl_->options : nullptr;
}

void PackingShape::getAabb(const btTransform& t, btVector3& min, btVector3& max) const {
  noticeBox();
  const btScalar scale = impl_->scaling.x(), margin = impl_->overshoot() * scale + getMargin();
  btTransformAabb(impl_->frame.box_min * scale, impl_->frame.box_max * scale, margin, t, min, max);
  const SupportBounds& bounds = impl_->solid->bounds();
  const btVector3 origin = t(impl_->from_principal.getOrigin() * scale);
  const btMatrix3x3 axes = t.getBasis() * impl_->from_principal.getBasis();
  for (int i = 0; i < 3; ++i) {
    min[i] = btMax(min[i], origin[i] - bounds.along(-axes[i]) * scale - margin);
    max[i] = btMin(max[i], origin[i] + bounds.along(axes[i]) * scale + margin);
  }
}

void PackingShape::getBoundingSphere(btVector3& centre, btScalar& radius) const {
  centre = impl_->frame.sphere_centre * impl_->scaling.x();
  radius = (impl_->frame.sphere_radius + impl_->overshoot()) * impl_->scaling.x() + getMargin();
}

btScalar PackingShape::getAngularMotionDisc() const {
  return impl_->disc;
}

void PackingShape::setMargin(btScalar margin) {
  if (!(margin >= 0) || !std::isfinite(margin)) {
    throw Error(ErrorCode::bad_argument,
                "The margin of a PackingShape is " + std::to_string(margin) +
                    "; it must be finite and not negative. For a smaller solid scale it or pack another.");
  }
  btConcaveShape::setMargin(margin);
  noteChange();
}

void PackingShape::noteChange() {
  static std::atomic<std::uint64_t> changes{0};
  impl_->version = ++changes;
  btVector3 centre;
  btScalar radius;
  PackingShape::getBoundingSphere(centre, radius);
  impl_->disc = radius + centre.length();
  const ShapeFrame& frame = impl_->solid->in_principal;
  const btScalar scale = impl_->scaling.x();
  impl_->size = (frame.sphere_radius + impl_->overshoot()) * scale + getMargin() +
                (frame.sphere_centre * scale).length();
}

btScalar PackingShape::getContactBreakingThreshold(btScalar factor) const {
  // Bullet merges contact points closer than this: fine features must stay apart in large solids.
  return btMin(impl_->size * factor, impl_->prefix->median_radius * impl_->scaling.x());
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
  inertia = impl_->moments() * (mass * scale * scale);
}

const char* PackingShape::getName() const {
  return "InnerSpherePacking";
}

void PackingShape::processAllTriangles(btTriangleCallback* callback, const btVector3& min,
                                       const btVector3& max) const {
  impl_->check.noticeTriangles(*callback, impl_->packing().provenance.source);
  if (!impl_->hasSurface()) return;
  // A ray that starts inside goes out, as of Bullet's convex shapes: that of a wheel would stand on its car.
  if (auto* const ray = dynamic_cast<btTriangleRaycastCallback*>(callback))
    ray->m_flags |= btTriangleRaycastCallback::kF_FilterBackfaces;
  ToShapeFrame to_shape;
  to_shape.from_packing = impl_->frame.from_packing;
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
