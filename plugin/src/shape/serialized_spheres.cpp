#include "shape/serialized_spheres.hpp"

#include "common/bullet_vectors.hpp"
#include "shape/packing_shape_impl.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

const char* SerializedSpheres::write(const PackingShape& shape, void* buffer, btSerializer* serializer) {
  const PackingShape::Impl& impl = shape.impl();
  const btScalar scale = impl.scaling.x();
  compound_ = std::make_unique<btCompoundShape>(false, static_cast<int>(impl.prefix->count));
  spheres_.clear();
  for (std::size_t i = 0; i < impl.prefix->count; ++i) {
    const Sphere& s = impl.packing().spheres[i];
    spheres_.push_back(std::make_unique<btSphereShape>(btScalar(s.radius) * scale + shape.getMargin()));
    const btVector3 c = impl.frame.from_packing(centre(s)) * scale;
    compound_->addChildShape(btTransform(btQuaternion::getIdentity(), c), spheres_.back().get());
  }
  const char* const type = compound_->serialize(buffer, serializer);
  // The name is that of our shape, not of the compound.
  btCollisionShapeData& head = static_cast<btCompoundShapeData*>(buffer)->m_collisionShapeData;
  shape.btCollisionShape::serialize(&head, serializer);
  head.m_shapeType = COMPOUND_SHAPE_PROXYTYPE;
  return type;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
