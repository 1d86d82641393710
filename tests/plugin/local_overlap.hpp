// How deep two polyhedra are in each other where they have just met, by brute force in double precision.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <LinearMath/btTransform.h>

#include "innersphere/geometry.hpp"
#include "innersphere/vec3.hpp"

namespace innersphere::test {

/// A closed surface where it is. Shares no code with the plug-in.
struct PlacedMesh {
  PlacedMesh(const Surface& surface, const btTransform& at);
  void move(const Vec3d& by);

  struct Edge {
    int from, to;
    bool sharp = true;  ///< its faces do not lie in one plane
  };
  std::vector<Vec3d> corners;
  std::vector<std::array<int, 3>> triangles;
  std::vector<Vec3d> normals;
  std::vector<Edge> edges;
};

/// How far A goes along a direction until it touches B, and along which normal (from A to B, unit).
struct Touch {
  double way;
  Vec3d normal;
};
std::optional<Touch> firstTouch(const PlacedMesh& a, const PlacedMesh& b, const Vec3d& direction);

/// A contact: `depth` [m] is negative where the surfaces are apart.
struct LocalOverlap {
  double depth;
  Vec3d normal;  ///< unit, from A to B
  Vec3d on_b;    ///< where A would leave B, or touch it
};

/// The deepest contact of two meshes that overlap in one place: the shortest way that takes the parts within
/// `around` [m] of it out of each other. It leads along the normal of a face, or across two edges. Nothing if
/// they overlap in several places, or are apart with an edge or a corner beside an edge.
std::optional<LocalOverlap> localOverlap(const PlacedMesh& a, const PlacedMesh& b, double around);

}  // namespace innersphere::test
