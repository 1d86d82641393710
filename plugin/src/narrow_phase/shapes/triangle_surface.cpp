// Triangle meshes, heightfields and every other shape that answers processAllTriangles.
//
// A sphere can touch several triangles at once (floor and wall), so every local minimum of the distance
// counts: a nearest point in the interior of a triangle, or on an edge that two triangles agree on; other
// edge points belong to a triangle whose neighbour is nearer. Meshes are two-sided, as everywhere in Bullet:
// which side is outside is decided by where the middle of the body is when it first touches, and kept while
// the pair lives, so that parts which have gone through are pushed back the right way.
#include <algorithm>
#include <array>
#include <mutex>
#include <tuple>

#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <BulletCollision/CollisionShapes/btTriangleCallback.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <LinearMath/btAabbUtil2.h>

#include "common/contact_tolerances.hpp"
#include "narrow_phase/shapes/distance_surface.hpp"
#include "narrow_phase/shapes/face_on_edge.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// In its length: this far beside a line others are asked for what it meets.
constexpr btScalar kBesideLine = btScalar(1e-4);

/// Nearest point of one triangle to the centre of one sphere, lengths in the packing's frame.
struct TrianglePoint {
  std::uint32_t sphere;
  std::uint32_t order;  ///< in which it was found
  bool interior;        ///< not on an edge or corner
  btScalar distance;
  btScalar height;  ///< signed distance from the triangle's plane
  btVector3
      direction;  ///< unit, from the nearest point to the centre; the triangle's normal if they coincide
  btVector3 point;
  std::array<btVector3, 3> corners;
};

class Collector : public btTriangleCallback {
 public:
  Collector(const PlacedPacking& body, const btTransform& to_packing, std::vector<TrianglePoint>& points)
      : body_(body), to_packing_(to_packing), points_(points) {}

  void processTriangle(btVector3* triangle, int, int) override {
    std::array<btVector3, 3> v;
    for (std::size_t i = 0; i < 3; ++i) v[i] = to_packing_(triangle[i]) / body_.scale();
    btVector3 normal = (v[1] - v[0]).cross(v[2] - v[0]);
    const btScalar length = normal.length();
    if (!(length > 0)) return;
    normal /= length;

    btVector3 min = v[0], max = v[0];
    for (int i = 1; i < 3; ++i) {
      min.setMin(v[i]);
      max.setMax(v[i]);
    }
    const btScalar excess = body_.largestExcess() / body_.scale();
    min -= btVector3(excess, excess, excess);
    max += btVector3(excess, excess, excess);
    const auto near = [&](const btVector3& low, const btVector3& high) {
      return TestAabbAgainstAabb2(low, high, min, max);
    };
    body_.sphereBvh().forEach(near, [&](std::size_t i) { test(i, v, normal); });
  }

 private:
  void test(std::size_t i, const std::array<btVector3, 3>& v, const btVector3& normal) {
    const btVector3 c = centre(body_.sphere(i));
    btSubSimplexClosestResult result;
    result.reset();
    solver_.closestPtPointTriangle(c, v[0], v[1], v[2], result);
    const btVector3 offset = c - result.m_closestPointOnSimplex;
    const btScalar distance = offset.length();
    const btScalar search_radius = body_.searchRadius(i) / body_.scale();
    if (!(distance < search_radius)) return;
    const btUsageBitfield& used = result.m_usedVertices;
    const bool interior = used.usedVertexA && used.usedVertexB && used.usedVertexC;
    const auto order = static_cast<std::uint32_t>(points_.size());
    TrianglePoint point{
        static_cast<std::uint32_t>(i),  order, interior, distance, normal.dot(c - v[0]), normal,
        result.m_closestPointOnSimplex, v};
    if (distance > SIMD_EPSILON * search_radius) {
      point.direction = offset / distance;
    } else {
      point.height = SIMD_EPSILON * search_radius;  // a centre on the surface counts as in front of it
    }
    points_.push_back(point);
  }

  const PlacedPacking& body_;
  const btTransform& to_packing_;
  std::vector<TrianglePoint>& points_;
  btVoronoiSimplexSolver solver_;
};

/// The first triangle on a way, in the mesh's frame.
struct FirstTriangle : btTriangleRaycastCallback {
  FirstTriangle(const btVector3& from, const btVector3& to)
      : btTriangleRaycastCallback(from, to, kF_KeepUnflippedNormal) {}
  btScalar reportHit(const btVector3& winding, btScalar fraction, int, int) override {
    normal = winding;
    return fraction;
  }
  btVector3 normal{0, 0, 0};  ///< by the winding; 0 if none is met
};

/// Whether several threads may ask for triangles at once: a GImpact mesh notes who reads it, and what a
/// user's own shape does is not known.
bool isSharable(const btConcaveShape& mesh) {
  switch (mesh.getShapeType()) {
    case TRIANGLE_MESH_SHAPE_PROXYTYPE:
    case SCALED_TRIANGLE_MESH_SHAPE_PROXYTYPE:
    case MULTIMATERIAL_TRIANGLE_MESH_PROXYTYPE:
    case TERRAIN_SHAPE_PROXYTYPE:
      return true;
    default:
      return false;
  }
}

class TriangleSurface : public ShapeSurface {
 public:
  explicit TriangleSurface(const btConcaveShape& mesh) : mesh_(mesh), sharable_(isSharable(mesh)) {}

  void findNearSpheres(const PlacedPacking& body, const btTransform& world,
                       std::vector<NearSphere>& near_spheres) override {
    static thread_local std::vector<TrianglePoint> points;
    facets_.expire();
    points.clear();
    collect(body, world, points);
    if (points.empty()) return;
    std::sort(points.begin(), points.end(), [](const TrianglePoint& a, const TrianglePoint& b) {
      return std::tie(a.sphere, a.distance, a.order) < std::tie(b.sphere, b.distance, b.order);
    });
    if (side_ == 0) side_ = sideOf(body, points);
    setNear(body, world, points);
    forEachSphere(points, [&](const TrianglePoint* first, const TrianglePoint* last) {
      resolve(body, first, last, near_spheres);
    });
  }

  bool isMesh() const override { return true; }

  bool distanceOf(const PlacedPacking& body, const btTransform& world, const btVector3& place,
                  btScalar& distance) override {
    SharpEdges faces;
    return facets(body, world, faces) && faces.distanceOf(place, distance);
  }

  bool depthOf(const PlacedPacking& body, const btTransform& world, const btVector3& place,
               const btVector3& out, btScalar most, btScalar& depth) override {
    const btVector3 way = out * world.getBasis() * most, from = world.invXform(body.origin() + place);
    const auto meetsFromBehind = [&](const btVector3& aside) {
      const FirstTriangle first = firstOn(from + aside, way);
      depth = first.m_hitFraction * most;
      return first.normal.dot(way) * btScalar(side_) > 0;
    };
    // A line that comes from outside may miss the front of an edge by rounding, but not all beside it do.
    btVector3 x, y;
    btPlaneSpace1(way.normalized(), x, y);
    for (const btVector3& side : {x, -x, y, -y})
      if (!meetsFromBehind(side * (kBesideLine * most))) return false;
    return meetsFromBehind(btVector3(0, 0, 0));
  }

  btScalar meets(const PlacedPacking& body, const btTransform& world, const btVector3& from,
                 const btVector3& way) override {
    const btVector3 along = way * world.getBasis();
    const FirstTriangle first = firstOn(world.invXform(body.origin() + from), along);
    return first.normal.dot(along) * btScalar(side_) < 0 ? first.m_hitFraction : btScalar(2);
  }

  bool facets(const PlacedPacking& body, const btTransform& world, SharpEdges& solid) override {
    if (facets_.isExpired()) {
      const std::unique_lock<std::mutex> lock = turnToRead();
      facets_.setMesh(mesh_, near_min_, near_max_);
    }
    solid.inside_out = side_ < 0;
    return facets_.place(world, body.origin(), solid);
  }

 private:
  std::unique_lock<std::mutex> turnToRead() const {
    static std::mutex mutex;
    std::unique_lock<std::mutex> lock(mutex, std::defer_lock);
    if (!sharable_) lock.lock();
    return lock;
  }

  /// Of the mesh, as places are.
  FirstTriangle firstOn(const btVector3& from, const btVector3& way) const {
    FirstTriangle first(from, from + way);
    btVector3 min = from, max = from;
    min.setMin(from + way);
    max.setMax(from + way);
    const std::unique_lock<std::mutex> lock = turnToRead();
    mesh_.processAllTriangles(&first, min, max);
    return first;
  }

  void collect(const PlacedPacking& body, const btTransform& world,
               std::vector<TrianglePoint>& points) const {
    const btVector3 search_margin(body.largestExcess(), body.largestExcess(), body.largestExcess());
    const ShapeFrame& frame = body.shape().frame;
    // The shape's box in the mesh's frame, through the packing's placement.
    const btTransform packing_to_mesh = world.inverseTimes(body.world);
    btVector3 min, max;
    btTransformAabb(frame.box_min, frame.box_max, 0, frame.from_packing.inverse(), min, max);
    btTransformAabb(min * body.scale() - search_margin, max * body.scale() + search_margin, 0,
                    packing_to_mesh, min, max);
    const btTransform mesh_to_packing = packing_to_mesh.inverse();
    Collector collector(body, mesh_to_packing, points);
    const std::unique_lock<std::mutex> lock = turnToRead();
    mesh_.processAllTriangles(&collector, min, max);
  }

  void setNear(const PlacedPacking& body, const btTransform& world,
               const std::vector<TrianglePoint>& points) {
    btVector3 min = points[0].point, max = min;
    btScalar search_radius = 0;
    for (const TrianglePoint& c : points) {
      min.setMin(c.point);
      max.setMax(c.point);
      search_radius = btMax(search_radius, body.searchRadius(c.sphere));
    }
    btTransformAabb(min * body.scale(), max * body.scale(), search_radius, world.inverseTimes(body.world),
                    near_min_, near_max_);
    near_min_[3] = near_max_[3] = 0;  // == compares it
  }

  /// visit(first, last) gets the points of one sphere, nearest first.
  template <typename Visit>
  static void forEachSphere(const std::vector<TrianglePoint>& points, const Visit& visit) {
    for (auto first = points.begin(); first != points.end();) {
      const auto last = std::find_if(first, points.end(),
                                     [&](const TrianglePoint& c) { return c.sphere != first->sphere; });
      visit(&*first, &*first + (last - first));
      first = last;
    }
  }

  /// Nearest points of triangles that are closer are the same: those of large triangles are rounded.
  static btScalar samePlace(const PlacedPacking& body, const TrianglePoint& point) {
    btScalar furthest2 = 0;
    for (const btVector3& corner : point.corners) furthest2 = btMax(furthest2, corner.length2());
    return btMax(kSamePlace * body.prefix->median_radius, 4 * SIMD_EPSILON * btSqrt(furthest2));
  }

  /// +1 if the body is on the side that the triangles' winding calls outside, -1 on the other, 0 if no more
  /// than the rim of the mesh is near. Where the mesh goes through the body, its centre of mass decides: it
  /// is on the side of the sphere that is nearest to it.
  static int sideOf(const PlacedPacking& body, const std::vector<TrianglePoint>& points) {
    const Vec3d& middle = body.shape().packing().solid.centre_of_mass;
    const btVector3 centre_of_mass(btScalar(middle.x), btScalar(middle.y), btScalar(middle.z));
    btScalar least = BT_LARGE_FLOAT;
    int side = 0;
    forEachSphere(points, [&](const TrianglePoint* first, const TrianglePoint* last) {
      const Corner corner = cornerAt(first, first, last, samePlace(body, *first));
      const btScalar distance2 = centre(body.sphere(first->sphere)).distance2(centre_of_mass);
      if ((!first->interior && corner.triangles == 1) || !(distance2 < least)) return;
      least = distance2;
      side = corner.height >= 0 ? 1 : -1;
    });
    return side;
  }

  /// Samples of one sphere, nearest first, to its contacts.
  void resolve(const PlacedPacking& body, const TrianglePoint* first, const TrianglePoint* last,
               std::vector<NearSphere>& near_spheres) const {
    const std::size_t start = near_spheres.size();
    const auto known = [&](const btVector3& normal) {
      return std::any_of(
          near_spheres.begin() + static_cast<std::ptrdiff_t>(start), near_spheres.end(),
          [&](const NearSphere& t) { return btFabs(t.normal.dot(normal)) > kSameDirectionCosine; });
    };
    const btScalar same = samePlace(body, *first);
    for (const TrianglePoint* c = first; c != last; ++c) {
      const btVector3 direction = body.world.getBasis() * c->direction;
      if (known(direction) || (!c->interior && isNearerBeside(c, first, same))) continue;
      const Corner corner = cornerAt(c, first, last, same);
      const bool rim = !c->interior && corner.triangles == 1;
      if (rim && c != first) continue;
      // Nothing lies behind the rim of an open mesh.
      const bool inside = corner.height * side_ < 0 && !rim;
      const btScalar distance = c->distance * body.scale();
      NearSphere near_sphere{c->sphere, inside ? -distance : distance, inside ? -direction : direction};
      if (!c->interior && near_sphere.distance > 0) {
        layFaceOn(body, 0, near_sphere, [&](const btVector3&, const btVector3& out, btScalar tolerance) {
          return isOutermost(c, first, last, same, out * body.world.getBasis(), tolerance / body.scale());
        });
        if (near_sphere.isOnEdge() && known(near_sphere.normal)) continue;
      }
      near_spheres.push_back(near_sphere);
    }
  }

  /// Visits the triangles that share the nearest point of `c`: they touch it. Their own nearest point may be
  /// another place of the same distance but for rounding, as distances grow slowly beside the nearest one.
  template <typename Visit>
  static void forEachSharing(const TrianglePoint* c, const TrianglePoint* first, const TrianglePoint* last,
                             btScalar tolerance, const Visit& visit) {
    const auto test = [&](const TrianglePoint& other) {
      const bool same = !(other.point.distance2(c->point) > tolerance * tolerance);
      if (same || (!c->interior && hasOnRim(other, c->point, tolerance))) visit(other);
    };
    visit(*c);
    for (const TrianglePoint* o = c; o != first && c->distance - (o - 1)->distance <= tolerance; --o)
      test(*(o - 1));
    for (const TrianglePoint* o = c + 1; o != last && o->distance - c->distance <= tolerance; ++o) test(*o);
  }

  static bool hasOnRim(const TrianglePoint& c, const btVector3& point, btScalar same) {
    for (std::size_t k = 0; k < 3; ++k) {
      const btVector3 edge = c.corners[(k + 1) % 3] - c.corners[k], way = point - c.corners[k];
      const btScalar length2 = edge.length2();
      const btScalar share = btClamped(way.dot(edge), btScalar(0), length2) / length2;
      if (way.distance2(edge * share) < same * same) return true;
    }
    return false;
  }

  /// Whether a nearest point is on the rim of a triangle that comes nearer elsewhere.
  static bool isNearerBeside(const TrianglePoint* c, const TrianglePoint* first, btScalar same) {
    return std::any_of(first, c, [&](const TrianglePoint& other) {
      return c->distance - other.distance > same && hasOnRim(other, c->point, same);
    });
  }

  struct Corner {
    int triangles;
    btScalar height;
  };
  /// Of the heights of the triangles that share the nearest point of `c`, the largest in size tells inside
  /// from outside.
  static Corner cornerAt(const TrianglePoint* c, const TrianglePoint* first, const TrianglePoint* last,
                         btScalar tolerance) {
    Corner corner{0, 0};
    forEachSharing(c, first, last, tolerance, [&](const TrianglePoint& sharing) {
      if (corner.triangles++ == 0 || btFabs(sharing.height) > btFabs(corner.height))
        corner.height = sharing.height;
    });
    return corner;
  }

  /// Whether the triangles that share the nearest point of `c` have nothing further out than it, up to
  /// `tolerance`; of small ones, whose corners are never that far out, none that rises.
  static bool isOutermost(const TrianglePoint* c, const TrianglePoint* first, const TrianglePoint* last,
                          btScalar same, const btVector3& direction, btScalar tolerance) {
    bool outermost = true;
    forEachSharing(c, first, last, same, [&](const TrianglePoint& sharing) {
      for (const btVector3& v : sharing.corners) {
        const btVector3 way = v - c->point;
        outermost = outermost && way.dot(direction) < btMin(tolerance, kFallingSine * way.length() + same);
      }
    });
    return outermost;
  }

  const btConcaveShape& mesh_;
  const bool sharable_;
  int side_ = 0;
  btVector3 near_min_{0, 0, 0};  ///< where the last search met the mesh, in its frame
  btVector3 near_max_{0, 0, 0};
  Facets facets_;
};

}  // namespace

std::unique_ptr<ShapeSurface> makeTriangleSurface(const btCollisionShape& shape) {
  return std::make_unique<TriangleSurface>(static_cast<const btConcaveShape&>(shape));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
