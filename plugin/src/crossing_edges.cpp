#include "crossing_edges.hpp"

#include <cmath>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

constexpr std::uint64_t kCrossingId = std::uint64_t(1) << 61;
/// How often edges are looked for, each time where those before would cross.
constexpr int kLooks = 4;
/// Edges within 5 degrees of each other do not cross, and faces within 5 degrees of the normal are in contact
/// themselves.
constexpr btScalar kAcross = btScalar(0.087);
constexpr btScalar kFace = btScalar(0.996);
/// A face falls away from its edge if it does not rise more than this [rad].
constexpr btScalar kRise = btScalar(1e-3);
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
    return inwards[0].dot(direction) < kRise && inwards[1].dot(direction) < kRise;
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

}  // namespace

bool crossingEdges(const PackingBody& a, const PackingBody& b, const Gap& gap, Gauge::Corner& crossing) {
  const btVector3 offset_a(0, 0, 0), offset_b = b.origin() - a.origin();
  Edge edge_a, edge_b;
  btVector3 across, on_a = gap.on_a, on_b = gap.on_b;
  const btVector3 uphill = gap.normal_b - gap.normal_a;
  for (int look = 0;; ++look) {
    if (look == kLooks) return false;
    const btVector3 towards_a = look == 0 ? uphill : on_a - gap.on_a;
    const btVector3 towards_b = look == 0 ? uphill : on_b - gap.on_b;
    if (!edgeTowards(a, offset_a, gap.triangle_a, gap.on_a, towards_a, edge_a) ||
        !edgeTowards(b, offset_b, gap.triangle_b, gap.on_b, towards_b, edge_b))
      return false;
    across = edge_a.along.cross(edge_b.along);
    if (!(across.length2() > kAcross * kAcross * edge_a.along.length2() * edge_b.along.length2()))
      return false;
    const btVector3 apart = edge_b.from - edge_a.from;
    const btScalar share_a = apart.cross(edge_b.along).dot(across) / across.length2();
    const btScalar share_b = apart.cross(edge_a.along).dot(across) / across.length2();
    on_a = edge_a.from + edge_a.along * share_a;
    on_b = edge_b.from + edge_b.along * share_b;
    if (isOn(share_a) && isOn(share_b)) break;
  }
  const btVector3 normal = across / std::copysign(across.length(), across.dot(gap.normal_a + gap.normal_b));
  if (!edge_a.isOutermost(normal) || !edge_b.isOutermost(-normal)) return false;
  if (gap.normal_a.dot(normal) > kFace || gap.normal_b.dot(normal) > kFace) return false;
  // Edges that are far apart cross, too.
  const btScalar depth = (on_a - on_b).dot(normal);
  const auto isInside = [&](const PackingBody& body, const btVector3& offset) {
    SurfaceTree::Nearest nearest;
    return body.nearest((on_a + on_b) / 2 - offset, depth, nearest) && nearest.distance < 0;
  };
  const btScalar length = btSqrt(btMin(edge_a.along.length2(), edge_b.along.length2()));
  if (depth > kShallow * length && !(isInside(a, offset_a) && isInside(b, offset_b))) return false;
  crossing.gap = gap;
  crossing.gap.on_a = on_a + normal * a.margin;
  crossing.gap.on_b = on_b - normal * b.margin;
  crossing.gap.normal_a = crossing.gap.normal_b = normal;
  crossing.id = kCrossingId + (std::uint64_t(edge_a.id) << 30) + edge_b.id;
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
