// Finds where a face of a packing lies on an edge or a corner of another shape.
#pragma once

#include "common/contact_tolerances.hpp"
#include "narrow_phase/shapes/shape_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Finds the face of `body` that lies on the place where `near_sphere` is nearest to the other surface: its
/// unit normal, out of the body. Returns false if there is none near.
bool faceOver(const PlacedPacking& body, const NearSphere& near_sphere, btVector3& normal);

/// A sphere sees an edge askew, but the edge bears the face that lies on it, along the
/// normal of the face. isOutermost(place, direction, tolerance) tells whether the other shape has nothing
/// further out in a direction than a place of its surface; relative to the body's origin, axes of the world.
template <typename IsOutermost>
void layFaceOn(const PlacedPacking& body, NearSphere& near_sphere, const IsOutermost& isOutermost) {
  btVector3 face;
  if (!faceOver(body, near_sphere, face)) return;
  const btVector3 to_edge = near_sphere.normal * -near_sphere.distance;
  const btVector3 edge = body.centreOf(near_sphere.sphere) + to_edge;
  if (!isOutermost(edge, -face, kOutermostTolerance * body.searchRadius(near_sphere.sphere))) return;
  near_sphere.normal = -face;
  near_sphere.distance = face.dot(to_edge);
  near_sphere.aside = to_edge - face * near_sphere.distance;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
