// Writes a packing to a .bullet file.
#pragma once

#include <memory>
#include <vector>

#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include "innersphere/packing_shape.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds the spheres that are written. Bullet's importer knows only its own shapes, so that a packing is
/// written as a compound of spheres. The serialiser tells shapes apart by their addresses: the spheres must
/// stay until it is done, and so they do until the packing's shape goes or is written again.
class SerializedSpheres {
 public:
  /// Returns the size of what write() fills [bytes].
  static int bufferSize() { return sizeof(btCompoundShapeData); }
  /// Fills a btCompoundShapeData and returns its name.
  const char* write(const PackingShape& shape, void* buffer, btSerializer* serializer);

 private:
  std::vector<std::unique_ptr<btSphereShape>> spheres_;
  std::unique_ptr<btCompoundShape> compound_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
