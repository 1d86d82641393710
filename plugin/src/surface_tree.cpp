#include "surface_tree.hpp"

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>

#include "vec.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Quantised nodes keep the triangle's number in 21 bits.
constexpr std::size_t kMaxQuantizedTriangles = std::size_t(1) << 21;
/// Rays that are flatter to a triangle meet it itself, not the curved surface that it stands for.
constexpr btScalar kGrazing = btScalar(0.1);

struct NearestHit : btTriangleRaycastCallback {
  NearestHit(const btVector3& from, const btVector3& to)
      : btTriangleRaycastCallback(from, to, kF_KeepUnflippedNormal) {}
  btScalar reportHit(const btVector3& normal, btScalar fraction, int, int index) override {
    triangle = index;
    face = normal;
    return fraction;
  }
  int triangle = -1;
  btVector3 face{0, 0, 0};
};

}  // namespace

SurfaceTree::SurfaceTree(const Surface& surface)
    : surface_(surface), triangles_(std::make_unique<btTriangleIndexVertexArray>()) {
  btIndexedMesh mesh;
  mesh.m_numTriangles = static_cast<int>(surface.triangles.size());
  mesh.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(surface.triangles.data());
  mesh.m_triangleIndexStride = sizeof(surface.triangles[0]);
  mesh.m_numVertices = static_cast<int>(surface.vertices.size());
  mesh.m_vertexBase = reinterpret_cast<const unsigned char*>(surface.vertices.data());
  mesh.m_vertexStride = sizeof(surface.vertices[0]);
  mesh.m_vertexType = PHY_FLOAT;
  triangles_->addIndexedMesh(mesh, PHY_INTEGER);
  tree_ = std::make_unique<btBvhTriangleMeshShape>(triangles_.get(),
                                                   surface.triangles.size() < kMaxQuantizedTriangles);
}

SurfaceTree::~SurfaceTree() = default;

void SurfaceTree::processTriangles(btTriangleCallback* callback, const btVector3& min,
                                   const btVector3& max) const {
  tree_->processAllTriangles(callback, min, max);
}

bool SurfaceTree::cast(const btVector3& from, const btVector3& direction, btScalar length, Hit& hit) const {
  NearestHit nearest(from, from + direction * length);
  tree_->performRaycast(&nearest, nearest.m_from, nearest.m_to);
  if (nearest.triangle < 0) return false;
  hit.triangle = static_cast<std::size_t>(nearest.triangle);
  hit.distance = nearest.m_hitFraction * length;
  hit.face = nearest.face.normalized();
  complete(from, direction, hit);
  return true;
}

bool SurfaceTree::castAt(std::size_t triangle, const btVector3& from, const btVector3& direction,
                         btScalar length, Hit& hit) const {
  btVector3 v[3];
  for (int k = 0; k < 3; ++k) v[k] = toBullet(surface_.vertices[surface_.triangles[triangle][k]]) - from;
  const btVector3 normal = (v[1] - v[0]).cross(v[2] - v[0]);
  const btScalar along = normal.dot(direction), height = normal.dot(v[0]);
  if (!(btFabs(height) < length * btFabs(along))) return false;
  hit.distance = height / along;
  const btVector3 at = direction * hit.distance;
  for (int k = 0; k < 3; ++k) {
    const btVector3& corner = v[k];
    if ((v[(k + 1) % 3] - corner).cross(at - corner).dot(normal) < 0) return false;
  }
  hit.triangle = triangle;
  hit.face = normal.normalized();
  complete(from, direction, hit);
  return true;
}

btScalar SurfaceTree::untilSharpEdge(std::size_t triangle, const btVector3& point, const btVector3& towards,
                                     btScalar farthest) const {
  return normals().untilSharpEdge(triangle, point, towards, farthest);
}

const SmoothNormals& SurfaceTree::normals() const {
  return normals_.get([this] { return std::make_unique<SmoothNormals>(surface_); });
}

/// What the curved surface is like where its triangle is hit.
void SurfaceTree::complete(const btVector3& from, const btVector3& direction, Hit& hit) const {
  const SmoothNormals& normals = this->normals();
  hit.curvature = normals.curvature(hit.triangle);
  const btVector3 at = from + direction * hit.distance;
  const SmoothNormals::Place place = normals.at(hit.triangle, at);
  hit.normal = place.normal;
  const btScalar facing = hit.face.dot(direction);
  if (!(btFabs(facing) > kGrazing)) return;
  // Past an edge it is another face that ends the solid, and sooner.
  const btScalar further = place.bulge / facing;
  if (place.bulge > 0 && normals.isPastSharpEdge(hit.triangle, at + direction * further)) return;
  hit.distance += further;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
