// A solid as the search for crossing edges sees it.
#pragma once

#include "shape/placed_packing.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Faces that meet in sharp edges, placed in the world. Positions are relative to the origin of some packing.
struct SharpEdges {
  /// Of a packing, whose own origin is at `at`.
  SharpEdges(const PlacedPacking& body, const btVector3& at)
      : surface(&body.shape().surfaceQueries()),
        axes(body.world.getBasis()),
        origin(at),
        scale(body.scale()),
        margin(body.margin) {}
  SharpEdges() = default;

  /// The sharp edge that is met from a point of a triangle.
  struct Edge {
    btVector3 from{0, 0, 0};
    btVector3 along{0, 0, 0};  ///< to its other end
    btVector3 inwards[2];      ///< unit: along its faces
    std::uint32_t id = 0;
  };
  bool edgeTowards(std::size_t triangle, const btVector3& point, const btVector3& towards, Edge& edge) const;
  /// Where a triangle is.
  btVector3 middle(std::size_t triangle) const {
    return origin + axes * surface->normals().middle(triangle) * scale;
  }
  /// Its normal: unit, out of the solid unless that is inside out.
  btVector3 face(std::size_t triangle) const { return axes * surface->normals().face(triangle); }
  /// The face that is nearest to a place, in the frame and the lengths of the surface. False if none is
  /// within `max_distance` [m].
  bool nearestFace(const btVector3& place, btScalar max_distance, SurfaceQueries::Nearest& nearest) const;
  /// Whether the faces enclose a place that is no further away from them than `max_distance` [m].
  bool isIn(const btVector3& place, btScalar max_distance) const;
  /// The triangle that is nearest to a place. False if there is none.
  bool nearestTriangle(const btVector3& place, std::size_t& triangle) const;
  /// How far away from the faces a place is, on either side. False if there are none.
  bool distanceOf(const btVector3& place, btScalar& distance) const;

  const SurfaceQueries* surface = nullptr;
  btMatrix3x3 axes = btMatrix3x3::getIdentity();
  btVector3 origin{0, 0, 0};
  btScalar scale = 1;
  btScalar margin = 0;      ///< the solid is this much larger on all sides [m]
  bool inside_out = false;  ///< triangles are wound clockwise, seen from outside
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
