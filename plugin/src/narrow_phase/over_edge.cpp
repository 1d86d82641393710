#include "narrow_phase/over_edge.hpp"

#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// The place of an edge that is deepest in a round solid.
class DeepestOfEdge {
 public:
  DeepestOfEdge(const SharpEdges::Edge& edge, const NearestRound& nearest_round)
      : edge_(edge), nearest_round_(nearest_round), length_(edge.along.length()) {}

  /// Goes along the edge, from beside `start`, to where the normal of the round surface is across it: by
  /// secants, the first of which takes the surface for a ball of this curvature [1/m]. Returns false if it
  /// does not get there, or past the ends of the edge.
  bool find(const btVector3& start, btScalar curvature) {
    if (!(length_ > 0)) return false;
    const btVector3 along = edge_.along / length_;
    const auto shareOf = [&](const btVector3& place) { return (place - edge_.from).dot(along) / length_; };
    share_ = shareOf(start);
    btScalar before = share_, slope = BT_LARGE_FLOAT;
    for (int i = 0; i < kEdgeLooks && isOn() && probe(); ++i) {
      const btScalar now = round.normal.dot(along), here = share_;
      if (btFabs(now) < kLeaning) return true;
      if (!(btFabs(now) < btFabs(slope))) return false;
      share_ = i == 0 ? shareOf(round.at - round.normal / curvature)
                      : here - now * (here - before) / (now - slope);
      before = here;
      slope = now;
    }
    return false;
  }

  RoundPoint round;
  btVector3 on_edge{0, 0, 0};

 private:
  bool isOn() const { return share_ > -kBeyondEnds && share_ < 1 + kBeyondEnds; }
  bool probe() {
    on_edge = edge_.from + edge_.along * share_;
    return nearest_round_(on_edge, round);
  }

  const SharpEdges::Edge& edge_;
  const NearestRound& nearest_round_;
  const btScalar length_;
  btScalar share_ = 0;
};

}  // namespace

bool lieOverEdge(const SharpEdges& solid, bool of_a, const NearestRound& nearest_round,
                 const OpposedPoints& points, const btVector3& to_top, EdgeContact& contact) {
  const std::size_t triangle = of_a ? points.triangle_a : points.triangle_b;
  const btVector3& start = of_a ? points.on_a : points.on_b;
  SharpEdges::Edge edge;
  if (!solid.edgeTowards(triangle, start, to_top, edge)) return false;
  // Else the top is on the face.
  const btVector3 outwards = solid.face(triangle).cross(edge.along);
  if (!(btFabs(to_top.dot(outwards)) > btFabs((edge.from - start).dot(outwards)))) return false;
  DeepestOfEdge deepest(edge, nearest_round);
  if (!deepest.find(start, of_a ? points.curvature_b : points.curvature_a)) return false;
  // Both faces of the edge are to fall away from the round surface.
  const SharpEdges::Faces faces = solid.facesOf(edge);
  const btVector3 out = -deepest.round.normal;
  for (const btVector3& inwards : faces.inwards) {
    if (!(inwards.dot(out) < -kLeaning)) return false;
  }
  const btVector3 normal = of_a ? out : deepest.round.normal;
  contact.points = points;
  contact.points.on_a = of_a ? deepest.on_edge + normal * solid.margin : deepest.round.at;
  contact.points.on_b = of_a ? deepest.round.at : deepest.on_edge - normal * solid.margin;
  contact.points.normal_a = contact.points.normal_b = normal;
  contact.along = edge.along.normalized();
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
