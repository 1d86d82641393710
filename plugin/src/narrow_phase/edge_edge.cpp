#include "narrow_phase/edge_edge.hpp"

#include <array>
#include <optional>

#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// By how much the faces of an edge fall away from it at least, seen along `direction` (unit, out of the
/// solid) [sine].
btScalar fallOf(const SharpEdges::Faces& faces, const btVector3& direction) {
  return btMin(-faces.inwards[0].dot(direction), -faces.inwards[1].dot(direction));
}

bool isOn(btScalar share) {
  return share > -kBeyondEnds && share < 1 + kBeyondEnds;
}

/// Two edges, each looked for from one of the opposed points.
class EdgePair {
 public:
  EdgePair(const SharpEdges& a, const SharpEdges& b, const OpposedPoints& points, const btVector3& direction,
           const IsThin& is_thin)
      : a_(a),
        b_(b),
        points_(points),
        is_thin_(is_thin),
        out_of_a_(points.normal_a + points.normal_b + direction),
        start_a_(lerp(points.on_a, a.middle(points.triangle_a), kStartInside)),
        start_b_(lerp(points.on_b, b.middle(points.triangle_b), kStartInside)) {}

  /// The edges of both solids that are met in two directions: first where the contact gets deeper, then, if
  /// the points lie between the edges, where the solid reaches further. One that is the same is left out.
  using Firsts = std::array<std::optional<SharpEdges::Edge>, 2>;
  Firsts firstsOfA(const btVector3& deeper, const btVector3& further) const {
    return firsts(a_, points_.triangle_a, start_a_, deeper, further);
  }
  Firsts firstsOfB(const btVector3& deeper, const btVector3& further) const {
    return firsts(b_, points_.triangle_b, start_b_, deeper, further);
  }

  /// These edges, or those that are met towards where they would cross.
  bool find(const SharpEdges::Edge& first_a, const SharpEdges::Edge& first_b) {
    edge_a_ = first_a;
    edge_b_ = first_b;
    bool found = cross();
    for (int i = 1; i < kEdgeLooks && found && !(isOn(share_a_) && isOn(share_b_)); ++i) {
      const btVector3 towards_a = on_a() - start_a_, towards_b = on_b() - start_b_;
      found = a_.edgeTowards(points_.triangle_a, start_a_, towards_a, edge_a_) &&
              b_.edgeTowards(points_.triangle_b, start_b_, towards_b, edge_b_) && cross();
    }
    return found && isOn(share_a_) && isOn(share_b_) && isOutermost();
  }

  void describe(EdgeContact& crossing) const {
    crossing.points = points_;
    crossing.points.on_a = on_a() + normal_ * a_.margin;
    crossing.points.on_b = on_b() - normal_ * b_.margin;
    crossing.points.normal_a = crossing.points.normal_b = normal_;
    crossing.id = crossingId(faces_a_.id, faces_b_.id);
  }

 private:
  static Firsts firsts(const SharpEdges& solid, std::size_t triangle, const btVector3& start,
                       const btVector3& deeper, const btVector3& further) {
    Firsts edges;
    SharpEdges::Edge edge;
    if (solid.edgeTowards(triangle, start, deeper, edge)) edges[0] = edge;
    if (solid.edgeTowards(triangle, start, further, edge) &&
        !(edges[0] && edges[0]->where.isSameEdge(edge.where)))
      edges[1] = edge;
    return edges;
  }

  btVector3 on_a() const { return edge_a_.from + edge_a_.along * share_a_; }
  btVector3 on_b() const { return edge_b_.from + edge_b_.along * share_b_; }

  bool cross() {
    LineCrossing crossing;
    if (!crossLines(edge_a_, edge_b_, crossing)) return false;
    share_a_ = crossing.share_first;
    share_b_ = crossing.share_second;
    normal_ = crossing.across.dot(out_of_a_) < 0 ? -crossing.across : crossing.across;
    return true;
  }

  /// Both solids have nothing as far out nearby.
  bool isOutermost() {
    faces_a_ = a_.facesOf(edge_a_);
    btScalar fall = fallOf(faces_a_, normal_);
    if (!(fall > kLeaning)) return false;
    faces_b_ = b_.facesOf(edge_b_);
    fall = btMin(fall, fallOf(faces_b_, -normal_));
    if (!(fall > kLeaning) || !(fall > kFallingSine || (is_thin_ && is_thin_()))) return false;
    // Edges that are far apart cross, too.
    const btScalar length = btSqrt(btMin(edge_a_.along.length2(), edge_b_.along.length2()));
    const btScalar depth = (on_a() - on_b()).dot(normal_);
    const btVector3 middle = (on_a() + on_b()) / 2;
    return !(depth > kShallow * length) || (a_.isIn(middle, depth) && b_.isIn(middle, depth));
  }

  const SharpEdges& a_;
  const SharpEdges& b_;
  const OpposedPoints& points_;
  const IsThin& is_thin_;
  const btVector3 out_of_a_;  ///< about
  const btVector3 start_a_, start_b_;
  SharpEdges::Edge edge_a_, edge_b_;
  SharpEdges::Faces faces_a_, faces_b_;
  btScalar share_a_ = 0, share_b_ = 0;
  btVector3 normal_{0, 0, 0};
};

}  // namespace

bool LineCrossing::isOnBoth() const {
  return isOn(share_first) && isOn(share_second);
}

bool crossLines(const SharpEdges::Edge& first, const SharpEdges::Edge& second, LineCrossing& crossing) {
  const btVector3 across = first.along.cross(second.along);
  const btScalar across2 = across.length2();
  if (!(across2 > kCrossingSine * kCrossingSine * first.along.length2() * second.along.length2()))
    return false;
  const btVector3 apart = second.from - first.from;
  crossing.share_first = apart.cross(second.along).dot(across) / across2;
  crossing.share_second = apart.cross(first.along).dot(across) / across2;
  crossing.across = across / btSqrt(across2);
  return true;
}

bool crossEdges(const SharpEdges& a, const SharpEdges& b, const OpposedPoints& points,
                const btVector3& direction, EdgeContact& crossing, const IsThin& is_thin) {
  EdgePair pair(a, b, points, direction, is_thin);
  const btVector3 deeper = points.normal_b - points.normal_a;
  const EdgePair::Firsts firsts_a = pair.firstsOfA(deeper, direction);
  if (!firsts_a[0] && !firsts_a[1]) return false;
  const EdgePair::Firsts firsts_b = pair.firstsOfB(deeper, -direction);
  const auto find = [&](std::size_t of_a, std::size_t of_b) {
    return firsts_a[of_a] && firsts_b[of_b] && pair.find(*firsts_a[of_a], *firsts_b[of_b]);
  };
  if (!find(0, 0) && !find(1, 1) && !find(1, 0) && !find(0, 1)) return false;
  pair.describe(crossing);
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
