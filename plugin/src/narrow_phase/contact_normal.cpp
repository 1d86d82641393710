#include "narrow_phase/contact_normal.hpp"

#include <optional>

#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Root mean square of the deviation of normals from their mean [rad].
btScalar bend(const std::vector<ProbedSample>& samples, btVector3 OpposedPoints::*normal) {
  btVector3 sum(0, 0, 0);
  btScalar squares = 0;
  const btScalar count = btMax(btScalar(samples.size()), btScalar(1));
  for (const ProbedSample& s : samples) sum += s.points.*normal;
  for (const ProbedSample& s : samples) squares += (s.points.*normal).distance2(sum / count);
  return btSqrt(squares / count);
}

/// Ratio: along a way on which surfaces bend so many times less than across it, their bend is not known well
/// enough to tell how far the top is.
constexpr btScalar kWeakBend = 10;

/// Where the surfaces oppose each other. `face_a`: weight of A's normal if both are flat.
btVector3 mean(const OpposedPoints& points, btScalar face_a) {
  const btScalar a = btFabs(points.curvature_a), b = btFabs(points.curvature_b);
  const btScalar weight_a = a + b > 0 ? b / (a + b) : face_a;
  return (points.normal_a * weight_a + points.normal_b * (1 - weight_a)).normalized();
}

/// A surface that bends bears an edge of the other along its own normal, from wherever a sphere sees the
/// edge.
bool isOnEdge(const OpposedPoints& points) {
  const btScalar a = btFabs(points.curvature_a), b = btFabs(points.curvature_b);
  return btMin(a, b) > 0 && btMax(a, b) > kEdgeBends * btMin(a, b);
}

/// Whether a hollow bears the ends of a flat face, wherever between them it is seen.
bool isHollowUnderFlat(btScalar hollow, btScalar flat) {
  return hollow < 0 && flat == 0;
}

/// The deepest contact of two faces that are tilted against each other; null if there is none.
const ProbedSample* deepestTilted(const std::vector<ProbedSample>& samples) {
  const ProbedSample* deepest = nullptr;
  btScalar most = 0;
  for (const ProbedSample& s : samples) {
    const OpposedPoints& points = s.points;
    if (!opposed(points) || !points.areFlat()) continue;
    if (points.normal_a.distance(points.normal_b) < kOneNormal) continue;
    const btScalar depth = points.depthAlong(s.direction);
    if (deepest == nullptr || depth > most) {
      deepest = &s;
      most = depth;
    }
  }
  return deepest;
}

/// Whether a flat face bears a surface that bends, and ends in no edge: it goes on to where that has its
/// normal. `slope` is how far the normals are apart.
bool isFlatBelowRound(btScalar flat, btScalar flat_ends, btScalar round, btScalar round_ends,
                      btScalar slope) {
  return flat == 0 && round > 0 && round_ends >= BT_LARGE_FLOAT && flat_ends * round > slope;
}

/// Of two faces that meet at an angle, whether A's bears the other one, which ends in an edge where the
/// contact would get deeper. Nothing if two edges cross.
std::optional<bool> isFaceOfA(const OpposedPoints& points, const FaceExtents* extents) {
  if (extents == nullptr) return false;
  const btScalar slope = points.normal_b.distance(points.normal_a);
  const btVector3 deeper = (points.normal_b - points.normal_a) / slope;
  const FaceExtents::EdgeDistances distances = extents->edgeDistances(points, deeper);
  if (isFlatBelowRound(points.curvature_b, distances.b, points.curvature_a, distances.a, slope)) return false;
  if (isFlatBelowRound(points.curvature_a, distances.a, points.curvature_b, distances.b, slope)) return true;
  if (distances.a < kEndsSooner * distances.b) return false;
  if (distances.b < kEndsSooner * distances.a) return true;
  return std::nullopt;
}

}  // namespace

ContactNormal::ContactNormal(const std::vector<ProbedSample>& samples, const FaceExtents* extents,
                             const SurfaceProbe* bends)
    : extents_(extents),
      bends_(bends),
      flat_a_(bend(samples, &OpposedPoints::normal_a) < kOneNormal),
      flat_b_(bend(samples, &OpposedPoints::normal_b) < kOneNormal) {
  if (flat_a_ != flat_b_) {
    face_a_ = flat_a_ ? btScalar(1) : btScalar(0);
  } else if (const ProbedSample* s = deepestTilted(samples)) {
    if (const std::optional<bool> a = isFaceOfA(s->points, extents)) face_a_ = *a ? btScalar(1) : btScalar(0);
  }
}

btVector3 ContactNormal::at(const ProbedSample& sample) const {
  const btVector3 &a = sample.points.normal_a, &b = sample.points.normal_b;
  // Both lean the same way. That of a ball leads through its centre, wherever it is taken.
  const btScalar bend_a = sample.points.curvature_a, bend_b = sample.points.curvature_b;
  if (extents_ == nullptr && bend_a < 0 && bend_b > 0) return b;
  // The wall of a hole through what lies flat on a face bears no such ends.
  if (a.dot(b) > kFrontCosine) {
    if (isHollowUnderFlat(bend_a, bend_b)) return a;
    if (isHollowUnderFlat(bend_b, bend_a)) return b;
  }
  const bool one_is_flat = flat_a_ != flat_b_;
  if (one_is_flat && extents_ != nullptr && sample.points.areFlat() && a.distance(b) > kOneNormal) {
    if (const std::optional<bool> on_a = isFaceOfA(sample.points, extents_)) return *on_a ? a : b;
  }
  const bool lies_on_it = opposed(sample.points) || isOnEdge(sample.points);
  if (bends_ != nullptr && bend_a != 0 && bend_b != 0 && a.distance2(b) > kOneNormal * kOneNormal) {
    if (const std::optional<btVector3> normal = betweenBends(sample.points, lies_on_it)) return *normal;
  }
  if (lies_on_it) return mean(sample.points, face_a_);
  if (one_is_flat && extents_ == nullptr) return flat_a_ ? a : b;
  if (const std::optional<bool> on_a = isFaceOfA(sample.points, extents_)) return *on_a ? a : b;
  if (one_is_flat) return flat_a_ ? a : b;
  const btVector3& nearest = a.dot(sample.direction) > b.dot(sample.direction) ? a : b;
  const bool edges = !flat_a_ && nearest.dot(sample.direction) < kBearingFaceCosine;
  return edges ? sample.direction : nearest;
}

/// What mean() is of round surfaces, where they bend otherwise along other axes: A's normal, turned by as
/// much as A bends on the way on which both, if convex, turn by what is between their normals. Nothing where
/// they hardly bend along that way. If they do not lie on each other (`lie`), nothing, too, where they meet
/// at an angle that no bend explains, or where a face ends in an edge on that way.
std::optional<btVector3> ContactNormal::betweenBends(const OpposedPoints& points, bool lie) const {
  const Across axes((points.normal_a + points.normal_b).normalized());
  const SurfaceProbe::Bends bends = bends_->bends(points, axes);
  const Bend a = bends.a.magnitude(), b = bends.b.magnitude();
  const Hill hill(a, b, 0, axes);
  const btVector3 apart = points.normal_a - points.normal_b, way = hill.toTop(apart);
  btVector3 normal = points.normal_a - a.turn(way, axes);
  for (int i = 0; i < 2; ++i) {
    if (hill.hasTop(i)) continue;
    const btScalar angle = apart.dot(hill.axis(i));
    if (!lie && btFabs(angle) > kOneNormal) return std::nullopt;
    normal -= hill.axis(i) * (angle / 2);
  }
  if (way.length() * hill.fall(0) > kWeakBend * apart.length()) return std::nullopt;
  if (!lie && extents_ != nullptr) {
    const FaceExtents::EdgeDistances ends = extents_->edgeDistances(points, -apart.normalized());
    if (btMin(ends.a, ends.b) < way.length()) return std::nullopt;
  }
  return normal.normalized();
}

bool opposed(const OpposedPoints& points) {
  return points.normal_a.dot(points.normal_b) > kOpposedCosine;
}

btVector3 normalAlone(const OpposedPoints& points, const btVector3& direction) {
  if (opposed(points)) return mean(points, btScalar(0.5));
  const btVector3& nearest =
      points.normal_a.dot(direction) > points.normal_b.dot(direction) ? points.normal_a : points.normal_b;
  return nearest.dot(direction) < kBearingFaceCosine ? direction : nearest;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
