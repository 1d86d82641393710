#include "narrow_phase/shapes/distance_surface.hpp"

#include <algorithm>

#include "narrow_phase/shapes/face_on_edge.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// In lengths of the way: what is as near as this is met.
constexpr btScalar kMetAt = btScalar(1e-4);
/// Each of them squares the error, once it is small.
constexpr int kMeetingSteps = 16;

}  // namespace

void DistanceSurface::findNearSpheres(const PlacedPacking& body, const btTransform& world,
                                      std::vector<NearSphere>& near_spheres) {
  facets_.expire();
  const btTransform to_shape = world.inverseTimes(body.world);
  const btScalar scale = body.scale();
  const auto near = [&](const btVector3& min, const btVector3& max) {
    const btScalar radius = btScalar(0.5) * (max - min).length() * scale;
    return lowerBound(to_shape((min + max) * (btScalar(0.5) * scale))) <= radius + body.largestExcess();
  };
  const auto test = [&](std::size_t i) {
    NearSphere found;
    found.sphere = static_cast<std::uint32_t>(i);
    if (updateNearSphere(body, world, to_shape, found) && found.distance < body.searchRadius(i))
      near_spheres.push_back(found);
  };
  body.sphereBvh().forEach(near, test);
}

bool DistanceSurface::updateNearSpheres(const PlacedPacking& body, const btTransform& world,
                                        std::vector<NearSphere>& near_spheres) {
  const btTransform to_shape = world.inverseTimes(body.world);
  return std::all_of(near_spheres.begin(), near_spheres.end(), [&](NearSphere& near_sphere) {
    return updateNearSphere(body, world, to_shape, near_sphere);
  });
}

/// Of the sphere that `near_sphere` names.
bool DistanceSurface::updateNearSphere(const PlacedPacking& body, const btTransform& world,
                                       const btTransform& to_shape, NearSphere& near_sphere) const {
  Nearest found;
  const Sphere& sphere = body.sphere(near_sphere.sphere);
  if (!nearest(to_shape(centre(sphere) * body.scale()), found)) return false;
  near_sphere.distance = found.distance;
  near_sphere.normal = world.getBasis() * found.normal;
  near_sphere.curvature = found.curvature;
  near_sphere.straight = world.getBasis() * found.straight;
  near_sphere.along_straight = found.along_straight;
  near_sphere.aside.setZero();
  if (found.edged != nullptr && found.distance > 0) {
    const btScalar bend = btMax(found.curvature, found.edge_curvature);
    layFaceOn(body, bend, near_sphere, [&](const btVector3& edge, const btVector3& out, btScalar tolerance) {
      const btTransform from_world = world.inverse();
      const btVector3 direction = from_world.getBasis() * out;
      // Of a rim, which goes on below, only the lowest place bears.
      if (btFabs(direction.dot(found.straight)) > found.along_straight * tolerance &&
          found.along_straight > 0)
        return false;
      const btVector3 outermost = found.edged->localGetSupportingVertex(direction);
      return (outermost - from_world(edge + body.origin())).dot(direction) < tolerance;
    });
  }
  return true;
}

bool DistanceSurface::distanceOf(const PlacedPacking& body, const btTransform& world, const btVector3& place,
                                 btScalar& distance) {
  NearSphere near_place;
  if (!nearestTo(body, world, place, near_place)) return false;
  distance = near_place.distance;
  return true;
}

bool DistanceSurface::nearestTo(const PlacedPacking& body, const btTransform& world, const btVector3& place,
                                NearSphere& near_sphere) {
  Nearest found;
  if (!nearest(world.invXform(body.origin() + place), found)) return false;
  near_sphere.distance = found.distance;
  near_sphere.normal = world.getBasis() * found.normal;
  // Only surfaces that bend are followed beside where they were met first.
  near_sphere.curvature = btMax(found.curvature, btMin(found.edge_curvature, sharpest(body, near_sphere)));
  near_sphere.straight = world.getBasis() * found.straight;
  near_sphere.along_straight = found.along_straight;
  near_sphere.aside.setZero();
  return true;
}

/// By Newton's method: along a line the distance from a convex shape is a convex function, so that a step
/// from outside does not pass the first root.
btScalar DistanceSurface::meets(const PlacedPacking& body, const btTransform& world, const btVector3& from,
                                const btVector3& way) {
  if (!isConvex()) return -1;
  const btVector3 start = world.invXform(body.origin() + from), along = way * world.getBasis();
  const btScalar near = kMetAt * along.length();
  btScalar part = 0;
  for (int i = 0; i < kMeetingSteps; ++i) {
    Nearest found;
    if (!nearest(start + along * part, found)) return -1;
    if (found.distance < near) return part;
    const btScalar nearer = -found.normal.dot(along);
    if (!(nearer > 0)) return 2;
    part += found.distance / nearer;
    if (part > 1) return 2;
  }
  return -1;
}

bool DistanceSurface::line(const PlacedPacking& body, const btTransform& world, const btVector3& direction,
                           btVector3 (&ends)[2]) {
  if (!lineTowards(direction * world.getBasis(), ends)) return false;
  for (btVector3& end : ends) end = world * end - body.origin();
  return true;
}

bool DistanceSurface::facets(const PlacedPacking& body, const btTransform& world, SharpEdges& solid) {
  const btPolyhedralConvexShape* const shape = polyhedron();
  if (shape == nullptr) return false;
  if (facets_.isExpired()) facets_.setHull(*shape);
  return facets_.place(world, body.origin(), solid);
}

bool DistanceSurface::boxIsAsBefore(const btCollisionShape& shape) {
  btVector3 min, max;
  shape.getAabb(btTransform::getIdentity(), min, max);
  min[3] = max[3] = 0;  // == compares it, and some of Bullet's shapes do not set it
  if (min == box_min_ && max == box_max_) return true;
  box_min_ = min;
  box_max_ = max;
  return false;
}

btScalar DistanceSurface::lowerBound(const btVector3& p) const {
  Nearest found;
  return nearest(p, found) ? found.distance : BT_LARGE_FLOAT;
}

btScalar DistanceSurface::boxDistance(const btCollisionShape& shape, const btVector3& p) {
  btVector3 min, max;
  shape.getAabb(btTransform::getIdentity(), min, max);
  btVector3 beyond = min - p;
  beyond.setMax(p - max);
  beyond.setMax(btVector3(0, 0, 0));
  return beyond.length();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
