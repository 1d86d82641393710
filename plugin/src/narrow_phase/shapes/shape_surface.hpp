// Shows the surface of a shape that is not a packing, as the spheres of a packing see it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "shape/placed_packing.hpp"
#include "shape/sharp_edges.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// This is a sphere near the other solid. A sphere in a concave corner has several.
struct NearSphere {
  std::uint32_t sphere = 0;
  btScalar distance = 0;        ///< of its centre from the other surface [m], negative inside the other solid
  btVector3 normal{0, 0, 0};    ///< unit, out of the other solid at the nearest point; axes of the world
  btScalar curvature = 0;       ///< of the other surface there [1/m]; 0 if flat, or not known
  btVector3 straight{0, 0, 0};  ///< unit, along which it is curved less: of a cylinder; 0 if it is round
  btScalar along_straight = 0;  ///< its curvature along that [1/m]: 0, but for a rim
  /// The way from the line through its centre along the normal to the nearest point: not zero where that lies
  /// on an edge of the other surface that a face of the solid lies on. Then the normal is that of the face
  /// [m].
  btVector3 aside{0, 0, 0};

  bool isOnEdge() const { return !aside.isZero(); }
};

/// Has one implementation for each kind of shape. An object belongs to one pair of bodies and may remember
/// things of it.
class ShapeSurface {
 public:
  virtual ~ShapeSurface() = default;

  /// Appends the spheres of `body` whose centre is closer than their search radius (body.searchRadius) to
  /// this shape placed at `world`.
  virtual void findNearSpheres(const PlacedPacking& body, const btTransform& world,
                               std::vector<NearSphere>& near_spheres) = 0;

  /// Returns true if it has flat faces, and may be hollow.
  virtual bool isMesh() const { return false; }

  /// Returns true if it has many edges, as a hull that stands for a round body has.
  virtual bool isFaceted() const { return false; }

  /// Returns true if the shape is as it was when it was asked last, and false if that cannot be told.
  virtual bool isAsBefore() { return false; }
  /// Renews the distances of near spheres for where the bodies are now; they may be further away by then.
  /// Returns false if that cannot be done.
  virtual bool updateNearSpheres(const PlacedPacking&, const btTransform&, std::vector<NearSphere>&) {
    return false;
  }

  /// Finds the straight line on a surface that bends one way only, as that of a cylinder, which is furthest
  /// out along `direction` (unit): its ends, relative to body.origin(). Returns false if there is none.
  virtual bool line(const PlacedPacking&, const btTransform&, const btVector3&, btVector3 (&)[2]) {
    return false;
  }

  /// Finds how far away from it a place outside is, relative to body.origin(), near the spheres found last
  /// [m]. Returns false if that is not known.
  virtual bool distanceOf(const PlacedPacking&, const btTransform&, const btVector3&, btScalar&) {
    return false;
  }

  /// Finds how deep a place in the shape is, relative to body.origin(): how far along `out` (unit) it is to
  /// the surface [m]. Returns false if none is met within `most` [m], or only from its front, or if that is
  /// not known.
  virtual bool depthOf(const PlacedPacking&, const btTransform&, const btVector3& /*place*/,
                       const btVector3& /*out*/, btScalar /*most*/, btScalar& /*depth*/) {
    return false;
  }

  /// Finds the nearest point of the shape to a place, relative to body.origin(), as a sphere there would see
  /// it. Returns false if that is not known.
  virtual bool nearestTo(const PlacedPacking&, const btTransform&, const btVector3&, NearSphere&) {
    return false;
  }

  /// Finds where a point, `from` relative to body.origin(), that goes along `way` [m] comes from outside to
  /// the surface: the part of the way, 0 to 1; 2 if it does not; -1 if that is not known, as by default.
  virtual btScalar meets(const PlacedPacking&, const btTransform&, const btVector3& /*from*/,
                         const btVector3& /*way*/) {
    return -1;
  }

  /// Gives its flat faces, those near the spheres found last at least, relative to body.origin(). Returns
  /// false if it has none.
  virtual bool facets(const PlacedPacking&, const btTransform&, SharpEdges&) { return false; }
};

/// Returns the surface of `shape`, or null for a shape without one (fluids, invalid types). The shape must
/// outlive it.
std::unique_ptr<ShapeSurface> makeShapeSurface(const btCollisionShape& shape);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
