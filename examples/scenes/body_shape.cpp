#include "body_shape.hpp"

#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>

#include "bullet_math.hpp"
#include "convex_parts.hpp"
#include "scaled_solid.hpp"

namespace innersphere::demo {
namespace {

// Margins relative to the diagonal: Bullet's own 0.04 m is far too much for bodies of this size. Triangles
// grow by theirs, and chains and bowls of them come out best with as little as this; hulls are made smaller
// first.
constexpr double kTriangleMargin = 1e-4;
constexpr double kHullMargin = 1e-3;

void addFaces(const btConvexHullComputer& hull, Surface& surface) {
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (int i = 0; i < hull.vertices.size(); ++i) {
    const btVector3& v = hull.vertices[i];
    surface.vertices.push_back(
        {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())});
  }
  for (int i = 0; i < hull.faces.size(); ++i) {
    const btConvexHullComputer::Edge* edge = &hull.edges[hull.faces[i]];
    const auto corner = [&](int vertex) { return first + static_cast<std::uint32_t>(vertex); };
    const int start = edge->getSourceVertex();
    for (edge = edge->getNextEdgeOfFace(); edge->getTargetVertex() != start;
         edge = edge->getNextEdgeOfFace()) {
      surface.triangles.push_back(
          {corner(start), corner(edge->getSourceVertex()), corner(edge->getTargetVertex())});
    }
  }
}

}  // namespace

BulletShape::BulletShape(const BodyOptions& options, const Solid& solid, const Packing& packing,
                         std::size_t spheres, const btTransform& to_body) {
  const double size = diagonalOf(solid.bounds());
  if (options.shape == BodyShape::gimpact) {
    addTriangles(packing, to_body, btScalar(kTriangleMargin * size));
  } else if (options.shape == BodyShape::spheres) {
    addSpheres(packing, spheres, to_body);
  } else {
    addHulls(solid, packing.origin, options.concavity * size, to_body, btScalar(kHullMargin * size));
  }
}

BulletShape::~BulletShape() = default;

void BulletShape::addTriangles(const Packing& packing, const btTransform& to_body, btScalar margin) {
  const auto corner = [&](std::uint32_t index) {
    const auto& v = packing.surface.vertices[index];
    return to_body * vec(v[0], v[1], v[2]);
  };
  for (const auto& t : packing.surface.triangles) mesh_.addTriangle(corner(t[0]), corner(t[1]), corner(t[2]));
  auto shape = std::make_unique<btGImpactMeshShape>(&mesh_);
  shape->setMargin(margin);
  shape->updateBound();
  shape_ = std::move(shape);
  parts_ = packing.surface.triangles.size();
}

void BulletShape::addSpheres(const Packing& packing, std::size_t spheres, const btTransform& to_body) {
  auto compound = std::make_unique<btCompoundShape>();
  parts_ = std::min(spheres, packing.spheres.size());
  for (std::size_t i = 0; i < parts_; ++i) {
    const Sphere& s = packing.spheres[i];
    children_.push_back(std::make_unique<btSphereShape>(btScalar(s.radius)));
    compound->addChildShape(btTransform(btQuaternion::getIdentity(), to_body * vec(s.x, s.y, s.z)),
                            children_.back().get());
  }
  shape_ = std::move(compound);
}

void BulletShape::addHulls(const Solid& solid, const Vec3d& from, double concavity,
                           const btTransform& to_body, btScalar margin) {
  auto compound = std::make_unique<btCompoundShape>();
  for (const std::vector<Vec3d>& part : convexParts(solid, concavity)) {
    std::vector<btVector3> points;
    for (const Vec3d& p : part)
      points.push_back(to_body * vec(p[0] - from[0], p[1] - from[1], p[2] - from[2]));
    btConvexHullComputer hull;
    const btScalar shrunk = hull.compute(&points[0][0], sizeof(btVector3), static_cast<int>(points.size()),
                                         margin, btScalar(0.5));
    if (hull.faces.size() == 0) continue;  // flat
    children_.push_back(std::make_unique<btConvexHullShape>(&hull.vertices[0][0], hull.vertices.size()));
    children_.back()->setMargin(shrunk);
    compound->addChildShape(btTransform::getIdentity(), children_.back().get());
    addFaces(hull, hulls_);
  }
  parts_ = children_.size();
  shape_ = std::move(compound);
}

}  // namespace innersphere::demo
