#include "narrow_phase/edge_edge.hpp"

#include <cmath>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

constexpr std::uint64_t kCrossingId = std::uint64_t(1) << 61;
/// How often edges are looked for, each time where those before would cross.
constexpr int kLooks = 4;
/// Edges within 5 degrees of each other do not cross, and faces that fall away from their edge by less are in
/// contact themselves.
constexpr btScalar kAcross = btScalar(0.087);
constexpr btScalar kFalls = btScalar(0.087);
/// How far beyond their ends edges still cross, in lengths: no rounding leaves a gap between two.
constexpr btScalar kBeyond = btScalar(1e-4);
/// A place on an edge does not show what is met along the edge: edges are looked for from this far towards
/// the middle of its triangle, in lengths.
constexpr btScalar kInwards = btScalar(0.01);
/// In lengths of the edges: what is less deep in each other is near each other.
constexpr btScalar kShallow = btScalar(0.01);

/// Whether both faces of an edge do. `direction`: unit, out of the solid.
bool fallsAway(const SharpEdges::Edge& edge, const btVector3& direction) {
  return edge.inwards[0].dot(direction) < -kFalls && edge.inwards[1].dot(direction) < -kFalls;
}

bool isOn(btScalar share) {
  return share > -kBeyond && share < 1 + kBeyond;
}

/// Two edges, each looked for from one side of the gap.
class Pair {
 public:
  Pair(const SharpEdges& a, const SharpEdges& b, const OpposedPoints& gap, const btVector3& direction)
      : a_(a),
        b_(b),
        gap_(gap),
        out_of_a_(gap.normal_a + gap.normal_b + direction),
        start_a_(lerp(gap.on_a, a.middle(gap.triangle_a), kInwards)),
        start_b_(lerp(gap.on_b, b.middle(gap.triangle_b), kInwards)) {}

  /// The edges that are met along these ways, and then towards where those would cross.
  bool find(const btVector3& towards_a, const btVector3& towards_b) {
    bool found = look(towards_a, towards_b);
    for (int i = 1; i < kLooks && found && !(isOn(share_a_) && isOn(share_b_)); ++i)
      found = look(on_a() - start_a_, on_b() - start_b_);
    return found && isOn(share_a_) && isOn(share_b_) && isOutermost();
  }

  void describe(SurfaceProbe::Corner& crossing) const {
    crossing.gap = gap_;
    crossing.gap.on_a = on_a() + normal_ * a_.margin;
    crossing.gap.on_b = on_b() - normal_ * b_.margin;
    crossing.gap.normal_a = crossing.gap.normal_b = normal_;
    crossing.id = kCrossingId + (std::uint64_t(edge_a_.id) << 30) + edge_b_.id;
  }

 private:
  btVector3 on_a() const { return edge_a_.from + edge_a_.along * share_a_; }
  btVector3 on_b() const { return edge_b_.from + edge_b_.along * share_b_; }

  bool look(const btVector3& towards_a, const btVector3& towards_b) {
    if (!a_.edgeTowards(gap_.triangle_a, start_a_, towards_a, edge_a_) ||
        !b_.edgeTowards(gap_.triangle_b, start_b_, towards_b, edge_b_))
      return false;
    const btVector3 across = edge_a_.along.cross(edge_b_.along);
    const btScalar across2 = across.length2();
    if (!(across2 > kAcross * kAcross * edge_a_.along.length2() * edge_b_.along.length2())) return false;
    const btVector3 apart = edge_b_.from - edge_a_.from;
    share_a_ = apart.cross(edge_b_.along).dot(across) / across2;
    share_b_ = apart.cross(edge_a_.along).dot(across) / across2;
    normal_ = across / std::copysign(btSqrt(across2), across.dot(out_of_a_));
    return true;
  }

  /// Both solids have nothing as far out nearby.
  bool isOutermost() const {
    if (!fallsAway(edge_a_, normal_) || !fallsAway(edge_b_, -normal_)) return false;
    // Edges that are far apart cross, too.
    const btScalar length = btSqrt(btMin(edge_a_.along.length2(), edge_b_.along.length2()));
    const btScalar depth = (on_a() - on_b()).dot(normal_);
    const btVector3 middle = (on_a() + on_b()) / 2;
    return !(depth > kShallow * length) || (a_.isIn(middle, depth) && b_.isIn(middle, depth));
  }

  const SharpEdges& a_;
  const SharpEdges& b_;
  const OpposedPoints& gap_;
  const btVector3 out_of_a_;  ///< about
  const btVector3 start_a_, start_b_;
  SharpEdges::Edge edge_a_, edge_b_;
  btScalar share_a_ = 0, share_b_ = 0;
  btVector3 normal_{0, 0, 0};
};

}  // namespace

bool crossingEdges(const SharpEdges& a, const SharpEdges& b, const OpposedPoints& gap,
                   const btVector3& direction, SurfaceProbe::Corner& crossing) {
  Pair pair(a, b, gap, direction);
  // To where the gap gets deeper; or, if it lies between the edges, to where each solid reaches further.
  const btVector3 deeper = gap.normal_b - gap.normal_a;
  if (!pair.find(deeper, deeper) && !pair.find(direction, -direction) && !pair.find(direction, deeper) &&
      !pair.find(deeper, -direction))
    return false;
  pair.describe(crossing);
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
