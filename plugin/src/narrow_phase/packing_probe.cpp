#include "narrow_phase/packing_probe.hpp"

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include "common/contact_tolerances.hpp"
#include "narrow_phase/edge_edge.hpp"
#include "narrow_phase/edge_face.hpp"
#include "narrow_phase/face_overlap.hpp"
#include "narrow_phase/over_edge.hpp"
#include "narrow_phase/solid_corner.hpp"
#include "narrow_phase/surface_rays.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

bool PackingProbe::probe(const btVector3& patch_normal, btScalar separation, ProbedSample& sample) const {
  OpposedPoints start;
  const auto probeAlong = [&](const btVector3& direction) {
    sample.direction = direction;
    sample.points = start;
    return probeLine(sample.index, direction, btVector3(0, 0, 0), sample.points);
  };
  btVector3 to_nearest;
  // No line is longer than the way to the nearest point may be.
  if (!nearest(sample.index, to_nearest, start)) return false;
  bool found = probeAlong(to_nearest);
  if (found && sample.isFarFromBend(separation)) return true;
  if (found && runsBelowFace(sample)) return false;
  // A patch may hold a ledge beside its wall: spheres that are pushed to the ledge go there. Not through all
  // of a plate: small spheres at the rim of a thin one are pushed any way, also to the side of what stands on
  // it.
  const btVector3 pushed = toBullet(contacts_[sample.index].area);
  const bool fits = found && opposed(sample.points) &&
                    (to_nearest.dot(patch_normal) > kPatchCosine ||
                     (to_nearest.dot(pushed) > kPatchCosine * pushed.length() && leavesNear(sample)));
  if (!fits) found = probeAlong(patch_normal);
  if (!found) return false;
  align(sample);
  return !isPastValley(sample);
}

bool PackingProbe::probeNearest(const btVector3& patch_normal, ProbedSample& sample) const {
  sample.points = OpposedPoints();
  return nearest(sample.index, sample.direction, sample.points) &&
         sample.direction.dot(patch_normal) > kPatchCosine &&
         probeLine(sample.index, sample.direction, btVector3(0, 0, 0), sample.points) &&
         sample.points.areFlat() && !isPastValley(sample);
}

bool PackingProbe::probeAgain(const btVector3& patch_normal, btScalar separation, const Samples::Line& line,
                              ProbedSample& sample) const {
  if (line.direction.isZero()) return false;
  sample.direction = line.direction;
  sample.points.triangle_a = line.triangle_a;
  sample.points.triangle_b = line.triangle_b;
  // A line to an edge misses it when the bodies have moved.
  if (!probeLine(sample.index, sample.direction, btVector3(0, 0, 0), sample.points))
    return probe(patch_normal, separation, sample);
  align(sample);
  return !isPastValley(sample) || probe(patch_normal, separation, sample);
}

bool PackingProbe::runsBelowFace(const ProbedSample& sample) const {
  const bool of_a = sample.index < count_a_;
  const btScalar depth = sample.points.depthAlong(sample.direction);
  SurfaceQueries::Nearest face;
  return depth > 0 &&
         nearestWall(of_a, of_a ? sample.points.on_b : sample.points.on_a, kSliver * depth, face) &&
         btFabs(face.normal.dot(sample.direction)) < kPatchCosine;
}

bool PackingProbe::isPastValley(const ProbedSample& sample) const {
  const OpposedPoints& points = sample.points;
  if (opposed(points)) return false;
  const btScalar depth = points.depthAlong(sample.direction);
  return sample.index < count_a_ ? innersphere::isPastValley(a_, points.on_b, depth)
                                 : innersphere::isPastValley(b_, points.on_a - apart(), depth);
}

void PackingProbe::align(ProbedSample& sample) const {
  const btVector3 normal = normalAlone(sample.points, sample.direction);
  const bool parallel = sample.points.normal_a.dot(sample.points.normal_b) > kParallelCosine;
  if (normal.dot(sample.direction) > (parallel ? kAlignedOnFacesCosine : kParallelCosine)) return;
  OpposedPoints points;
  points.triangle_a = sample.points.triangle_a;
  points.triangle_b = sample.points.triangle_b;
  if (!probeLine(sample.index, normal, btVector3(0, 0, 0), points)) return;
  sample.direction = normal;
  sample.points = points;
}

bool PackingProbe::probeLine(std::size_t index, const btVector3& direction, const btVector3& shift,
                             OpposedPoints& points) const {
  const bool of_a = index < count_a_;
  const PlacedPacking& own = of_a ? a_ : b_;
  const PlacedPacking& other = of_a ? b_ : a_;
  const std::size_t sphere = contacts_[index].sphere;
  const btScalar radius = own.ownRadius(sphere);
  if (shift.length() > surfaceDistance(index)) return false;
  const btVector3 way = of_a ? direction : -direction;
  const btVector3 from = own.centreOf(sphere) + shift;
  const btVector3 to_other = other.origin() - own.origin();
  const btScalar length = 2 * (radius + a_.search_margin + b_.search_margin);
  SurfacePoint left, entered;
  if (!leaveSolid(own, from, way, longestInSolid(index, length), of_a ? points.triangle_a : points.triangle_b,
                  left) ||
      !enterSolid(other, from - to_other, way, length, of_a ? points.triangle_b : points.triangle_a,
                  left.normal, entered))
    return false;
  const btVector3 offset = own.origin() - a_.origin();
  left.at += offset;
  entered.at += offset + to_other;
  points.on_a = of_a ? left.at : entered.at;
  points.on_b = of_a ? entered.at : left.at;
  points.normal_a = of_a ? left.normal : entered.normal;
  points.normal_b = -(of_a ? entered.normal : left.normal);
  points.curvature_a = of_a ? left.curvature : entered.curvature;
  points.curvature_b = of_a ? entered.curvature : left.curvature;
  points.triangle_a = of_a ? left.triangle : entered.triangle;
  points.triangle_b = of_a ? entered.triangle : left.triangle;
  return true;
}

btVector3 PackingProbe::lineStart(std::size_t index) const {
  const PlacedPacking& own = index < count_a_ ? a_ : b_;
  return own.origin() - a_.origin() + own.centreOf(contacts_[index].sphere);
}

bool PackingProbe::nearest(std::size_t index, btVector3& direction, OpposedPoints& points) const {
  const bool of_a = index < count_a_;
  const PlacedPacking& own = of_a ? a_ : b_;
  const PlacedPacking& other = of_a ? b_ : a_;
  const std::size_t sphere = contacts_[index].sphere;
  const btVector3 centre = own.origin() + own.centreOf(sphere) - other.origin();
  const btScalar distance = 2 * (own.ownRadius(sphere) + a_.search_margin + b_.search_margin);
  (of_a ? points.triangle_a : points.triangle_b) = own.triangleNear(sphere);
  SurfaceQueries::Nearest nearest;
  if (!other.nearest(centre, distance, nearest)) return false;
  if (!nearest.beside) (of_a ? points.triangle_b : points.triangle_a) = nearest.triangle;
  direction = nearest.normal * btScalar(of_a ? -1 : 1);
  return true;
}

btScalar PackingProbe::meets(bool of_a, const btVector3& from, const btVector3& way) const {
  return of_a ? meetSolid(a_, from, way) : meetSolid(b_, from - apart(), way);
}

Bend PackingProbe::bend(bool of_a, const OpposedPoints& points, const Across& axes) const {
  return of_a ? bendAt(a_, points.triangle_a, axes) : bendAt(b_, points.triangle_b, axes);
}

void PackingProbe::corners(std::size_t index, const OpposedPoints& points, const btVector3& normal, bool of_a,
                           std::vector<std::uint32_t>& vertices, std::vector<EdgeContact>& corners) const {
  const btScalar size = surfaceDistance(index);
  const PlacedPacking& own = of_a ? a_ : b_;
  const PlacedPacking& other = of_a ? b_ : a_;
  // All of this is relative to the solid whose corners are looked for; `way` leads out of it.
  const btVector3 offset = of_a ? btVector3(0, 0, 0) : apart();
  const btVector3 to_other = of_a ? apart() : -apart();
  const btVector3 way = of_a ? normal : -normal;
  const btVector3 start = (of_a ? points.on_a : points.on_b) - offset;
  const btVector3 face = (of_a ? points.on_b : points.on_a) - offset;
  const btScalar reach = size + acrossBend(of_a ? points.curvature_a : points.curvature_b);
  const bool is_peak =
      cornersUphill(own, of_a ? points.triangle_a : points.triangle_b, way, start, reach, vertices);
  for (const std::uint32_t vertex : vertices) {
    const SolidCorner found(own, vertex, way);
    const btVector3& at = found.at();
    SurfacePoint under;
    const btScalar depth = (at - face).dot(way);
    const btVector3 place = at - way * depth - to_other;
    if (!faceUnder(other, place, -way, depth, size, under)) continue;
    EdgeContact corner{points, kCornerId + (of_a ? 0 : 1) + 2 * std::uint64_t(vertex), is_peak};
    (of_a ? corner.points.on_a : corner.points.on_b) = at + offset;
    (of_a ? corner.points.on_b : corner.points.on_a) = under.at + to_other + offset;
    (of_a ? corner.points.normal_b : corner.points.normal_a) = under.normal * btScalar(of_a ? -1 : 1);
    found.giveTo(of_a, corner);
    corner.is_beside = found.goesOn() && !(is_peak && vertex == vertices.front());
    corners.push_back(corner);
  }
}

bool PackingProbe::hasEnds(bool of_a) const {
  return normalsOf(of_a ? a_ : b_).hasEnds();
}

void PackingProbe::overlap(const OpposedPoints& points, const btVector3& normal, FaceOverlaps& overlaps,
                           std::vector<EdgeContact>& crossings) const {
  followOverlap({a_, {0, 0, 0}}, {b_, apart()}, points, normal, overlaps, crossings);
}

bool PackingProbe::isThinAt(const OpposedPoints& points) const {
  const auto isThin = [](const PlacedPacking& body, std::size_t triangle, const btVector3& place,
                         const btVector3& normal) {
    const btMatrix3x3& axes = body.world.getBasis();
    const btScalar thickness = 2 * gContactBreakingThreshold * body.shape().size / body.scale();
    const btVector3 on_surface = ((place - normal * body.margin) * axes) / body.scale();
    return body.shape().surfaceQueries().isThinner(thickness, triangle, on_surface, normal * axes);
  };
  return thin_ || isThin(a_, points.triangle_a, points.on_a, points.normal_a) ||
         isThin(b_, points.triangle_b, points.on_b - apart(), -points.normal_b);
}

bool PackingProbe::crossing(const OpposedPoints& points, const btVector3& direction,
                            EdgeContact& crossing) const {
  const auto is_thin = [&] { return isThinAt(points); };
  return crossEdges({a_, {0, 0, 0}}, {b_, apart()}, points, direction, crossing, is_thin);
}

bool PackingProbe::edgeOnFace(const OpposedPoints& points, bool of_a, const btVector3& normal,
                              std::vector<EdgeContact>& ends) const {
  return layEdgeOnFace({a_, {0, 0, 0}}, {b_, apart()}, of_a, points, normal, ends);
}

EdgeProbe::FaceEnd PackingProbe::overEdge(const OpposedPoints& points, bool of_a, const btVector3& to_top,
                                          EdgeContact& edge) const {
  const PlacedPacking& round = of_a ? b_ : a_;
  const btVector3 offset = of_a ? apart() : btVector3(0, 0, 0);
  // Along a cylinder rounding alone makes the fall to the top, and the top any way off.
  const btScalar far =
      btMin(to_top.length() + btFabs(points.depthAlong(points.normal_a)), round.shape().size);
  const auto nearest_round = [&](const btVector3& place, RoundPoint& found) {
    SurfaceQueries::Nearest nearest;
    if (!round.nearest(place - offset, far, nearest)) return false;
    SurfacePoint left;
    const btScalar back = far + round.margin;
    if (!leaveSolid(round, place - offset - nearest.normal * (nearest.distance + back), nearest.normal,
                    2 * back, nearest.triangle, left))
      return false;
    found = {left.at + offset, left.normal};
    return true;
  };
  return of_a ? lieOverEdge({a_, {0, 0, 0}}, true, std::cref(nearest_round), points, to_top, edge)
              : lieOverEdge({b_, apart()}, false, std::cref(nearest_round), points, to_top, edge);
}

FaceExtents::EdgeDistances PackingProbe::edgeDistances(const OpposedPoints& points,
                                                       const btVector3& towards) const {
  return {SharpEdges(a_, {0, 0, 0}).untilEdge(points.triangle_a, points.on_a, towards),
          SharpEdges(b_, apart()).untilEdge(points.triangle_b, points.on_b, towards)};
}

std::uint64_t PackingProbe::id(std::size_t index) const {
  return 2 * std::uint64_t(contacts_[index].sphere) + (index < count_a_ ? 0 : 1);
}

ContactSpheres::Protrusion PackingProbe::protrusion(std::size_t index, const btVector3& normal) const {
  const bool of_a = index < count_a_;
  const PlacedPacking& own = of_a ? a_ : b_;
  const std::size_t sphere = contacts_[index].sphere;
  return {of_a, (of_a ? 1 : -1) * own.centreOf(sphere).dot(normal) + own.ownRadius(sphere)};
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
