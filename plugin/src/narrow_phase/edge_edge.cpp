#include "narrow_phase/edge_edge.hpp"

#include <cmath>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Whether both faces of an edge fall away from it, seen along `direction` (unit, out of the solid).
bool fallsAway(const SharpEdges::Edge& edge, const btVector3& direction, btScalar sine) {
  return edge.inwards[0].dot(direction) < -sine && edge.inwards[1].dot(direction) < -sine;
}

bool isOn(btScalar share) {
  return share > -kBeyondEnds && share < 1 + kBeyondEnds;
}

/// Two edges, each looked for from one of the opposed points.
class EdgePair {
 public:
  EdgePair(const SharpEdges& a, const SharpEdges& b, const OpposedPoints& points, const btVector3& direction,
           btScalar falling)
      : a_(a),
        b_(b),
        points_(points),
        falling_(falling),
        out_of_a_(points.normal_a + points.normal_b + direction),
        start_a_(lerp(points.on_a, a.middle(points.triangle_a), kStartInside)),
        start_b_(lerp(points.on_b, b.middle(points.triangle_b), kStartInside)) {}

  /// The edges that are met along these ways, and then towards where those would cross.
  bool find(const btVector3& towards_a, const btVector3& towards_b) {
    bool found = look(towards_a, towards_b);
    for (int i = 1; i < kEdgeLooks && found && !(isOn(share_a_) && isOn(share_b_)); ++i)
      found = look(on_a() - start_a_, on_b() - start_b_);
    return found && isOn(share_a_) && isOn(share_b_) && isOutermost();
  }

  void describe(EdgeContact& crossing) const {
    crossing.points = points_;
    crossing.points.on_a = on_a() + normal_ * a_.margin;
    crossing.points.on_b = on_b() - normal_ * b_.margin;
    crossing.points.normal_a = crossing.points.normal_b = normal_;
    crossing.id = kCrossingId + (std::uint64_t(edge_a_.id) << 30) + edge_b_.id;
  }

 private:
  btVector3 on_a() const { return edge_a_.from + edge_a_.along * share_a_; }
  btVector3 on_b() const { return edge_b_.from + edge_b_.along * share_b_; }

  bool look(const btVector3& towards_a, const btVector3& towards_b) {
    if (!a_.edgeTowards(points_.triangle_a, start_a_, towards_a, edge_a_) ||
        !b_.edgeTowards(points_.triangle_b, start_b_, towards_b, edge_b_))
      return false;
    const btVector3 across = edge_a_.along.cross(edge_b_.along);
    const btScalar across2 = across.length2();
    if (!(across2 > kCrossingSine * kCrossingSine * edge_a_.along.length2() * edge_b_.along.length2()))
      return false;
    const btVector3 apart = edge_b_.from - edge_a_.from;
    share_a_ = apart.cross(edge_b_.along).dot(across) / across2;
    share_b_ = apart.cross(edge_a_.along).dot(across) / across2;
    normal_ = across / std::copysign(btSqrt(across2), across.dot(out_of_a_));
    return true;
  }

  /// Both solids have nothing as far out nearby.
  bool isOutermost() const {
    if (!fallsAway(edge_a_, normal_, falling_) || !fallsAway(edge_b_, -normal_, falling_)) return false;
    // Edges that are far apart cross, too.
    const btScalar length = btSqrt(btMin(edge_a_.along.length2(), edge_b_.along.length2()));
    const btScalar depth = (on_a() - on_b()).dot(normal_);
    const btVector3 middle = (on_a() + on_b()) / 2;
    return !(depth > kShallow * length) || (a_.isIn(middle, depth) && b_.isIn(middle, depth));
  }

  const SharpEdges& a_;
  const SharpEdges& b_;
  const OpposedPoints& points_;
  const btScalar falling_;
  const btVector3 out_of_a_;  ///< about
  const btVector3 start_a_, start_b_;
  SharpEdges::Edge edge_a_, edge_b_;
  btScalar share_a_ = 0, share_b_ = 0;
  btVector3 normal_{0, 0, 0};
};

}  // namespace

bool crossEdges(const SharpEdges& a, const SharpEdges& b, const OpposedPoints& points,
                const btVector3& direction, EdgeContact& crossing, btScalar falling) {
  EdgePair pair(a, b, points, direction, falling);
  // To where the contact gets deeper; or, if the points lie between the edges, to where each solid reaches
  // further.
  const btVector3 deeper = points.normal_b - points.normal_a;
  if (!pair.find(deeper, deeper) && !pair.find(direction, -direction) && !pair.find(direction, deeper) &&
      !pair.find(deeper, -direction))
    return false;
  pair.describe(crossing);
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
