#include "narrow_phase/shapes/face_on_edge.hpp"

#include "common/contact_tolerances.hpp"
#include "shape/sharp_edges.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
bool faceOver(const PlacedPacking& body, const NearSphere& near_sphere, FaceOver& face) {
  if (!body.shape().hasSurface()) return false;
  const btScalar sunk = kSunk * body.ownRadius(near_sphere.sphere) + body.margin;
  const btVector3 edge = body.centreOf(near_sphere.sphere) - near_sphere.normal * near_sphere.distance;
  const btScalar most = 2 * body.searchRadius(near_sphere.sphere);
  SurfaceQueries::Nearest nearest;
  // Seen from deeper inside another face may be nearer; where two are as near, the line to the edge decides.
  if (!body.nearest(edge, most, nearest)) return false;
  btVector3 normal;
  if (nearest.beside) {
    if (!body.nearest(edge + near_sphere.normal * sunk, most, nearest) || !(nearest.distance < 0))
      return false;
    normal = nearest.normal;
  } else {
    if (!(nearest.distance < sunk)) return false;
    normal = SharpEdges(body, btVector3(0, 0, 0)).face(nearest.triangle);
  }
  face = {normal, body.shape().surfaceQueries().normals().curvature(nearest.triangle) / body.scale()};
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
