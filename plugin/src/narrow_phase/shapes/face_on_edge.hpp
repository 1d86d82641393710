// Where a face of a packing lies on an edge or a corner of another shape.
#pragma once

#include "narrow_phase/shapes/shape_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// The face of `body` that lies on the place where `touch` is nearest to the other surface: its unit normal,
/// out of the body. False if there is none near.
bool faceOver(const PackingBody& body, const Touch& touch, btVector3& normal);

/// The sphere of a touch on an edge sees it askew, but the edge bears the face that lies on it, along the
/// normal of the face. isOutermost(place, direction, tolerance) tells whether the other shape has nothing
/// further out in a direction than a place of its surface; relative to the body's origin, axes of the world.
template <typename IsOutermost>
void layFaceOn(const PackingBody& body, Touch& touch, const IsOutermost& isOutermost) {
  constexpr btScalar kTolerance = btScalar(1e-3);  // of the sphere's reach
  btVector3 face;
  if (!faceOver(body, touch, face)) return;
  const btVector3 to_edge = touch.normal * -touch.distance;
  const btVector3 edge = body.centreOf(touch.sphere) + to_edge;
  if (!isOutermost(edge, -face, kTolerance * body.reach(touch.sphere))) return;
  touch.normal = -face;
  touch.distance = face.dot(to_edge);
  touch.aside = to_edge - face * touch.distance;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
