#include "narrow_phase/solid_corner.hpp"

#include <algorithm>
#include <cmath>

#include "common/contact_tolerances.hpp"
#include "narrow_phase/surface_rays.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Where a convex curved face ends, at a vertex, as seen along a way out of the solid; in the packing's
/// frame.
struct Rim {
  std::size_t triangle = OpposedPoints::kNone;  ///< of the face; all else only if there is one
  btVector3 normal{0, 0, 0};                    ///< of the face, at the crest
  btVector3 along{0, 0, 0};                     ///< unit; zero if the face ends in no sharp edge
  btScalar bend = 0;                            ///< how fast it falls from the crest, along it [1/m]
  btVector3 to_crest{0, 0, 0};                  ///< from the vertex to where the rim is furthest out
  bool goes_on = false;                         ///< further out than to the vertices next to this one
};

/// Takes a rim for the circle that the normals at the ends of its edges tell.
Rim rimAt(const PlacedPacking& body, std::uint32_t vertex, const btVector3& way) {
  const SmoothNormals& normals = normalsOf(body);
  const auto& triangles = body.shape().packing().surface.triangles;
  const auto& around = body.shape().vertexHillClimb().around(vertex);
  const auto placeIn = [&](std::uint32_t triangle) {
    const auto& corners = triangles[triangle];
    return std::size_t(std::find(corners.begin(), corners.end(), vertex) - corners.begin());
  };
  Rim rim;
  btScalar most = kUsableCosine, bends = 0;
  for (const std::uint32_t triangle : around) {
    if (!(normals.curvature(triangle) > 0)) continue;
    const btVector3& normal = normals.normalAt(triangle, placeIn(triangle));
    const btScalar facing = normal.dot(way);
    if (!(facing > most)) continue;
    most = facing;
    rim.triangle = triangle;
    rim.normal = normal;
    bends = 0;
    for (std::size_t k = 0; k < 3; ++k) bends = btMax(bends, normal.distance(normals.normalAt(triangle, k)));
  }
  if (bends == 0) return rim;
  btScalar edges = 0;
  for (const std::uint32_t triangle : around) {
    const std::size_t at = placeIn(triangle);
    if (!(normals.normalAt(triangle, at).distance2(rim.normal) < kOneNormal * kOneNormal)) continue;
    for (const std::size_t k : {at, (at + 2) % 3}) {
      const btVector3 edge = normals.corners(triangle)[(k + 1) % 3] - normals.corners(triangle)[k];
      const btScalar length = edge.length();
      if (!normals.isSharp(triangle, k) || !(length > 0)) continue;
      const btVector3 turn = normals.normalAt(triangle, (k + 1) % 3) - normals.normalAt(triangle, k);
      rim.along += edge / length;
      rim.bend += turn.dot(edge) / (length * length);
      ++edges;
    }
  }
  if (rim.along.isZero()) {
    rim.goes_on = rim.normal.distance2(way) >= bends * bends;
    return rim;
  }
  rim.along.normalize();
  const btScalar beside = rim.along.dot(way), over = std::hypot(beside, most);
  const btVector3 crest = (rim.normal * most + rim.along * beside) / over;
  rim.goes_on = crest.distance2(rim.normal) >= bends * bends;
  const btScalar curvature = rim.bend / edges;
  rim.bend = curvature * over;
  if (rim.goes_on || !(curvature > 0)) return rim;
  rim.to_crest = (crest - rim.normal) / curvature;
  rim.along = (rim.along * most - rim.normal * beside) / over;
  rim.normal = crest;
  return rim;
}

}  // namespace

bool cornersUphill(const PlacedPacking& body, std::size_t triangle, const btVector3& direction,
                   const btVector3& start, btScalar distance, std::vector<std::uint32_t>& vertices) {
  const btMatrix3x3& axes = body.world.getBasis();
  vertices.clear();
  return body.shape().vertexHillClimb().from(triangle, direction * axes, (start * axes) / body.scale(),
                                             distance / body.scale(), vertices);
}

SolidCorner::SolidCorner(const PlacedPacking& body, std::uint32_t vertex, const btVector3& way) {
  const btMatrix3x3& axes = body.world.getBasis();
  const SmoothNormals& normals = normalsOf(body);
  is_tip_ = normals.isTip(vertex);
  is_end_ = normals.isEnd(vertex);
  const Rim rim = is_tip_ ? Rim() : rimAt(body, vertex, way * axes);
  const btVector3 place = toBullet(body.shape().packing().surface.vertices[vertex]) + rim.to_crest;
  at_ = axes * (place * body.scale()) + way * body.margin;
  triangle_ = rim.triangle;
  if (triangle_ == OpposedPoints::kNone) return;
  normal_ = axes * rim.normal;
  curvature_ = normals.curvature(triangle_) / body.scale();
  along_ = axes * rim.along;
  bend_along_ = rim.bend / body.scale();
  goes_on_ = rim.goes_on;
}

void SolidCorner::giveTo(bool of_a, EdgeContact& contact) const {
  OpposedPoints& points = contact.points;
  contact.is_end = is_end_;
  if (is_tip_) (of_a ? points.curvature_a : points.curvature_b) = 0;
  if (triangle_ == OpposedPoints::kNone) return;
  (of_a ? points.normal_a : points.normal_b) = normal_ * btScalar(of_a ? 1 : -1);
  (of_a ? points.curvature_a : points.curvature_b) = curvature_;
  (of_a ? points.triangle_a : points.triangle_b) = triangle_;
  contact.along = along_;
  contact.bend_along = bend_along_;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
