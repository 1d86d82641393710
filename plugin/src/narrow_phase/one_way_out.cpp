#include "narrow_phase/one_way_out.hpp"

#include <algorithm>

#include <BulletCollision/CollisionShapes/btConvexShape.h>

#include "common/bullet_vectors.hpp"
#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

bool isOnAxis(const NearSphere& near_sphere, const btVector3& axis) {
  return !near_sphere.isOnEdge() && btFabs(near_sphere.normal.dot(axis)) > kSameFaceCosine;
}

/// What a convex shape measures along an axis of the world.
struct Thickness {
  Thickness(const btConvexShape& shape, const btTransform& world, const btVector3& axis) {
    const btVector3 along = axis * world.getBasis();
    const btScalar high = shape.localGetSupportingVertex(along).dot(along);
    const btScalar low = shape.localGetSupportingVertex(-along).dot(along);
    size = high - low;
    middle = world.getOrigin().dot(axis) + (high + low) / 2;
  }
  btScalar size;    ///< [m]
  btScalar middle;  ///< [m]
};

/// The side of the plate, +1 or -1 along the axis, by which the body leaves.
btScalar sideOf(const PlacedPacking& body, const btVector3& axis, btScalar middle,
                const std::vector<ContactPatch>& before) {
  bool above = false, below = false;
  for (const ContactPatch& patch : before) {
    const btScalar up = -patch.normal.dot(axis);
    above = above || up > kPatchCosine;
    below = below || up < -kPatchCosine;
  }
  if (above != below) return above ? btScalar(1) : btScalar(-1);
  const Vec3d& c = body.shape().packing().solid.centre_of_mass;
  const btVector3 centre_of_mass =
      body.world * (btVector3(btScalar(c.x), btScalar(c.y), btScalar(c.z)) * body.scale());
  return centre_of_mass.dot(axis) < middle ? btScalar(-1) : btScalar(1);
}

}  // namespace

void leaveByOneSide(const PlacedPacking& body, const btConvexShape& plate, const btTransform& world,
                    const std::vector<ContactPatch>& before, btScalar gap,
                    std::vector<NearSphere>& near_spheres) {
  const auto radius = [&](const NearSphere& n) { return body.ownRadius(n.sphere) + body.margin; };
  const auto deepest = std::max_element(near_spheres.begin(), near_spheres.end(),
                                        [&](const NearSphere& a, const NearSphere& b) {
                                          return radius(a) - a.distance < radius(b) - b.distance;
                                        });
  if (deepest == near_spheres.end() || !(deepest->distance < 0)) return;  // it may hold the plate
  const btVector3 axis = deepest->normal;
  const auto isOpposed = [&](const NearSphere& n) { return isOnAxis(n, axis) && n.normal.dot(axis) < 0; };
  if (std::none_of(near_spheres.begin(), near_spheres.end(), isOpposed)) return;
  const Thickness thickness(plate, world, axis);
  static thread_local std::vector<const NearSphere*> of_spheres;
  of_spheres.assign(body.count(), nullptr);
  for (const NearSphere& n : near_spheres) {
    if (!body.isFeeler(n.sphere)) of_spheres[n.sphere] = &n;
  }
  const auto reachesMiddle = [&](const NearSphere& n) {
    if (!(n.distance < 0)) return false;
    if (btFabs(n.distance + thickness.size / 2) < radius(n)) return true;
    if (!body.isFeeler(n.sphere)) return false;
    const NearSphere* const beside = of_spheres[body.sphereBeside(n.sphere)];
    return beside != nullptr && isOnAxis(*beside, axis) && beside->normal.dot(n.normal) < 0;
  };
  static thread_local std::vector<NearSphere*> together, others;
  together.clear();
  others.clear();
  for (NearSphere& n : near_spheres) {
    if (isOnAxis(n, axis)) (reachesMiddle(n) ? together : others).push_back(&n);
  }
  for (std::size_t i = 0; i < together.size(); ++i) {
    const btVector3 centre = body.centreOf(together[i]->sphere);
    const auto hangsOn = [&](const NearSphere* n) {
      const btScalar reach = radius(*together[i]) + radius(*n) + gap;
      return centre.distance2(body.centreOf(n->sphere)) < reach * reach;
    };
    const auto rest =
        std::partition(others.begin(), others.end(), [&](NearSphere* n) { return !hangsOn(n); });
    together.insert(together.end(), rest, others.end());
    others.erase(rest, others.end());
  }
  if (together.empty()) return;
  const btVector3 out = axis * sideOf(body, axis, thickness.middle, before);
  for (NearSphere* n : together) {
    if (n->normal.dot(out) > 0) continue;
    n->distance = -thickness.size - n->distance;
    n->normal = -n->normal;
    n->curvature = 0;
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
