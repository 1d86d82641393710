#include "narrow_phase/patch_contact_points.hpp"

#include <algorithm>

#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Whether a surface is deeper beside the place where it was probed.
bool leans(const btVector3& face, const btVector3& normal) {
  return face.distance2(normal) > kLeaning * kLeaning;
}

/// Whether a surface leans and not the other one, or so far that these do not lie on each other.
bool goesOn(const btVector3& face, const btVector3& other, const btVector3& normal) {
  return leans(face, normal) && (!leans(other, normal) || face.dot(normal) < kOpposedCosine);
}

/// Whether a corner of a flat surface is deeper.
bool rises(const btVector3& face, btScalar curvature, const btVector3& normal) {
  return curvature == 0 && leans(face, normal);
}

/// Whether what bends ends in a corner, and rises towards there, now or when it has turned: not only along
/// the rim.
bool endsDeeper(const EdgeContact& corner, bool of_a, const btVector3& normal, const btVector3& turn) {
  if (!corner.is_end || corner.along.isZero()) return corner.is_end;
  const btVector3 across = corner.along.cross(of_a ? corner.points.normal_a : corner.points.normal_b);
  return across.dot(normal) + btMax(btScalar(0), (of_a ? turn : -turn).cross(across).dot(normal)) > kLeaning;
}

/// The normal turns with the face that it belongs to.
btScalar shareOfA(const OpposedPoints& points, const btVector3& normal) {
  const btScalar from_a = points.normal_a.distance(normal), from_b = points.normal_b.distance(normal);
  return from_a + from_b > SIMD_EPSILON ? from_b / (from_a + from_b) : btScalar(0.5);
}

/// Axes across one normal as across another one.
Across turned(const Across& axes, const btVector3& from, const btVector3& to) {
  const btQuaternion turn = shortestArcQuat(from, to);
  return {quatRotate(turn, axes.x), quatRotate(turn, axes.y)};
}

/// Of an edge or a corner, of A or of B, on what bends below it.
void setEdgeBends(bool of_a, const Bend& sharp, const Bend& below, const Across& axes, ContactPoint& point) {
  point.bend_a = of_a ? sharp : below;
  point.bend_b = of_a ? below : sharp;
  point.bend_x = axes.x;
}

}  // namespace

PatchContactPoints::PatchContactPoints(const EdgeProbe& probe, const SurfaceProbe& surfaces,
                                       const Samples::OfPatch& patch, const ContactReach& reach,
                                       SampleScratch& scratch, std::vector<WeightedPoint>& found)
    : probe_(probe),
      surfaces_(surfaces),
      patch_(patch),
      reach_(reach),
      scratch_(scratch),
      found_(found),
      first_(found.size()) {
  scratch_.overlaps.clear();
}

void PatchContactPoints::addSample(const ProbedSample& sample, const btVector3& normal) {
  const OpposedPoints& points = sample.points;
  addLineEnds(points);
  const bool rises_a = rises(points.normal_a, points.curvature_a, normal),
             rises_b = rises(points.normal_b, points.curvature_b, normal);
  std::vector<EdgeContact>& corners = scratch_.corners;
  const bool of_a = findCorners(sample, normal, rises_a, rises_b);
  EdgeContact crossing;
  const bool lie = points.normal_a.dot(points.normal_b) > kAlignedOnFacesCosine;
  const bool crosses = points.areFlat() && !lie && addCrossing(points, crossing);
  if (points.areFlat() && lie) addOverlap(points, normal);
  if (crosses && crossing.is_alone) corners.clear();
  for (const EdgeContact& corner : corners) addCorner(corner, of_a);
  // What bends lies on a line up to its end.
  bool has_corners = !corners.empty() && (of_a ? points.curvature_a : points.curvature_b) == 0;
  if (points.areFlat() && !lie && !crosses && rises_a != rises_b && !has_corners)
    has_corners = addEdge(points, rises_a, normal);
  // Where neither face lies flat, a corner of the one may be deep in the other all the same.
  if (rises_a && rises_b && !crosses) {
    for (const bool a : {true, false}) has_corners = addPeaks(sample, a) || has_corners;
  }
  // A face that lies flat on another ends in corners, which bear it better than what spheres are over.
  if (points.areFlat() && !rises_a && !rises_b && !crosses) addEnds(sample, normal);
  // Beside them the face is less deep, or, where it ends in an arc, not there.
  if (has_corners || crosses) return;
  btVector3 to_top(0, 0, 0);
  switch (addOverEdge(sample, to_top)) {
    case FaceEnd::in_edge:
      break;
    case FaceEnd::on_face:
      addFace(sample, points.curvature_a == 0 ? points.normal_a : points.normal_b);
      break;
    case FaceEnd::beyond:
      if (addFace(sample, normal)) found_.back().beyond_end = to_top.length();
      break;
    case FaceEnd::unknown:
      addFace(sample, normal);
  }
}

/// Finds corners of the face that rises, or ends of what bends that leans. Returns whose they are.
bool PatchContactPoints::findCorners(const ProbedSample& sample, const btVector3& normal, bool rises_a,
                                     bool rises_b) {
  const OpposedPoints& points = sample.points;
  std::vector<EdgeContact>& corners = scratch_.corners;
  corners.clear();
  if (rises_a != rises_b) probe_.corners(sample.index, points, normal, rises_a, scratch_.vertices, corners);
  if (!corners.empty()) return rises_a;
  const bool of_a =
      points.curvature_a > 0 && goesOn(points.normal_a, points.normal_b, normal) && probe_.hasEnds(true);
  if (of_a ||
      (points.curvature_b > 0 && goesOn(points.normal_b, points.normal_a, normal) && probe_.hasEnds(false))) {
    probe_.corners(sample.index, points, normal, of_a, scratch_.vertices, corners);
    std::erase_if(corners,
                  [&](const EdgeContact& corner) { return !endsDeeper(corner, of_a, normal, reach_.turn); });
  }
  return of_a;
}

void PatchContactPoints::addBeside(const ProbedSample& sample) {
  EdgeContact crossing;
  if (!sample.points.areFlat() || !addCrossing(sample.points, crossing)) addPeaks(sample, true);
}

void PatchContactPoints::addTips(const ShapeProbe& probe, const ProbedSample& sample) {
  scratch_.corners.clear();
  probe.tips(sample.points, scratch_.vertices, scratch_.corners);
  for (const EdgeContact& tip : scratch_.corners) addCorner(tip, true);
}

bool PatchContactPoints::addCrossing(const OpposedPoints& points, EdgeContact& crossing) {
  return probe_.crossing(points, patch_.normal, crossing) &&
         (isFound(crossing.id) ||
          add(crossing.points, crossing.points.normal_a, crossing.id, Kind::crossing));
}

void PatchContactPoints::shareOutArea() {
  btVector3 centre(0, 0, 0);
  for (std::size_t i = first_; i < found_.size(); ++i) centre += found_[i].point.on_b;
  for (std::size_t i = first_; i < found_.size(); ++i) {
    const btScalar count = btScalar(found_.size() - first_);
    found_[i].area = patch_.area / count;
    found_[i].centre = centre / count;
    found_[i].radius = patch_.radius;
  }
}

bool PatchContactPoints::isFound(std::uint64_t id, const btVector3* normal) const {
  return std::any_of(found_.begin(), found_.end(), [&](const WeightedPoint& f) {
    return f.point.id == id && (normal == nullptr || f.point.normal.dot(*normal) > kAlignedOnFacesCosine);
  });
}

bool PatchContactPoints::add(const OpposedPoints& points, const btVector3& normal, std::uint64_t id,
                             Kind kind) {
  const btScalar depth = points.depthAlong(normal);
  const bool near = depth > -reach_.separation;
  if (!near) return false;
  WeightedPoint& point = found_.emplace_back();
  point.point.on_b = points.on_b;
  point.point.normal = normal;
  point.point.depth = depth;
  point.point.id = id;
  point.point.turn_a = shareOfA(points, normal);
  point.across = points.on_a - points.on_b - normal * depth;
  point.kind = kind;
  return true;
}

/// Along the normal of the face that the corner is over.
bool PatchContactPoints::addCorner(const EdgeContact& corner, bool of_a) {
  const OpposedPoints& points = corner.points;
  if (corner.is_beside || isFound(corner.id) ||
      !add(points, of_a ? points.normal_b : points.normal_a, corner.id,
           corner.is_peak ? Kind::corner : Kind::edge))
    return false;
  const btScalar bends_here = of_a ? points.curvature_a : points.curvature_b,
                 bends_below = of_a ? points.curvature_b : points.curvature_a;
  if (bends_below != 0) {
    // It goes over what bends, whose normal it has.
    const Across axes(found_.back().point.normal);
    setEdgeBends(of_a, Bend::round(kEdgeSharpness * btFabs(bends_below)), surfaces_.bend(!of_a, points, axes),
                 axes, found_.back().point);
  } else if (bends_here > 0) {
    layOnHill(corner, of_a, found_.back());
  }
  return true;
}

void PatchContactPoints::addLineEnds(const OpposedPoints& points) {
  std::vector<EdgeContact>& ends = scratch_.peaks;
  ends.clear();
  probe_.lineEnds(points, ends);
  for (const EdgeContact& end : ends) {
    const btVector3& normal = end.points.normal_a;
    if (!isFound(end.id, &normal) && add(end.points, normal, end.id, Kind::edge))
      layOnHill(end, true, found_.back());
  }
}

/// Lays what was found at a corner of A, or else of B, or at the end of a line, on a hill of its own. In a
/// rim, where it is at the top, it falls along the rim only: across it there is no more of what bends.
void PatchContactPoints::layOnHill(const EdgeContact& corner, bool of_a, WeightedPoint& point) {
  const OpposedPoints& points = corner.points;
  const Across axes(point.point.normal);
  point.bends = true;
  point.slope = points.normal_b - points.normal_a;
  SurfaceProbe::Bends bends = surfaces_.bends(points, axes);
  point.is_top = !corner.along.isZero();
  if (point.is_top) {
    const btVector3 across = corner.along.cross(point.point.normal).normalized();
    (of_a ? bends.a : bends.b) = Bend::about(across, axes, corner.bend_along);
  }
  layOnHill(points, axes, bends, true, point);
}

/// Notes how the surfaces bend where a point was found, and where the top of its hill is.
void PatchContactPoints::layOnHill(const OpposedPoints& points, const Across& axes,
                                   const SurfaceProbe::Bends& bends, bool has_crest, WeightedPoint& point) {
  point.point.bend_a = bends.a;
  point.point.bend_b = bends.b;
  point.point.bend_x = axes.x;
  if (point.is_top) return;
  const Hill hill(bends.a, bends.b, point.point.depth, axes);
  point.point.to_top = hill.toTop(point.slope);
  point.point.below_top = point.slope.dot(point.point.to_top) / 2;
  if (has_crest && hill.isStraightRidge()) goToCrest(points, axes, point);
}

/// Along a straight ridge contacts are a line, of which the ends bear. What is all but on the crest is
/// taken there: beside it, it would brake what rolls.
void PatchContactPoints::goToCrest(const OpposedPoints& points, const Across& axes, WeightedPoint& point) {
  ContactPoint& p = point.point;
  if (p.to_top.length() > kSameTop * reach_.separation) return;
  p.on_b += p.to_top;
  p.depth += p.below_top;
  // Where both agree there: a ridge that leans along itself bears along the normal of what it is over.
  const btVector3 on_a = points.normal_a + p.bend_a.turn(p.to_top, axes),
                  on_b = points.normal_b - p.bend_b.turn(p.to_top, axes);
  if (!leans(on_a, on_b)) p.normal = on_b.normalized();
  p.to_top.setZero();
  p.below_top = 0;
  point.slope.setZero();
}

/// Where edges of two faces cross that lie on each other: with the corners they span what both share.
void PatchContactPoints::addOverlap(const OpposedPoints& points, const btVector3& normal) {
  FaceOverlaps& overlaps = scratch_.overlaps;
  if (!overlaps.hasRoom() || !(points.depthAlong(normal) > -reach_.separation) ||
      overlaps.covers(points.on_b, normal))
    return;
  std::vector<EdgeContact>& crossings = scratch_.peaks;
  crossings.clear();
  probe_.overlap(points, normal, overlaps, crossings);
  for (const EdgeContact& crossing : crossings) {
    if (!isFound(crossing.id)) add(crossing.points, normal, crossing.id, Kind::corner);
  }
}

/// An edge that goes on beyond the face which it lies on. True if it does so both ways.
bool PatchContactPoints::addEdge(const OpposedPoints& points, bool of_a, const btVector3& normal) {
  std::vector<EdgeContact>& ends = scratch_.peaks;
  ends.clear();
  const bool both = probe_.edgeOnFace(points, of_a, normal, ends);
  for (const EdgeContact& end : ends) {
    if (!isFound(end.id)) add(end.points, end.points.normal_a, end.id, Kind::corner);
  }
  return both;
}

/// Corners that reach furthest out of the other face. True if one was added.
bool PatchContactPoints::addPeaks(const ProbedSample& sample, bool of_a) {
  const btVector3& face = of_a ? sample.points.normal_b : sample.points.normal_a;
  std::vector<EdgeContact>& peaks = scratch_.peaks;
  peaks.clear();
  probe_.corners(sample.index, sample.points, face, of_a, scratch_.vertices, peaks);
  bool added = false;
  for (const EdgeContact& corner : peaks) added = (corner.is_peak && addCorner(corner, of_a)) || added;
  return added;
}

void PatchContactPoints::addEnds(const ProbedSample& sample, const btVector3& normal) {
  for (const bool of_a : {true, false}) {
    scratch_.corners.clear();
    probe_.corners(sample.index, sample.points, normal, of_a, scratch_.vertices, scratch_.corners);
    for (const EdgeContact& corner : scratch_.corners) addCorner(corner, of_a);
  }
}

/// What is round may lie on the edge in which a flat face ends, before the place on it that would be
/// deepest: `to_top`, from the sample's.
EdgeProbe::FaceEnd PatchContactPoints::addOverEdge(const ProbedSample& sample, btVector3& to_top) {
  const OpposedPoints& points = sample.points;
  const bool of_a = points.curvature_a == 0;
  const btScalar round = of_a ? points.curvature_b : points.curvature_a;
  if (sample.is_top || round == 0 || (of_a ? points.curvature_a : points.curvature_b) != 0)
    return FaceEnd::unknown;
  // From the place on the face to below that where the round surface has its normal.
  const btVector3& face = of_a ? points.normal_a : points.normal_b;
  const Across axes(face);
  const btVector3& round_normal = of_a ? points.normal_b : points.normal_a;
  const Bend below = surfaces_.bend(!of_a, points, turned(axes, face, round_normal));
  const btVector3 lean = points.normal_b - points.normal_a,
                  across = of_a ? points.on_b - points.on_a : points.on_a - points.on_b;
  to_top = Hill(below, Bend(), 0, axes).toTop(lean) + across;
  to_top -= face * face.dot(to_top);
  // In a hollow it lies with its ends, wherever it leans to.
  if (round < 0) to_top = (lean - face * face.dot(lean)) * (-1 / (round * lean.length() + SIMD_EPSILON));
  EdgeContact edge;
  const FaceEnd end = probe_.overEdge(points, of_a, to_top, edge);
  if (end != FaceEnd::in_edge) return round < 0 ? FaceEnd::unknown : end;
  const btVector3& normal = edge.points.normal_a;
  // A hollow along the edge is deepest beside there.
  const Across axes_there(normal);
  const Bend there = surfaces_.bend(!of_a, points, turned(axes_there, normal, round_normal));
  if (there.turn(edge.along, axes_there).dot(edge.along) < -kConvex * btFabs(round)) return FaceEnd::unknown;
  const auto isSame = [&](const WeightedPoint& f) {
    return f.kind == Kind::edge && f.point.on_b.distance2(edge.points.on_b) <
                                       kSameTop * kSameTop * reach_.separation * reach_.separation;
  };
  if (std::any_of(found_.begin() + std::ptrdiff_t(first_), found_.end(), isSame)) return end;
  if (!add(edge.points, normal, sample.id, Kind::edge)) return end;
  setEdgeBends(of_a, Bend::about(edge.along, axes_there, kEdgeSharpness * btFabs(round)), there, axes_there,
               found_.back().point);
  return end;
}

bool PatchContactPoints::addFace(const ProbedSample& sample, const btVector3& normal) {
  const OpposedPoints& points = sample.points;
  const bool faces = !points.areFlat() || points.normal_a.dot(points.normal_b) > kAlignedOnFacesCosine;
  const Kind kind = faces ? Kind::faces : probe_.isOnFaceOfB(points) ? Kind::edge : Kind::line;
  if (!add(points, normal, sample.id, kind)) return false;
  WeightedPoint& point = found_.back();
  point.bends = !points.areFlat();
  point.slope = points.normal_b - points.normal_a;
  point.is_top = sample.is_top;
  const bool in_hollow = keepInHollow(points, point);
  const Across axes(point.point.normal);
  SurfaceProbe::Bends bends = surfaces_.bends(points, axes);
  if (in_hollow) {
    // What is round was probed where its normal is another one.
    bends.a = surfaces_.bend(true, points, turned(axes, point.point.normal, points.normal_a));
    bends.b = surfaces_.bend(false, points, turned(axes, point.point.normal, points.normal_b));
  }
  point.both_bend = points.curvature_a != 0 && points.curvature_b != 0;
  // What is flat lies in a hollow with its ends.
  if (points.curvature_a < 0 && points.curvature_b == 0)
    bends.b = Bend::round(-kEdgeSharpness * points.curvature_a);
  if (points.curvature_b < 0 && points.curvature_a == 0)
    bends.a = Bend::round(-kEdgeSharpness * points.curvature_b);
  layOnHill(points, axes, bends, !in_hollow, point);
  // The hollow says no more than the plane, however the bodies move on.
  if (in_hollow) (bends.a.isHollow() ? point.point.bend_a : point.point.bend_b) = Bend();
  // Along a rim another place is deepest: all that is deeper lies within twice the way to it.
  if (points.along_straight_b > 0 && points.curvature_a == 0)
    point.beyond_end = 2 * btFabs(point.slope.dot(points.straight_b)) / points.along_straight_b;
  return true;
}

/// What is round stays within the planes that touch a hollow around it. Other planes say nothing about
/// where it may go: those that lean against its way brake what slides past them. So a hollow bears along
/// its own normal, where what is round reaches furthest that way. False if it does not go on to there.
bool PatchContactPoints::keepInHollow(const OpposedPoints& points, WeightedPoint& point) {
  if (point.is_top || point.slope.isZero()) return false;
  const Across axes_a(points.normal_a), axes_b(points.normal_b);
  const Bend a = surfaces_.bend(true, points, axes_a), b = surfaces_.bend(false, points, axes_b);
  const bool in_b = b.isHollow();
  if (in_b == a.isHollow()) return false;
  const btScalar fall =
      a.turn(point.slope, axes_a).dot(point.slope) + b.turn(point.slope, axes_b).dot(point.slope);
  if (!(fall > 0)) return false;
  const btVector3& normal = in_b ? points.normal_b : points.normal_a;
  // No shorter radius than that of the strongest bend: what is round reaches no less far.
  const Hill round(in_b ? a : b, Bend(), 0, in_b ? axes_a : axes_b);
  const btVector3 further = point.slope / round.fall(0);
  const btVector3 on_a = in_b ? points.on_a + further : points.on_a,
                  on_b = in_b ? points.on_b : points.on_b + further;
  const btScalar over = points.depthAlong(normal), depth = (on_a - on_b).dot(normal), bulge = depth - over;
  SurfaceQueries::Nearest wall;
  const bool goes_on = surfaces_.nearestWall(!in_b, in_b ? on_a : on_b, btFabs(depth) + bulge, wall) &&
                       wall.distance < bulge - depth &&
                       wall.normal.dot(normal) * (in_b ? -1 : 1) > points.normal_a.dot(points.normal_b);
  // What is apart touches no hollow either: there its plane says nothing.
  if (!goes_on || (point.point.depth < 0 && depth > 0)) return false;
  point.point.normal = normal;
  point.point.depth = point.point.depth < 0 ? depth : over;
  // There, so that the push leads through its centre.
  point.point.on_b = in_b ? on_a - normal * point.point.depth : on_b;
  point.moved = point.point.on_b - points.on_b;
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
