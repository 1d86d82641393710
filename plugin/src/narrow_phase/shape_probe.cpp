#include "narrow_phase/shape_probe.hpp"

#include <algorithm>
#include <cmath>

#include "common/contact_tolerances.hpp"
#include "narrow_phase/edge_edge.hpp"
#include "narrow_phase/edge_face.hpp"
#include "narrow_phase/face_overlap.hpp"
#include "narrow_phase/over_edge.hpp"
#include "narrow_phase/surface_rays.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

bool ShapeProbe::probe(ProbedSample& sample) const {
  nearest(sample.index, sample.direction, sample.points);
  return probeDirectly(sample);
}

bool ShapeProbe::probeAgain(const Samples::Line& line, ProbedSample& sample) const {
  if (line.direction.isZero()) return false;
  nearest(sample.index, sample.direction, sample.points);
  sample.points.triangle_a = line.triangle_a;
  sample.points.triangle_b = line.triangle_b;
  return probeDirectly(sample);
}

bool ShapeProbe::probeDirectly(ProbedSample& sample) const {
  const bool found = probeLine(sample.index, sample.direction, btVector3(0, 0, 0), sample.points);
  const bool past = found && !opposed(sample.points) &&
                    isPastValley(a_, sample.points.on_b, sample.points.depthAlong(sample.direction));
  if (past) sample.points.triangle_a = OpposedPoints::kNone;
  return found && !past;
}

bool ShapeProbe::probeLine(std::size_t index, const btVector3& direction, const btVector3& shift,
                           OpposedPoints& points) const {
  const NearSphere& near_sphere = near_spheres_[index];
  const btScalar size = surfaceDistance(near_sphere);
  const btVector3 from = a_.centreOf(near_sphere.sphere) + near_sphere.aside + shift;
  NearSphere near_place = near_sphere;
  // What starts further back may go further aside.
  const btScalar back = btMax(-shift.dot(direction), btScalar(0));
  if (shift.length2() > 0 && ((shift + direction * back).length() > size + back ||
                              !nearestBeside(near_sphere, from, shift, near_place)))
    return false;
  const btVector3 towards_b = -near_place.normal;
  points.on_b = from + towards_b * near_place.distance;
  SurfacePoint on_a;
  const bool leaves = leaveSolid(a_, from, towards_b, 2 * size + back, points.triangle_a, on_a);
  if (on_a.triangle == OpposedPoints::kNone && points.triangle_a != OpposedPoints::kNone) {
    // Deep in A: it is some other face that is near.
    const SharpEdges a(a_, {0, 0, 0});
    on_a.triangle = points.triangle_a;
    on_a.at = a.middle(points.triangle_a);
    on_a.normal = a.face(points.triangle_a);
    on_a.curvature = a.surface->normals().curvature(points.triangle_a) / a.scale;
  }
  points.on_a = on_a.at;
  points.normal_a = on_a.normal;
  points.curvature_a = on_a.curvature;
  points.triangle_a = on_a.triangle;
  points.normal_b = towards_b;
  points.curvature_b = near_place.curvature;
  points.straight_b = near_place.straight;
  points.along_straight_b = near_place.along_straight;
  return leaves;
}

bool ShapeProbe::nearestBeside(const NearSphere& near_sphere, const btVector3& from, const btVector3& shift,
                               NearSphere& near_place) const {
  if (near_sphere.isOnEdge()) return false;
  if (other_.nearestTo(a_, world_, from, near_place)) return true;
  // Only of a flat surface it is known what it is like beside the nearest point.
  near_place.distance += near_sphere.normal.dot(shift);
  return near_sphere.curvature == 0 && goesOn(near_sphere, from - near_sphere.normal * near_place.distance);
}

/// From there the nearest place of B goes with the line: seen from close by, it stays on an edge, and jumps.
btVector3 ShapeProbe::toMiddleOfBend(const ProbedSample& sample) const {
  if (!hasEdges() || !(sample.points.curvature_a > 0)) return {0, 0, 0};
  const btScalar height = (sample.points.on_a - lineStart(sample.index)).dot(sample.direction);
  return sample.direction * btMin(height - 1 / sample.points.curvature_a, btScalar(0));
}

bool ShapeProbe::goesOn(const NearSphere& near_sphere, const btVector3& place) const {
  // A little above a face it is that far away, and the face is below; beyond its edge it is further, and
  // aside. Bullet knows how deep a place is in a hull to a part of the hull's size only, so that `place` may
  // itself be above the face.
  const btScalar radius = a_.searchRadius(near_sphere.sphere);
  const btVector3 above = place + near_sphere.normal * (kAboveFace * radius);
  constexpr btScalar kBelow = kAboveFace / (kAboveFace + kBeyondFace);  // the same angle
  NearSphere seen;
  btScalar distance = 0;
  if (other_.nearestTo(a_, world_, above, seen)) {
    if (seen.normal.dot(near_sphere.normal) > kBelow) return true;
    distance = seen.distance;
  } else if (!other_.distanceOf(a_, world_, above, distance)) {
    return true;
  }
  // On a large ground.
  const btScalar rounding = 4 * SIMD_EPSILON * (a_.origin() + above - world_.getOrigin()).length();
  return distance < (kAboveFace + kBeyondFace) * radius + rounding;
}

bool ShapeProbe::nearest(std::size_t index, btVector3& direction, OpposedPoints& points) const {
  points.triangle_a = a_.triangleNear(near_spheres_[index].sphere);
  direction = -near_spheres_[index].normal;
  return true;
}

Bend ShapeProbe::bendOfFacets(const OpposedPoints& points, const Across& axes) const {
  SharpEdges b;
  std::size_t triangle = OpposedPoints::kNone;
  if (!other_.isMesh() || !faceOfB(points, b, triangle)) return {};
  const btVector3 x = axes.x * b.axes, y = axes.y * b.axes;
  const btScalar unit = (b.inside_out ? -1 : 1) / b.scale;
  const btVector3 along_x = b.surface->normals().turn(triangle, x) * unit;
  const btVector3 along_y = b.surface->normals().turn(triangle, y) * unit;
  const Bend bend{along_x.dot(x), (along_x.dot(y) + along_y.dot(x)) / 2, along_y.dot(y)};
  return bend.mean() < 0 ? bend : Bend{};
}

Bend ShapeProbe::bend(bool of_a, const OpposedPoints& points, const Across& axes) const {
  if (of_a) return bendAt(a_, points.triangle_a, axes);
  if (points.curvature_b == 0) return bendOfFacets(points, axes);
  btScalar x = points.straight_b.dot(axes.x), y = points.straight_b.dot(axes.y);
  const btScalar c = points.curvature_b, less = c - points.along_straight_b, length = std::hypot(x, y);
  // Straight to the last digit: else there is a top, far away.
  if (length > kUsableCosine) {
    x /= length;
    y /= length;
  }
  return {c - less * x * x, -less * x * y, c - less * y * y};
}

const NearSphere* ShapeProbe::sphereOver(const btVector3& corner, const btVector3& normal) const {
  static thread_local FaceSpheres spheres;
  if (!has_face_spheres_ || spheres.probe != this) findFaceSpheres(spheres);
  has_face_spheres_ = true;
  const NearSphere* over = nullptr;
  btScalar least = BT_LARGE_FLOAT;
  // In the packing's frame: there are many spheres, and the corner is turned once.
  const btVector3 place = corner * a_.world.getBasis() / a_.scale();
  const btScalar scale2 = a_.scale() * a_.scale();
  const std::size_t count = spheres.x.size();
  for (std::size_t k = 0; k < count; ++k) {  // by lanes
    const btScalar x = place.x() - spheres.x[k], y = place.y() - spheres.y[k], z = place.z() - spheres.z[k];
    spheres.distance2[k] = (x * x + y * y + z * z) * scale2;
  }
  for (std::size_t k = 0; k < count; ++k) {
    const btScalar distance2 = spheres.distance2[k];
    if (!(distance2 < least) || !(distance2 < spheres.size2[k])) continue;
    if (!(spheres.spheres[k]->normal.dot(-normal) > kSameFaceCosine)) continue;
    least = distance2;
    over = spheres.spheres[k];
  }
  return over;
}

void ShapeProbe::findFaceSpheres(FaceSpheres& found) const {
  found.probe = this;
  found.spheres.clear();
  for (std::vector<btScalar>* column : {&found.x, &found.y, &found.z, &found.size2}) column->clear();
  for (const NearSphere& near_sphere : near_spheres_) {
    if (near_sphere.isOnEdge()) continue;
    const Sphere& sphere = a_.sphere(near_sphere.sphere);
    const btScalar size = surfaceDistance(near_sphere);
    found.spheres.push_back(&near_sphere);
    found.x.push_back(sphere.x);
    found.y.push_back(sphere.y);
    found.z.push_back(sphere.z);
    found.size2.push_back(size * size);
  }
  found.distance2.resize(found.x.size());
}

void ShapeProbe::corners(std::size_t index, const OpposedPoints& points, const btVector3& normal, bool of_a,
                         std::vector<std::uint32_t>& vertices, std::vector<EdgeContact>& corners) const {
  if (!of_a) return;
  const btScalar reach = surfaceDistance(near_spheres_[index]) + acrossBend(points.curvature_a);
  const bool is_peak = cornersUphill(a_, points.triangle_a, normal, points.on_a, reach, vertices);
  for (const std::uint32_t vertex : vertices) {
    const Corner& found = cornerOf(vertex, normal);
    if (!found.is_over) continue;
    EdgeContact corner{points, kCornerId + 2 * std::uint64_t(vertex), is_peak};
    corner.points.on_a = found.of_a.at();
    corner.points.on_b = found.on_b;
    corner.points.normal_b = found.normal_b;
    found.of_a.giveTo(true, corner);
    corner.is_beside = found.of_a.goesOn() && !(is_peak && vertex == vertices.front());
    corners.push_back(corner);
  }
}

bool ShapeProbe::hasEnds(bool of_a) const {
  return of_a && normalsOf(a_).hasEnds();
}

const ShapeProbe::Corner& ShapeProbe::cornerOf(std::uint32_t vertex, const btVector3& normal) const {
  const auto known = std::find_if(corners_.begin(), corners_.end(), [&](const Corner& corner) {
    return corner.vertex == vertex && corner.normal == normal;
  });
  if (known != corners_.end()) return *known;
  Corner& corner = corners_[corner_count_++ % corners_.size()];
  corner = {vertex, normal, {a_, vertex, normal}};
  const btVector3& at = corner.of_a.at();
  // The face is known where spheres are near it.
  const NearSphere* over = sphereOver(at, normal);
  if (over == nullptr) return corner;
  const btScalar height = (at - a_.centreOf(over->sphere)).dot(over->normal) + over->distance;
  corner.on_b = at - over->normal * height;
  corner.normal_b = -over->normal;
  corner.is_over = goesOn(*over, corner.on_b);
  return corner;
}

void ShapeProbe::tips(const OpposedPoints& points, std::vector<std::uint32_t>& vertices,
                      std::vector<EdgeContact>& tips) const {
  const btVector3& into_b = points.normal_b;
  if (!other_.isMesh() ||
      !cornersUphill(a_, points.triangle_a, into_b, points.on_a, BT_LARGE_FLOAT, vertices))
    return;
  for (const std::uint32_t vertex : vertices) {
    const SolidCorner found(a_, vertex, into_b);
    const btVector3& at = found.at();
    // As deep if the mesh is flat; it may as well rise.
    btScalar depth = (at - points.on_b).dot(into_b);
    if (!(depth > 0) || !other_.depthOf(a_, world_, at, -into_b, 2 * depth, depth)) continue;
    EdgeContact tip{points, kCornerId + 2 * std::uint64_t(vertex)};
    tip.points.on_a = at;
    tip.points.on_b = at - into_b * depth;
    // A vertex of what is round is on the hill that the round surface is.
    found.giveTo(true, tip);
    tips.push_back(tip);
  }
}

bool ShapeProbe::crossing(const OpposedPoints& points, const btVector3& direction,
                          EdgeContact& crossing) const {
  SharpEdges b;
  OpposedPoints start = points;
  if (!faceOfB(points, b, start.triangle_b)) return false;
  crossing.is_alone = btFabs(b.face(start.triangle_b).dot(points.normal_b)) < kSameFaceCosine;
  return crossEdges({a_, {0, 0, 0}}, b, start, direction, crossing);
}

bool ShapeProbe::edgeOnFace(const OpposedPoints& points, bool of_a, const btVector3& normal,
                            std::vector<EdgeContact>& ends) const {
  SharpEdges b;
  OpposedPoints start = points;
  return faceOfB(points, b, start.triangle_b) && layEdgeOnFace({a_, {0, 0, 0}}, b, of_a, start, normal, ends);
}

FaceExtents::EdgeDistances ShapeProbe::edgeDistances(const OpposedPoints& points,
                                                     const btVector3& towards) const {
  SharpEdges b;
  std::size_t triangle_b;
  btScalar until_b = BT_LARGE_FLOAT;
  if (faceOfB(points, b, triangle_b)) {
    // Else the nearest point of B is on an edge, and its normal that of no face.
    const bool on_face = btFabs(b.face(triangle_b).dot(points.normal_b)) > 1 - kLeaning * kLeaning;
    until_b = on_face ? b.untilEdge(triangle_b, points.on_b, towards) : btScalar(0);
  }
  return {SharpEdges(a_, {0, 0, 0}).untilEdge(points.triangle_a, points.on_a, towards), until_b};
}

EdgeProbe::FaceEnd ShapeProbe::overEdge(const OpposedPoints& points, bool of_a, const btVector3& to_top,
                                        EdgeContact& edge) const {
  if (!of_a) return FaceEnd::unknown;
  const btScalar far = to_top.length() + btFabs(points.depthAlong(points.normal_a));
  const auto nearest_round = [&](const btVector3& place, RoundPoint& found) {
    SurfaceQueries::Nearest nearest;
    if (!nearestOfB(place, far, nearest)) return false;
    found = {place - nearest.normal * nearest.distance, nearest.normal};
    return true;
  };
  return lieOverEdge({a_, {0, 0, 0}}, true, std::cref(nearest_round), points, to_top, edge);
}

void ShapeProbe::lineEnds(const OpposedPoints& points, std::vector<EdgeContact>& ends) const {
  btVector3 line[2];
  const btVector3& face = points.normal_a;
  if (points.curvature_a != 0 || !(points.curvature_b > 0) || !other_.line(a_, world_, -face, line)) return;
  const btVector3 along = line[1] - line[0], out = along.cross(face).cross(along);
  // Where it does not all but lie on the face, its deeper end is found as what bends.
  if (!(btFabs(face.dot(along)) < kSlopeBeside * along.length())) return;
  NearSphere seen;
  EdgeContact end{points};
  if (!other_.nearestTo(a_, world_, (line[0] + line[1]) / 2, seen)) return;
  end.points.normal_b = out.normalized();
  end.points.curvature_b = seen.curvature;
  end.points.straight_b = seen.straight;
  end.points.along_straight_b = seen.along_straight;
  const SharpEdges a(a_, {0, 0, 0});
  for (const int side : {0, 1}) {
    const auto onFace = [&](const btVector3& place) { return place + face * face.dot(points.on_a - place); };
    SmoothNormals::Walked walked;
    if (!a.walk(points.triangle_a, points.on_a, onFace(line[side]) - points.on_a, 1, walked) ||
        walked.edge != SmoothNormals::kNoEdge)
      continue;
    end.id = kCornerId + 1 + 2 * std::uint64_t(side);
    end.points.on_b = line[side];
    end.points.on_a = onFace(line[side]);
    end.points.triangle_a = walked.triangle;
    ends.push_back(end);
  }
}

void ShapeProbe::overlap(const OpposedPoints& points, const btVector3& normal, FaceOverlaps& overlaps,
                         std::vector<EdgeContact>& crossings) const {
  SharpEdges b;
  OpposedPoints start = points;
  if (!faceOfB(points, b, start.triangle_b)) {
    overlaps.sides_left = 0;
    return;
  }
  followOverlap({a_, {0, 0, 0}}, b, start, normal, overlaps, crossings);
}

bool ShapeProbe::faceOfB(const OpposedPoints& points, SharpEdges& b, std::size_t& triangle) const {
  // Seen from outside.
  const btVector3 place = points.on_b - points.normal_b * a_.search_margin;
  return other_.facets(a_, world_, b) && b.nearestTriangle(place, triangle);
}

bool ShapeProbe::isOnFaceOfB(const OpposedPoints& points) const {
  SharpEdges b;
  std::size_t triangle;
  return !faceOfB(points, b, triangle) || btFabs(b.face(triangle).dot(points.normal_b)) > kSameFaceCosine;
}

ContactSpheres::Protrusion ShapeProbe::protrusion(std::size_t index, const btVector3&) const {
  return {true, depth(index)};
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
