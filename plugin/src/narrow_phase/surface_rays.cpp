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

Bend bendAt(const PlacedPacking& body, std::size_t triangle, const Across& axes) {
  const SmoothNormals& normals = normalsOf(body);
  if (normals.curvature(triangle) == 0) return {};
  const btMatrix3x3& world = body.world.getBasis();
  const btVector3 x = axes.x * world, y = axes.y * world;
  const btVector3 along_x = normals.turn(triangle, x) / body.scale();
  const btVector3 along_y = normals.turn(triangle, y) / body.scale();
  return {along_x.dot(x), (along_x.dot(y) + along_y.dot(x)) / 2, along_y.dot(y)};
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
