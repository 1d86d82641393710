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
  /// secants, the first of which takes the surface for a ball of this curvature [1/m]. What is straight along
  /// the edge, and leans from it little, bears all along: it stays where that is least. Returns false if it
  /// does not get there, or past the ends of the edge.
  bool find(const btVector3& start, btScalar curvature) {
    if (!(length_ > 0)) return false;
    along_ = edge_.along / length_;
    const auto shareOf = [&](const btVector3& place) { return (place - edge_.from).dot(along_) / length_; };
    share_ = shareOf(start);
    btScalar before = share_, slope = BT_LARGE_FLOAT, best_share = share_, least = BT_LARGE_FLOAT;
    bool is_straight = false;
    for (int i = 0; i < kEdgeLooks && isOn() && probe(); ++i) {
      const btScalar now = round.normal.dot(along_), here = share_;
      if (btFabs(now) < least) {
        least = btFabs(now);
        best_share = here;
      }
      is_straight = i > 0 && btFabs(now) > btFabs(slope) / 2;
      if (least < kLevel || is_straight) break;
      share_ = i == 0 ? shareOf(round.at - round.normal / curvature)
                      : here - now * (here - before) / (now - slope);
      before = here;
      slope = now;
    }
    if (!(least < (is_straight ? kSlopeBeside : kLeaning))) return false;
    share_ = best_share;
    return probe();
  }

  /// That of the round surface, across the edge: unit.
  btVector3 normal() const { return (round.normal - along_ * round.normal.dot(along_)).normalized(); }

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
  btVector3 along_{0, 0, 0};
  btScalar share_ = 0;
};

}  // namespace

EdgeProbe::FaceEnd lieOverEdge(const SharpEdges& solid, bool of_a, const NearestRound& nearest_round,
                               const OpposedPoints& points, const btVector3& to_top, EdgeContact& contact) {
  const std::size_t triangle = of_a ? points.triangle_a : points.triangle_b;
  const btVector3& start = of_a ? points.on_a : points.on_b;
  SharpEdges::Edge edge;
  using FaceEnd = EdgeProbe::FaceEnd;
  if (!solid.edgeTowards(triangle, start, to_top, edge)) return FaceEnd::on_face;
  // Else the top is on the face.
  const btVector3 outwards = solid.face(triangle).cross(edge.along);
  if (!(btFabs(to_top.dot(outwards)) > btFabs((edge.from - start).dot(outwards)))) return FaceEnd::on_face;
  const SharpEdges::Faces faces = solid.facesOf(edge);
  // Of a rim the mesh is a chord.
  if (solid.surface->normals().curvature(faces.across) != 0) return FaceEnd::unknown;
  DeepestOfEdge deepest(edge, nearest_round);
  if (!deepest.find(start, of_a ? points.curvature_b : points.curvature_a)) return FaceEnd::beyond;
  // No face of the edge is to rise beside the round surface: the top is on the one that does.
  const btVector3 out = -deepest.normal();
  const auto rises = [&](int i) { return !(faces.inwards[i].dot(out) < kLeaning); };
  if (rises(0)) return rises(1) ? FaceEnd::unknown : FaceEnd::on_face;
  if (rises(1)) return solid.isValley(edge) ? FaceEnd::unknown : FaceEnd::beyond;
  const btVector3 normal = of_a ? out : -out;
  contact.points = points;
  contact.points.on_a = of_a ? deepest.on_edge + normal * solid.margin : deepest.round.at;
  contact.points.on_b = of_a ? deepest.round.at : deepest.on_edge - normal * solid.margin;
  contact.points.normal_a = contact.points.normal_b = normal;
  contact.along = edge.along.normalized();
  return FaceEnd::in_edge;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
