#include "narrow_phase/face_overlap.hpp"

#include <algorithm>
#include <optional>

#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

using Walked = SmoothNormals::Walked;

/// A straight part of the outline.
struct Side {
  bool of_a;
  SharpEdges::Edge edge;
  SharpEdges::Faces faces;
  btVector3 inwards;  ///< unit, along both faces
};

/// Goes around the overlap counter-clockwise, a little inside of it. At a corner that is cut into a face it
/// goes straight on, so that not all may be found, but what is found is on both faces.
class Walk {
 public:
  Walk(const SharpEdges& a, const SharpEdges& b, const OpposedPoints& points, const btVector3& normal)
      : a_(a),
        b_(b),
        points_(points),
        normal_(normal),
        // Further inside than rounding may lead aside.
        inset_(kWalkInside * (a.surface->rounding() * a.scale + b.surface->rounding() * b.scale)),
        place_((points.on_a + points.on_b) / 2),
        triangle_a_(points.triangle_a),
        triangle_b_(points.triangle_b) {}

  /// Goes on along `way` (unit) to the next side, and stops before it. Returns false if none is found.
  bool findSide(const btVector3& way, Side& side) {
    Walked in_a, in_b;
    if (!a_.walk(triangle_a_, place_, way, BT_LARGE_FLOAT, in_a) ||
        !b_.walk(triangle_b_, place_, way, in_a.share, in_b))
      return false;
    side.of_a = in_b.edge == SmoothNormals::kNoEdge;
    const SharpEdges& own = side.of_a ? a_ : b_;
    const Walked& met = side.of_a ? in_a : in_b;
    if (!isFlat(own, met)) return false;
    side.edge = own.edgeOf(met);
    side.faces = own.facesOf(side.edge);
    const btVector3& in = side.faces.inwards[0];
    side.inwards = (in - normal_ * in.dot(normal_)).normalized();
    const btScalar towards = -side.inwards.dot(way);
    const btScalar stop = in_b.share - inset_ / btMax(towards, SIMD_EPSILON);
    if (!(stop > 0)) return true;
    if (!a_.walk(triangle_a_, place_, way, stop, in_a) || !b_.walk(triangle_b_, place_, way, stop, in_b) ||
        !isFlat(a_, in_a) || !isFlat(b_, in_b))
      return false;
    triangle_a_ = in_a.triangle;
    triangle_b_ = in_b.triangle;
    place_ += way * stop;
    return true;
  }

  /// Where two sides meet. Returns false if they are parallel.
  bool corner(const Side& first, const Side& second, btVector3& at) const {
    const btVector3 &p = first.edge.from, &along = first.edge.along;
    const btScalar speed = along.dot(second.inwards);
    if (!(btFabs(speed) > kCrossingSine * along.length())) return false;
    at = p + along * ((second.edge.from - p).dot(second.inwards) / speed);
    return true;
  }

  EdgeContact crossing(const Side& first, const Side& second, const btVector3& on_first,
                       const btVector3& on_second) const {
    EdgeContact crossing{points_};
    crossing.points.on_a = (first.of_a ? on_first : on_second) + normal_ * a_.margin;
    crossing.points.on_b = (first.of_a ? on_second : on_first) - normal_ * b_.margin;
    crossing.points.normal_a = crossing.points.normal_b = normal_;
    crossing.id = crossingId((first.of_a ? first : second).faces.id, (first.of_a ? second : first).faces.id);
    return crossing;
  }

  bool isSame(const btVector3& p, const btVector3& q) const {
    const btVector3 apart = p - q;
    return (apart - normal_ * apart.dot(normal_)).length2() < inset_ * inset_;
  }

 private:
  /// Whether a walk ended on the flat face that it began on. It may have gone on over a bend.
  bool isFlat(const SharpEdges& solid, const Walked& walked) const {
    return btFabs(solid.face(walked.triangle).dot(normal_)) > kSameFaceCosine;
  }

  const SharpEdges& a_;
  const SharpEdges& b_;
  const OpposedPoints& points_;
  const btVector3 normal_;
  const btScalar inset_;
  btVector3 place_;
  std::size_t triangle_a_, triangle_b_;
};

}  // namespace

bool FaceOverlaps::covers(const btVector3& place, const btVector3& normal) const {
  const Across axes(normal);
  bool inside = false;
  for (const Side& side : sides) {
    // By how often a line across the sides, from the place on, meets them.
    const btVector3 p = side.from - place, q = side.to - place;
    const btScalar px = p.dot(axes.x), py = p.dot(axes.y), qx = q.dot(axes.x), qy = q.dot(axes.y);
    if ((py > 0) != (qy > 0) && (px * qy - py * qx) * (qy - py) > 0) inside = !inside;
  }
  return inside;
}

void followOverlap(const SharpEdges& a, const SharpEdges& b, const OpposedPoints& points,
                   const btVector3& normal, FaceOverlaps& overlaps, std::vector<EdgeContact>& crossings) {
  Walk walk(a, b, points, normal);
  const std::size_t begin = overlaps.sides.size();
  const auto isKnown = [&](const btVector3& corner) {
    return std::any_of(overlaps.sides.begin() + std::ptrdiff_t(begin), overlaps.sides.end(),
                       [&](const FaceOverlaps::Side& side) { return walk.isSame(side.from, corner); });
  };
  Side side, next;
  bool found = walk.findSide(Across(normal).x, side);
  for (std::optional<btVector3> before; found && overlaps.hasRoom(); side = next) {
    found = walk.findSide(side.inwards.cross(normal), next);
    --overlaps.sides_left;
    btVector3 corner, on_next;
    if (!found || !walk.corner(side, next, corner)) continue;
    if (before) overlaps.sides.push_back({*before, corner});
    if (isKnown(corner)) return;
    before = corner;
    if (side.of_a != next.of_a && walk.corner(next, side, on_next))
      crossings.push_back(walk.crossing(side, next, corner, on_next));
  }
  overlaps.sides_left = 0;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
