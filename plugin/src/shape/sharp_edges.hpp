// Shows a solid as the search for crossing edges sees it.
#pragma once

#include "shape/placed_packing.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds faces that meet in sharp edges, placed in the world. Positions are relative to the origin of some
/// packing.
struct SharpEdges {
  /// Takes those of a packing, whose own origin is at `at`.
  SharpEdges(const PlacedPacking& body, const btVector3& at)
      : surface(&body.shape().surfaceQueries()),
        axes(body.world.getBasis()),
        origin(at),
        scale(body.scale()),
        margin(body.margin) {}
  SharpEdges() = default;

  /// This is the sharp edge that is met from a point of a triangle.
  struct Edge {
    btVector3 from{0, 0, 0};
    btVector3 along{0, 0, 0};  ///< to its other end
    SmoothNormals::Ending where;
  };
  /// Finds the sharp edge that is met from a point of a triangle in a direction. Returns false if there is
  /// none near.
  bool edgeTowards(std::size_t triangle, const btVector3& point, const btVector3& towards, Edge& edge) const;
  /// Returns how far the surface goes on from a point of a triangle in a direction until it ends in a sharp
  /// edge [m]. It is BT_LARGE_FLOAT if no edge is near, or that is a valley: the solid goes on beyond.
  btScalar untilEdge(std::size_t triangle, const btVector3& point, const btVector3& towards) const;
  /// Walks over the faces from a point of a triangle along `way`: see SmoothNormals::walk().
  bool walk(std::size_t triangle, const btVector3& point, const btVector3& way, btScalar most,
            SmoothNormals::Walked& walked) const;
  /// Returns the edge that a walk met.
  Edge edgeOf(const SmoothNormals::Walked& walked) const;
  /// Says how the faces of an edge lie.
  struct Faces {
    btVector3 inwards[2];      ///< unit: along them, from the edge
    std::uint32_t id = 0;      ///< of the edge, the same from both
    std::uint32_t across = 0;  ///< the triangle beyond the edge
  };
  Faces facesOf(const Edge& edge) const;
  /// Returns true if the solid is hollow at an edge.
  bool isValley(const Edge& edge) const;
  /// Returns where the middle of a triangle is.
  btVector3 middle(std::size_t triangle) const {
    return origin + axes * surface->normals().middle(triangle) * scale;
  }
  /// Returns the normal of a triangle: unit, out of the solid unless that is inside out.
  btVector3 face(std::size_t triangle) const { return axes * surface->normals().face(triangle); }
  /// Finds the face that is nearest to a place, in the frame and the lengths of the surface. Returns false if
  /// none is within `max_distance` [m].
  bool nearestFace(const btVector3& place, btScalar max_distance, SurfaceQueries::Nearest& nearest) const;
  /// Returns true if the faces enclose a place that is no further away from them than `max_distance` [m].
  bool isIn(const btVector3& place, btScalar max_distance) const;
  /// Finds the triangle that is nearest to a place. Returns false if there is none.
  bool nearestTriangle(const btVector3& place, std::size_t& triangle) const;
  /// Finds how deep a place is in what the faces enclose, from the nearest of them; negative outside [m].
  /// Returns false if there are none.
  bool depthOf(const btVector3& place, btScalar& depth) const;
  /// Finds how far away from the faces a place is, on either side [m]. Returns false if there are none.
  bool distanceOf(const btVector3& place, btScalar& distance) const;

  void place(Edge& edge) const;

  const SurfaceQueries* surface = nullptr;
  btMatrix3x3 axes = btMatrix3x3::getIdentity();
  btVector3 origin{0, 0, 0};
  btScalar scale = 1;
  btScalar margin = 0;      ///< the solid is this much larger on all sides [m]
  bool inside_out = false;  ///< triangles are wound clockwise, seen from outside
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
