// Finds where a face of a packing lies on an edge or a corner of another shape.
#pragma once

#include "common/contact_tolerances.hpp"
#include "narrow_phase/shapes/shape_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// The face of a packing that lies on a place.
struct FaceOver {
  btVector3 normal;    ///< unit, out of the packing
  btScalar curvature;  ///< [1/m]
};
/// Finds the face of `body` that lies on the place where `near_sphere` is nearest to the other surface.
/// Returns false if there is none near.
bool faceOver(const PlacedPacking& body, const NearSphere& near_sphere, FaceOver& face);

/// Returns how an edge bends that is as sharp as counts [1/m].
inline btScalar sharpest(const PlacedPacking& body, const NearSphere& near_sphere) {
  return 1 / (kOutermostTolerance * body.searchRadius(near_sphere.sphere));
}

/// A sphere sees an edge askew, but the edge bears the face that lies on it, along the
/// normal of the face. isOutermost(place, direction, tolerance) tells whether the other shape has nothing
/// further out in a direction than a place of its surface; relative to the body's origin, axes of the world.
/// A face that bends lies on the edge in one place only, which an ascent finds: to it the edge is a surface
/// that bends by `edge_curvature` [1/m], up to what counts. If that is 0, the face is laid on as if it were
/// flat.
template <typename IsOutermost>
void layFaceOn(const PlacedPacking& body, btScalar edge_curvature, NearSphere& near_sphere,
               const IsOutermost& isOutermost) {
  FaceOver over;
  if (!faceOver(body, near_sphere, over)) return;
  if (over.curvature != 0 && edge_curvature > 0) {
    near_sphere.curvature = btMin(edge_curvature, sharpest(body, near_sphere));
    return;
  }
  const btVector3& face = over.normal;
  const btVector3 to_edge = near_sphere.normal * -near_sphere.distance;
  const btVector3 edge = body.centreOf(near_sphere.sphere) + to_edge;
  if (!isOutermost(edge, -face, kOutermostTolerance * body.searchRadius(near_sphere.sphere))) return;
  near_sphere.normal = -face;
  near_sphere.distance = face.dot(to_edge);
  near_sphere.aside = to_edge - face * near_sphere.distance;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
