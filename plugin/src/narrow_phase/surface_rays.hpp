// Finds where lines leave and enter a packed solid: what both kinds of surface probe share.
#pragma once

#include "narrow_phase/surface_probe.hpp"
#include "shape/placed_packing.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// This is a point of a body's surface, with the shape's margin. It is relative to the body's origin, axes
/// are those of the world.
struct SurfacePoint {
  btVector3 at{0, 0, 0};
  btVector3 normal{0, 0, 0};  ///< unit, out of the solid
  btScalar facing = 0;        ///< cosine between the triangle's normal and the ray
  btScalar curvature = 0;     ///< [1/m]
  std::size_t triangle = OpposedPoints::kNone;
};

/// Finds where a ray from inside the solid leaves it, no further than `length` [m] away. Triangle `known`, or
/// one near it, is taken if the ray passes it. Returns false if nothing is met, or the side of the solid,
/// which `point` then holds.
bool leaveSolid(const PlacedPacking& body, const btVector3& from, const btVector3& direction, btScalar length,
                std::size_t known, SurfacePoint& point);

/// Finds where the line of a ray enters the solid: ahead of its start, or behind if it starts inside. On an
/// edge it is the face whose normal points most against `opposed`. Returns false as leaveSolid() does.
bool enterSolid(const PlacedPacking& body, const btVector3& from, const btVector3& direction, btScalar length,
                std::size_t known, const btVector3& opposed, SurfacePoint& point);

/// Returns true if a line that goes on in the solid for a length [m] from the place where it met the other
/// one began at its surface: it passed the bottom of a valley, to some face beyond that says nothing of this
/// place.
bool isPastValley(const PlacedPacking& body, const btVector3& met, btScalar length);

/// Finds where a point that goes along `way` [m] comes from outside to the solid, without its margin: the
/// part of the way, 0 to 1; 2 if it does not.
btScalar meetSolid(const PlacedPacking& body, const btVector3& from, const btVector3& way);

/// Finds the face with about this normal that a place `at` is on. Returns false if there is none, or if the
/// solid does not reach from there down to `depth` [m]. `size` [m] is that of the spheres there.
bool faceUnder(const PlacedPacking& body, const btVector3& at, const btVector3& normal, btScalar depth,
               btScalar size, SurfacePoint& point);

/// The curved surface of a packing.
const SmoothNormals& normalsOf(const PlacedPacking& body);

/// Returns how the curved surface of a solid bends at a triangle.
Bend bendAt(const PlacedPacking& body, std::size_t triangle, const Across& axes);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
