// How the bodies of scenes collide: as packings, or in one of Bullet's own ways, to compare with.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "innersphere/packing.hpp"
#include "innersphere/progress.hpp"
#include "innersphere/solid.hpp"

namespace innersphere::demo {

enum class BodyShape {
  packing,  ///< PackingShape
  gimpact,  ///< btGImpactMeshShape of the solid's surface
  spheres,  ///< btCompoundShape of the packing's spheres
  convex    ///< btCompoundShape of convex hulls, see convexParts()
};

struct BodyOptions {
  BodyShape shape = BodyShape::packing;
  /// BodyShape::convex: how far hulls may leave the solid, relative to the diagonal of its bounding box.
  double concavity = 0.003;
  /// What the spheres of the packings are chosen for, where `packing` is empty.
  SphereOrder order = SphereOrder::radius;
  /// To get packings elsewhere, for programs that run scenes again and again; empty: pack(). May give more
  /// spheres than are asked for, of which the first ones are used.
  std::function<std::shared_ptr<const Packing>(const Solid& solid, std::size_t spheres, const Progress&)>
      packing;
};

/// One of Bullet's own shapes for a solid, and what it is made of.
class BulletShape {
 public:
  /// `shape` is not BodyShape::packing. `to_body` takes the packing's frame to the body's.
  BulletShape(const BodyOptions& options, const Solid& solid, const Packing& packing, std::size_t spheres,
              const btTransform& to_body);
  ~BulletShape();

  btCollisionShape& shape() { return *shape_; }
  /// Triangles, spheres or hulls.
  std::size_t parts() const { return parts_; }
  /// Of the hulls, in the frame of the body; otherwise empty.
  const Surface& hulls() const { return hulls_; }

 private:
  void addTriangles(const Packing& packing, const btTransform& to_body, btScalar margin);
  void addSpheres(const Packing& packing, std::size_t spheres, const btTransform& to_body);
  void addHulls(const Solid& solid, const Vec3d& from, double concavity, const btTransform& to_body,
                btScalar margin);

  std::size_t parts_ = 0;
  btTriangleMesh mesh_;
  std::vector<std::unique_ptr<btCollisionShape>> children_;
  std::unique_ptr<btCollisionShape> shape_;
  Surface hulls_;
};

}  // namespace innersphere::demo
