#include "narrow_phase/edge_face.hpp"

#include <optional>

#include "common/contact_tolerances.hpp"
#include "narrow_phase/edge_edge.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

using Walked = SmoothNormals::Walked;

/// A flat face that may bear the edge.
class BearingFace {
 public:
  /// Takes a place of it to go from, and one that it leads through, with the margin.
  BearingFace(const SharpEdges& solid, std::size_t triangle, const btVector3& place, const btVector3& through,
              const btVector3& outwards)
      : solid_(solid), triangle_(triangle), place_(place), through_(through), outwards_(outwards) {}

  const btVector3& outwards() const { return outwards_; }
  btVector3 under(const btVector3& place) const {
    return place - outwards_ * (place - through_).dot(outwards_);
  }
  const SharpEdges& solid() const { return solid_; }

  /// Goes to near the place under a place. Returns false if the face ends before. In a valley the edge may
  /// have sunk into the solid.
  bool goUnder(const btVector3& place) {
    const btVector3 way = under(place) - place_;
    Walked walked;
    if (!walk(way, walked) || (ends(walked) && !sinksIntoValley(place, solid_.edgeOf(walked)))) return false;
    const btVector3 inside = way * (walked.share * (1 - kStartInside));
    if (!walk(inside, walked) || ends(walked)) return false;
    triangle_ = walked.triangle;
    place_ += inside;
    return true;
  }

  /// Finds the edge in which the face ends along `way`.
  bool endsAlong(const btVector3& way, Walked& end) const { return walk(way, end) && ends(end); }

  /// Returns the face beyond the valley in which this one ends along `way`.
  std::optional<BearingFace> beyondValley(const btVector3& way) const {
    Walked end;
    if (!endsAlong(way, end)) return std::nullopt;
    const SharpEdges::Edge valley = solid_.edgeOf(end);
    if (!solid_.isValley(valley)) return std::nullopt;
    const SharpEdges::Faces faces = solid_.facesOf(valley);
    const btVector3 outwards = outwardsBeyond(valley, faces), middle = solid_.middle(faces.across);
    return BearingFace(solid_, faces.across, lerp(place_ + way * end.share, middle, kStartInside),
                       middle + outwards * solid_.margin, outwards);
  }

 private:
  static bool ends(const Walked& walked) { return walked.edge != SmoothNormals::kNoEdge; }
  /// The normal of the face beyond a valley.
  static btVector3 outwardsBeyond(const SharpEdges::Edge& valley, const SharpEdges::Faces& faces) {
    const btVector3 outwards = valley.along.cross(faces.inwards[1]).normalized();
    return outwards.dot(faces.inwards[0]) < 0 ? -outwards : outwards;
  }
  /// Whether a place is in the solid behind an edge, and no other face is nearer than the two of that valley:
  /// an edge far beyond it, on the other side of the solid, does not lie on this face.
  bool sinksIntoValley(const btVector3& place, const SharpEdges::Edge& edge) const {
    if (!solid_.isValley(edge)) return false;
    const SharpEdges::Faces faces = solid_.facesOf(edge);
    const btScalar below = (through_ - place).dot(outwards_),
                   behind = (solid_.middle(faces.across) - place).dot(outwardsBeyond(edge, faces));
    const btScalar least = below > 0 ? btMin(below, behind) : behind;
    btScalar depth = 0;
    return solid_.depthOf(place, depth) && depth > 0 && depth > (1 - kStartInside) * least;
  }
  /// Returns false if the walk goes over a bend.
  bool walk(const btVector3& way, Walked& walked) const {
    return solid_.walk(triangle_, place_, way, 1, walked) &&
           btFabs(solid_.face(walked.triangle).dot(outwards_)) > kSameFaceCosine;
  }

  const SharpEdges& solid_;
  std::size_t triangle_;
  btVector3 place_;
  btVector3 through_;
  btVector3 outwards_;
};

/// The edge of one solid, A or else B, over faces of the other one.
class LyingEdge {
 public:
  LyingEdge(const SharpEdges& own, bool of_a, const OpposedPoints& points)
      : own_(own), of_a_(of_a), points_(points) {}

  /// Finds the edge that is met up the face at the opposed points, seen along `out`.
  bool find(const btVector3& out) {
    const std::size_t triangle = of_a_ ? points_.triangle_a : points_.triangle_b;
    const btVector3& start = of_a_ ? points_.on_a : points_.on_b;
    const btVector3 face = own_.face(triangle);
    const btVector3 uphill = out - face * out.dot(face);
    if (!own_.edgeTowards(triangle, start, uphill, edge_)) return false;
    faces_ = own_.facesOf(edge_);
    const btVector3 outwards = face.cross(edge_.along);
    const btScalar speed = uphill.dot(outwards), length2 = edge_.along.length2();
    if (speed == 0 || length2 == 0) return false;
    const btVector3 met = start + uphill * ((edge_.from - start).dot(outwards) / speed);
    top_ = edge_.from + edge_.along * ((met - edge_.from).dot(edge_.along) / length2);
    uphill_ = uphill * (btSqrt(length2) / uphill.length());
    return true;
  }

  /// Returns a way up to the edge, as long as the edge is.
  const btVector3& uphill() const { return uphill_; }

  /// Appends where the edge leaves a face. Returns how often it does; -1 if it is not over the face.
  int layOn(BearingFace face, std::vector<EdgeContact>& ends) const {
    const btVector3 out = -face.outwards();
    // Else it crosses the edge in which the face ends.
    if (btFabs(edge_.along.dot(out)) > kFallingSine * edge_.along.length()) return -1;
    for (const btVector3& inwards : faces_.inwards) {
      if (!(inwards.dot(out) < -kLeaning)) return -1;
    }
    if (!face.goUnder(top_)) return -1;
    int count = 0;
    for (const btVector3& end : {edge_.from, edge_.from + edge_.along}) {
      Walked met;
      if (!face.endsAlong(end - top_, met)) continue;
      append(face, end, met, ends);
      ++count;
    }
    return count;
  }

 private:
  void append(const BearingFace& face, const btVector3& end, const Walked& met,
              std::vector<EdgeContact>& ends) const {
    const SharpEdges::Edge rim = face.solid().edgeOf(met);
    btVector3 out = -face.outwards(), on_own = lerp(top_, end, met.share), on_other = face.under(on_own);
    // Where the edge gets deeper to the end, it lies on the rim alone.
    LineCrossing crossing;
    if ((end - top_).dot(out) > 0 && crossLines(edge_, rim, crossing) && crossing.isOnBoth()) {
      out = crossing.across.dot(out) > 0 ? crossing.across : -crossing.across;
      on_own = edge_.from + edge_.along * crossing.share_first;
      on_other = rim.from + rim.along * crossing.share_second - out * face.solid().margin;
    }
    on_own += out * own_.margin;
    EdgeContact& contact = ends.emplace_back(EdgeContact{points_});
    contact.points.on_a = of_a_ ? on_own : on_other;
    contact.points.on_b = of_a_ ? on_other : on_own;
    contact.points.normal_a = contact.points.normal_b = of_a_ ? out : -out;
    const std::uint32_t id = face.solid().facesOf(rim).id;
    contact.id = of_a_ ? crossingId(faces_.id, id) : crossingId(id, faces_.id);
  }

  const SharpEdges& own_;
  const bool of_a_;
  const OpposedPoints& points_;
  SharpEdges::Edge edge_;
  SharpEdges::Faces faces_;
  btVector3 top_{0, 0, 0};
  btVector3 uphill_{0, 0, 0};
};

}  // namespace

bool layEdgeOnFace(const SharpEdges& a, const SharpEdges& b, bool of_a, const OpposedPoints& points,
                   const btVector3& normal, std::vector<EdgeContact>& ends) {
  LyingEdge edge(of_a ? a : b, of_a, points);
  const btVector3 out = of_a ? normal : -normal;
  if (!edge.find(out)) return false;
  BearingFace face(of_a ? b : a, of_a ? points.triangle_b : points.triangle_a,
                   of_a ? points.on_b : points.on_a, of_a ? points.on_b : points.on_a, -out);
  const int count = edge.layOn(face, ends);
  if (count < 0) return false;
  if (const std::optional<BearingFace> beyond = face.beyondValley(edge.uphill())) edge.layOn(*beyond, ends);
  return count == 2;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
