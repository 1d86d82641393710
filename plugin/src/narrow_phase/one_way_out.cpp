#include "narrow_phase/one_way_out.hpp"

#include <algorithm>

#include "common/bullet_vectors.hpp"
#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

bool isOnAxis(const NearSphere& near_sphere, const btVector3& axis) {
  return !near_sphere.isOnEdge() && btFabs(near_sphere.normal.dot(axis)) > kSameFaceCosine;
}

/// A plate, as spheres in it see it.
class Plate {
 public:
  Plate(const PlacedPacking& body, ShapeSurface& surface, const btTransform& world)
      : body_(body), surface_(surface), world_(world) {}

  btVector3 faceBefore(const NearSphere& n) const { return body_.centreOf(n.sphere) - n.normal * n.distance; }
  /// Finds how thick it is behind the face that a sphere sees [m]. Returns false if that is more than `most`,
  /// or not known.
  bool thickness(const NearSphere& n, btScalar most, btScalar& size) const {
    const btScalar behind = kBehindFace * most;
    if (!surface_.depthOf(body_, world_, faceBefore(n) - n.normal * behind, -n.normal, most, size))
      return false;
    size += behind;
    return true;
  }

 private:
  /// Rays start off the face.
  static constexpr btScalar kBehindFace = btScalar(1e-3);
  const PlacedPacking& body_;
  ShapeSurface& surface_;
  const btTransform& world_;
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
  return (centre_of_mass - body.origin()).dot(axis) < middle ? btScalar(-1) : btScalar(1);
}

}  // namespace

void findNearestOfEach(const PlacedPacking& body, const std::vector<NearSphere>& near_spheres,
                       std::vector<const NearSphere*>& nearest) {
  nearest.assign(body.count(), nullptr);
  for (const NearSphere& n : near_spheres) {
    if (body.isFeeler(n.sphere)) continue;
    const NearSphere*& of_sphere = nearest[n.sphere];
    if (of_sphere == nullptr || n.distance < of_sphere->distance) of_sphere = &n;
  }
}

void leaveByOneSide(const PlacedPacking& body, ShapeSurface& surface, const btTransform& world,
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
  const Plate plate(body, surface, world);
  // What reaches the middle is no further from it than this.
  const btScalar most = 2 * (radius(*deepest) - deepest->distance + gap);
  btScalar thickness = 0;
  if (!plate.thickness(*deepest, most, thickness)) return;
  const btScalar middle = plate.faceBefore(*deepest).dot(axis) - thickness / 2;
  static thread_local std::vector<const NearSphere*> nearest;
  findNearestOfEach(body, near_spheres, nearest);
  const auto reachesMiddle = [&](const NearSphere& n) {
    if (!(n.distance < 0)) return false;
    if (btFabs(n.distance + thickness / 2) < radius(n)) return true;
    if (!body.isFeeler(n.sphere)) return false;
    const NearSphere* const beside = nearest[body.sphereBeside(n.sphere)];
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
  const btVector3 out = axis * sideOf(body, axis, middle, before);
  for (NearSphere* n : together) {
    if (n->normal.dot(out) > 0 || !plate.thickness(*n, 2 * most, thickness)) continue;
    n->distance = -thickness - n->distance;
    n->normal = -n->normal;
    n->curvature = 0;
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
