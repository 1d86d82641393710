#include "crossing_edges.hpp"

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
/// In lengths of the edges: what is less deep in each other is near each other.
constexpr btScalar kShallow = btScalar(0.01);

/// Relative to the origin of A, axes of the world.
struct Edge {
  btVector3 from{0, 0, 0};
  btVector3 along{0, 0, 0};  ///< to its other end
  btVector3 inwards[2];      ///< unit: along its faces
  std::uint32_t id = 0;

  /// `direction`: unit, out of the solid.
  bool isOutermost(const btVector3& direction) const {
    return inwards[0].dot(direction) < -kFalls && inwards[1].dot(direction) < -kFalls;
  }
};

bool isOn(btScalar share) {
  return share > -kBeyond && share < 1 + kBeyond;
}

/// The sharp edge that is met from a point of a triangle of a body; `offset` is the body's origin.
bool edgeTowards(const PackingBody& body, const btVector3& offset, std::size_t triangle,
                 const btVector3& point, const btVector3& towards, Edge& edge) {
  const btMatrix3x3& axes = body.world.getBasis();
  const btVector3 start = ((point - offset) * axes) / body.scale();
  SmoothNormals::SharpEdge found;
  if (!body.shape().surfaceTree().sharpEdge(triangle, start, towards * axes, found)) return false;
  edge.from = offset + axes * found.from * body.scale();
  edge.along = axes * (found.to - found.from) * body.scale();
  for (int i = 0; i < 2; ++i) edge.inwards[i] = axes * found.inwards[i];
  edge.id = found.id;
  return true;
}

/// Two edges, each looked for from one side of the gap.
class Pair {
 public:
  Pair(const PackingBody& a, const PackingBody& b, const Gap& gap)
      : body_a_(a), body_b_(b), gap_(gap), offset_b_(b.origin() - a.origin()) {}

  /// The edges that are met along these ways, and then towards where those would cross.
  bool find(const btVector3& towards_a, const btVector3& towards_b) {
    bool found = look(towards_a, towards_b);
    for (int i = 1; i < kLooks && found && !(isOn(share_a_) && isOn(share_b_)); ++i)
      found = look(on_a() - gap_.on_a, on_b() - gap_.on_b);
    return found && isOn(share_a_) && isOn(share_b_) && isOutermost();
  }

  Gauge::Corner crossing() const {
    Gauge::Corner crossing;
    crossing.gap = gap_;
    crossing.gap.on_a = on_a() + normal_ * body_a_.margin;
    crossing.gap.on_b = on_b() - normal_ * body_b_.margin;
    crossing.gap.normal_a = crossing.gap.normal_b = normal_;
    crossing.id = kCrossingId + (std::uint64_t(edge_a_.id) << 30) + edge_b_.id;
    return crossing;
  }

 private:
  btVector3 on_a() const { return edge_a_.from + edge_a_.along * share_a_; }
  btVector3 on_b() const { return edge_b_.from + edge_b_.along * share_b_; }

  bool look(const btVector3& towards_a, const btVector3& towards_b) {
    if (!edgeTowards(body_a_, btVector3(0, 0, 0), gap_.triangle_a, gap_.on_a, towards_a, edge_a_) ||
        !edgeTowards(body_b_, offset_b_, gap_.triangle_b, gap_.on_b, towards_b, edge_b_))
      return false;
    const btVector3 across = edge_a_.along.cross(edge_b_.along);
    const btScalar across2 = across.length2();
    if (!(across2 > kAcross * kAcross * edge_a_.along.length2() * edge_b_.along.length2())) return false;
    const btVector3 apart = edge_b_.from - edge_a_.from;
    share_a_ = apart.cross(edge_b_.along).dot(across) / across2;
    share_b_ = apart.cross(edge_a_.along).dot(across) / across2;
    normal_ = across / std::copysign(btSqrt(across2), across.dot(gap_.normal_a + gap_.normal_b));
    return true;
  }

  /// Both solids have nothing as far out nearby.
  bool isOutermost() const {
    if (!edge_a_.isOutermost(normal_) || !edge_b_.isOutermost(-normal_)) return false;
    // Edges that are far apart cross, too.
    const btScalar length = btSqrt(btMin(edge_a_.along.length2(), edge_b_.along.length2()));
    const btScalar depth = (on_a() - on_b()).dot(normal_);
    const btVector3 middle = (on_a() + on_b()) / 2;
    const auto isIn = [&](const PackingBody& body, const btVector3& place) {
      SurfaceTree::Nearest nearest;
      return body.nearest(place, depth, nearest) && nearest.distance < 0;
    };
    return !(depth > kShallow * length) || (isIn(body_a_, middle) && isIn(body_b_, middle - offset_b_));
  }

  const PackingBody& body_a_;
  const PackingBody& body_b_;
  const Gap& gap_;
  const btVector3 offset_b_;
  Edge edge_a_, edge_b_;
  btScalar share_a_ = 0, share_b_ = 0;
  btVector3 normal_{0, 0, 0};
};

}  // namespace

bool crossingEdges(const PackingBody& a, const PackingBody& b, const Gap& gap, const btVector3& direction,
                   Gauge::Corner& crossing) {
  Pair pair(a, b, gap);
  // To where the gap gets deeper; or, if it lies between the edges, to where each solid reaches further.
  const btVector3 deeper = gap.normal_b - gap.normal_a;
  if (!pair.find(deeper, deeper) && !pair.find(direction, -direction)) return false;
  crossing = pair.crossing();
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
