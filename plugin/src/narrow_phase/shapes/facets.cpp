#include "narrow_phase/shapes/facets.hpp"

#include <algorithm>

#include <BulletCollision/CollisionShapes/btTriangleCallback.h>
#include <LinearMath/btConvexHullComputer.h>

#include "common/bullet_vectors.hpp"
#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// In diagonals: a hull whose middle is less deep in it is flat.
constexpr btScalar kFlat = btScalar(1e-4);
/// Cosine, 0.05 degrees: a place that is seen from further aside lies on an edge.
constexpr btScalar kOverFace = btScalar(1 - 4e-7);
/// In lengths of the edge: a place this near to its end is at the corner.
constexpr btScalar kAtCorner = btScalar(1e-3);

class CornerCollector : public btTriangleCallback {
 public:
  explicit CornerCollector(std::vector<btVector3>& corners) : corners_(corners) {}
  void processTriangle(btVector3* triangle, int, int) override {
    if (isFinite(triangle[0]) && isFinite(triangle[1]) && isFinite(triangle[2]))
      corners_.insert(corners_.end(), triangle, triangle + 3);
  }

 private:
  std::vector<btVector3>& corners_;
};

/// Direction of the edge of a triangle that a place of its rim is on; 0 at a corner.
btVector3 edgeAt(const btVector3* corners, const btVector3& place) {
  btVector3 along(0, 0, 0);
  btScalar least = BT_LARGE_FLOAT;
  for (int k = 0; k < 3; ++k) {
    const btVector3 way = corners[(k + 1) % 3] - corners[k], to_place = place - corners[k];
    if (to_place.length2() < kAtCorner * kAtCorner * way.length2()) return {0, 0, 0};
    const btScalar beside = way.cross(to_place).length2() / way.length2();
    if (beside < least) {
      least = beside;
      along = way.normalized();
    }
  }
  return along;
}

using Triangle = std::array<std::uint32_t, 3>;

/// Triangles share a vertex if it is at the same place.
Surface weld(const std::vector<btVector3>& corners) {
  Surface surface;
  std::vector<std::pair<std::array<float, 3>, std::uint32_t>> sorted;
  sorted.reserve(corners.size());
  for (const btVector3& corner : corners)
    sorted.emplace_back(toFloats(corner - corners[0]), static_cast<std::uint32_t>(sorted.size()));
  std::sort(sorted.begin(), sorted.end());
  surface.triangles.resize(corners.size() / 3);
  for (const auto& [place, i] : sorted) {
    if (surface.vertices.empty() || surface.vertices.back() != place) surface.vertices.push_back(place);
    surface.triangles[i / 3][i % 3] = static_cast<std::uint32_t>(surface.vertices.size() - 1);
  }
  // A sheet with triangles on both sides has no edge between them.
  const auto corners_of = [](Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  std::sort(surface.triangles.begin(), surface.triangles.end(),
            [&](const Triangle& a, const Triangle& b) { return corners_of(a) < corners_of(b); });
  surface.triangles.erase(
      std::unique(surface.triangles.begin(), surface.triangles.end(),
                  [&](const Triangle& a, const Triangle& b) { return corners_of(a) == corners_of(b); }),
      surface.triangles.end());
  return surface;
}

Surface hullOf(const std::vector<btVector3>& points) {
  Surface surface;
  if (points.empty() ||
      !std::all_of(points.begin(), points.end(), [](const btVector3& p) { return isFinite(p); }))
    return surface;
  for (const btVector3& point : points) surface.vertices.push_back(toFloats(point - points[0]));
  btConvexHullComputer hull;
  hull.compute(&points[0][0], sizeof(btVector3), static_cast<int>(points.size()), 0, 0);
  // Its own vertices are rounded.
  const auto index = [&](int vertex) {
    return static_cast<std::uint32_t>(hull.original_vertex_index[vertex]);
  };
  for (int f = 0; f < hull.faces.size(); ++f) {
    const btConvexHullComputer::Edge* edge = &hull.edges[hull.faces[f]];
    const int first = edge->getSourceVertex();
    while ((edge = edge->getNextEdgeOfFace())->getTargetVertex() != first)
      surface.triangles.push_back(
          {index(first), index(edge->getSourceVertex()), index(edge->getTargetVertex())});
  }
  return surface;
}

}  // namespace

void Facets::setMesh(const btConcaveShape& mesh, const btVector3& min, const btVector3& max) {
  static thread_local std::vector<btVector3> corners;
  btVector3 low = min, high = max;
  low.setMin(min_);
  high.setMax(max_);
  if (low != min_ || high != max_) {
    // A body that moves on stays among the same triangles for a while.
    const btScalar around = kKeptAround * (max - min).length();
    min_ = min - btVector3(around, around, around);
    max_ = max + btVector3(around, around, around);
  }
  corners.clear();
  CornerCollector collector(corners);
  mesh.processAllTriangles(&collector, min_, max_);
  set(corners, weld);
}

void Facets::setHull(const btPolyhedralConvexShape& shape) {
  static thread_local std::vector<btVector3> vertices;
  const btVector3 x(1, 0, 0);
  btScalar furthest = -BT_LARGE_FLOAT;
  vertices.resize(static_cast<std::size_t>(shape.getNumVertices()));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    shape.getVertex(static_cast<int>(i), vertices[i]);
    furthest = btMax(furthest, vertices[i].x());
  }
  margin_ = shape.localGetSupportingVertex(x).x() - furthest;
  if (!set(vertices, hullOf)) return;
  btVector3 middle(0, 0, 0);
  for (const auto& vertex : surface_.vertices)
    middle += toBullet(vertex) / btScalar(surface_.vertices.size());
  SurfaceQueries::Nearest face;
  is_solid_ =
      tree_ && tree_->nearest(middle, BT_LARGE_FLOAT, face) && face.distance < -kFlat * diagonalOf(surface_);
}

bool Facets::nearest(const btVector3& place, Nearest& nearest) const {
  SurfaceQueries::Nearest face;
  if (!is_solid_ || !tree_->nearest(place - points_[0], BT_LARGE_FLOAT, face)) return false;
  // Close to a large face its nearest place is rounded aside, and seen askew.
  const btVector3& normal = tree_->normals().face(face.triangle);
  const btScalar cosine = normal.dot(face.normal), height = cosine * face.distance;
  const btScalar aside = (face.normal * face.distance - normal * height).length();
  if (cosine > kOverFace || aside < tree_->rounding()) {
    nearest = {height - margin_, normal, 0, {0, 0, 0}};
    return true;
  }
  nearest = {face.distance - margin_, face.normal, 0, {0, 0, 0}};
  nearest.edge_curvature = 1 / btMax(margin_, SIMD_EPSILON);
  nearest.along =
      edgeAt(tree_->normals().corners(face.triangle), place - points_[0] - face.normal * face.distance);
  return true;
}

bool Facets::place(const btTransform& world, const btVector3& relative_to, SharpEdges& solid) const {
  if (!tree_) return false;
  solid.surface = tree_.get();
  solid.margin = margin_;
  solid.axes = world.getBasis();
  solid.origin = world.getOrigin() - relative_to + solid.axes * points_[0];
  return true;
}

/// Returns whether the points are others than before.
bool Facets::set(const std::vector<btVector3>& points, Surface (*make)(const std::vector<btVector3>&)) {
  expired_ = false;
  if (points == points_) return false;
  points_ = points;
  surface_ = make(points_);
  tree_ = surface_.triangles.empty() ? nullptr : std::make_unique<SurfaceQueries>(surface_);
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
