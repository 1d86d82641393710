#include "narrow_phase/shapes/face_on_edge.hpp"

#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
bool faceOver(const PlacedPacking& body, const NearSphere& near_sphere, FaceOver& face) {
  if (!body.shape().hasSurface()) return false;
  const btScalar sunk = kSunk * body.ownRadius(near_sphere.sphere) + body.margin;
  const btVector3 place =
      body.centreOf(near_sphere.sphere) - near_sphere.normal * (near_sphere.distance - sunk);
  SurfaceQueries::Nearest nearest;
  if (!body.nearest(place, 2 * body.searchRadius(near_sphere.sphere), nearest)) return false;
  face = {nearest.normal, body.shape().surfaceQueries().normals().curvature(nearest.triangle) / body.scale()};
  return nearest.distance < 0;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
