// A cube of 1 m about the origin, as one of Bullet's shapes or a packing.
#pragma once

#include <memory>
#include <string>

#include <btBulletDynamicsCommon.h>

#include "innersphere/packing.hpp"

namespace innersphere::test {

/// Each triangle in four.
Surface cut(const Surface& surface);

/// With what the shape refers to.
class BulletCube {
 public:
  /// packing, box, hull, mesh, cut_mesh (of 192 triangles), or inside_out_mesh.
  explicit BulletCube(const std::string& kind);

  std::shared_ptr<btCollisionShape> shape;

 private:
  btTriangleMesh mesh_;
};

}  // namespace innersphere::test
