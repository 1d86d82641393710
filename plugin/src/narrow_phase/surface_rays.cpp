#include "narrow_phase/surface_rays.hpp"

#include <algorithm>

#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// In the frame of a surface.
struct Ray {
  Ray(const PlacedPacking& body, const btVector3& start, const btVector3& way, btScalar distance)
      : from((start * body.world.getBasis()) / body.scale()),
        direction(way * body.world.getBasis()),
        length(distance / body.scale()) {}
  btVector3 from;
  btVector3 direction;
  btScalar length;
};

SurfacePoint pointOf(const PlacedPacking& body, const SurfaceQueries::Hit& hit, const btVector3& from,
                     const btVector3& direction) {
  const btMatrix3x3& axes = body.world.getBasis();
  SurfacePoint point;
  point.normal = axes * hit.normal;
  point.curvature = hit.curvature / body.scale();
  point.triangle = hit.triangle;
  point.facing = (axes * hit.face).dot(direction);
  point.at = from + direction * (hit.distance * body.scale());
  return point;
}

/// Whether a place in the solid is nearer to another face than to those with this normal.
bool isNearerToOther(const PlacedPacking& body, const btVector3& place, const btVector3& normal,
                     btScalar size) {
  SurfaceQueries::Nearest nearest;
  if (!body.nearest(place, size, nearest)) return false;
  const btVector3& face = body.shape().surfaceQueries().normals().face(nearest.triangle);
  return (body.world.getBasis() * face).dot(normal) < kSameBentFaceCosine;
}

}  // namespace

bool leaveSolid(const PlacedPacking& body, const btVector3& from, const btVector3& direction, btScalar length,
                std::size_t known, SurfacePoint& point) {
  const SurfaceQueries& surface = body.shape().surfaceQueries();
  const Ray ray(body, from, direction, length);
  SurfaceQueries::Hit hit;
  const auto leaves = [&] {
    point = pointOf(body, hit, from, direction);
    return !(point.facing < kFrontCosine);
  };
  const bool near = known != OpposedPoints::kNone &&
                    surface.castNear(known, ray.from, ray.direction, ray.length, hit) && hit.distance > 0 &&
                    leaves();
  if (!near && !(surface.cast(ray.from, ray.direction, ray.length, ray.direction, hit) && leaves()))
    return false;
  point.at += direction * body.margin;
  return true;
}

bool enterSolid(const PlacedPacking& body, const btVector3& from, const btVector3& direction, btScalar length,
                std::size_t known, const btVector3& opposed, SurfacePoint& point) {
  const SurfaceQueries& surface = body.shape().surfaceQueries();
  const Ray ray(body, from, direction, length);
  const btVector3 towards = -opposed * body.world.getBasis();
  SurfaceQueries::Hit hit;
  const auto enters = [&] {
    point = pointOf(body, hit, from, direction);
    return !(point.facing > -kFrontCosine);
  };
  const bool near = known != OpposedPoints::kNone &&
                    surface.castNear(known, ray.from, ray.direction, ray.length, hit) && enters();
  if (!near) {
    if (!surface.cast(ray.from, ray.direction, ray.length, towards, hit)) return false;
    point = pointOf(body, hit, from, direction);
    if (point.facing > 0) {
      // A line along a face may miss the edge where it enters.
      SurfaceQueries::Nearest nearest;
      const bool inside = surface.nearest(ray.from, ray.length, nearest) && nearest.distance < 0;
      if (!inside || !surface.cast(ray.from, -ray.direction, ray.length, towards, hit)) return false;
      point = pointOf(body, hit, from, -direction);
      point.facing = -point.facing;
    }
  }
  if (point.facing > -kFrontCosine) return false;
  point.at -= direction * body.margin;
  return true;
}

bool isPastValley(const PlacedPacking& body, const btVector3& met, btScalar length) {
  SurfaceQueries::Nearest nearest;
  return length > 0 && body.nearest(met, kSunk * length, nearest);
}

btScalar meetSolid(const PlacedPacking& body, const btVector3& from, const btVector3& way) {
  const btScalar length = way.length();
  if (!(length > 0)) return 2;
  const Ray ray(body, from, way / length, length);
  SurfaceQueries::Hit hit;
  const bool enters =
      body.shape().surfaceQueries().cast(ray.from, ray.direction, ray.length, -ray.direction, hit) &&
      hit.face.dot(ray.direction) < 0;
  return enters ? hit.distance / ray.length : btScalar(2);
}

bool faceUnder(const PlacedPacking& body, const btVector3& at, const btVector3& normal, btScalar depth,
               btScalar size, SurfacePoint& point) {
  const btScalar sunk = kSunk * size, inside = btMax(sunk, depth) + body.margin;
  // In a groove there is a face above, but nothing solid up to it.
  if (!leaveSolid(body, at - normal * inside, normal, size + inside, OpposedPoints::kNone, point))
    return false;
  const btScalar higher = (point.at - at).dot(normal);
  if (btFabs(higher) > sunk || point.normal.dot(normal) < kSameBentFaceCosine) return false;
  // Where the face ends, the way out by the side is the shorter one, but not from a place that is less deep.
  const btScalar below = btMin(depth + higher, sunk);
  return below < 0 || !isNearerToOther(body, point.at - normal * (below + body.margin), point.normal, size);
}

const SmoothNormals& normalsOf(const PlacedPacking& body) {
  return body.shape().surfaceQueries().normals();
}

bool cornersUphill(const PlacedPacking& body, std::size_t triangle, const btVector3& direction,
                   const btVector3& start, btScalar distance, std::vector<std::uint32_t>& vertices) {
  const btMatrix3x3& axes = body.world.getBasis();
  vertices.clear();
  return body.shape().vertexHillClimb().from(triangle, direction * axes, (start * axes) / body.scale(),
                                             distance / body.scale(), vertices);
}

namespace {

/// Where a convex curved face ends, at a vertex, as seen along a way out of the solid; in the packing's
/// frame.
struct Rim {
  std::size_t triangle = OpposedPoints::kNone;  ///< of the face; all else only if there is one
  btVector3 normal{0, 0, 0};                    ///< of the face, at the crest
  btVector3 along{0, 0, 0};                     ///< unit; zero if the face ends in no sharp edge
  btScalar bend = 0;                            ///< how fast it falls from the crest, along it [1/m]
  btVector3 to_crest{0, 0, 0};                  ///< from the vertex to where the rim is furthest out
  bool goes_on = false;                         ///< further out than to the vertices next to this one
};

/// Takes a rim for the circle that the normals at the ends of its edges tell.
Rim rimAt(const PlacedPacking& body, std::uint32_t vertex, const btVector3& way) {
  const SmoothNormals& normals = normalsOf(body);
  const auto& triangles = body.shape().packing().surface.triangles;
  const auto& around = body.shape().vertexHillClimb().around(vertex);
  const auto placeIn = [&](std::uint32_t triangle) {
    const auto& corners = triangles[triangle];
    return std::size_t(std::find(corners.begin(), corners.end(), vertex) - corners.begin());
  };
  Rim rim;
  btScalar most = kUsableCosine, bends = 0;
  for (const std::uint32_t triangle : around) {
    if (!(normals.curvature(triangle) > 0)) continue;
    const btVector3& normal = normals.normalAt(triangle, placeIn(triangle));
    const btScalar facing = normal.dot(way);
    if (!(facing > most)) continue;
    most = facing;
    rim.triangle = triangle;
    rim.normal = normal;
    bends = 0;
    for (std::size_t k = 0; k < 3; ++k) bends = btMax(bends, normal.distance(normals.normalAt(triangle, k)));
  }
  if (bends == 0) return rim;
  btScalar edges = 0;
  for (const std::uint32_t triangle : around) {
    const std::size_t at = placeIn(triangle);
    if (!(normals.normalAt(triangle, at).distance2(rim.normal) < kOneNormal * kOneNormal)) continue;
    for (const std::size_t k : {at, (at + 2) % 3}) {
      const btVector3 edge = normals.corners(triangle)[(k + 1) % 3] - normals.corners(triangle)[k];
      const btScalar length = edge.length();
      if (!normals.isSharp(triangle, k) || !(length > 0)) continue;
      const btVector3 turn = normals.normalAt(triangle, (k + 1) % 3) - normals.normalAt(triangle, k);
      rim.along += edge / length;
      rim.bend += turn.dot(edge) / (length * length);
      ++edges;
    }
  }
  if (rim.along.isZero()) {
    rim.goes_on = rim.normal.distance2(way) >= bends * bends;
    return rim;
  }
  rim.along.normalize();
  const btScalar beside = rim.along.dot(way), over = std::hypot(beside, most);
  const btVector3 crest = (rim.normal * most + rim.along * beside) / over;
  rim.goes_on = crest.distance2(rim.normal) >= bends * bends;
  const btScalar curvature = rim.bend / edges;
  rim.bend = curvature * over;
  if (rim.goes_on || !(curvature > 0)) return rim;
  rim.to_crest = (crest - rim.normal) / curvature;
  rim.along = (rim.along * most - rim.normal * beside) / over;
  rim.normal = crest;
  return rim;
}

}  // namespace

bool layOnRim(const PlacedPacking& body, std::uint32_t vertex, const btVector3& way, bool of_a,
              EdgeContact& corner) {
  const btMatrix3x3& axes = body.world.getBasis();
  const Rim rim = rimAt(body, vertex, way * axes);
  if (rim.triangle == OpposedPoints::kNone) return true;
  OpposedPoints& points = corner.points;
  (of_a ? points.normal_a : points.normal_b) = axes * rim.normal * btScalar(of_a ? 1 : -1);
  (of_a ? points.curvature_a : points.curvature_b) = normalsOf(body).curvature(rim.triangle) / body.scale();
  (of_a ? points.triangle_a : points.triangle_b) = rim.triangle;
  corner.along = axes * rim.along;
  corner.bend_along = rim.bend / body.scale();
  return !rim.goes_on;
}

void layOnTipOrRim(const PlacedPacking& body, std::uint32_t vertex, const btVector3& way, bool of_a,
                   bool is_highest, EdgeContact& corner) {
  const SmoothNormals& normals = normalsOf(body);
  corner.is_end = normals.isEnd(vertex);
  if (normals.isTip(vertex))
    (of_a ? corner.points.curvature_a : corner.points.curvature_b) = 0;
  else
    corner.is_beside = !layOnRim(body, vertex, way, of_a, corner) && !is_highest;
}

Bend bendAt(const PlacedPacking& body, std::size_t triangle, const Across& axes) {
  const SmoothNormals& normals = normalsOf(body);
  if (normals.curvature(triangle) == 0) return {};
  const btMatrix3x3& world = body.world.getBasis();
  const btVector3 x = axes.x * world, y = axes.y * world;
  const btVector3 along_x = normals.turn(triangle, x) / body.scale();
  const btVector3 along_y = normals.turn(triangle, y) / body.scale();
  return {along_x.dot(x), (along_x.dot(y) + along_y.dot(x)) / 2, along_y.dot(y)};
}

btVector3 cornerAt(const PlacedPacking& body, std::uint32_t vertex, const btVector3& direction) {
  const btMatrix3x3& axes = body.world.getBasis();
  const btVector3 in_packing = toBullet(body.shape().packing().surface.vertices[vertex]) +
                               rimAt(body, vertex, direction * axes).to_crest;
  return axes * (in_packing * body.scale()) + direction * body.margin;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
