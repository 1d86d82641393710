#include "narrow_phase/contact_normal.hpp"

#include <optional>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Surfaces whose normals differ by less than 20 degrees oppose each other.
constexpr btScalar kOpposed = btScalar(0.94);
/// Else an edge or a corner lies on a face; if both bend, on one within 30 degrees of the direction of the
/// overlap.
constexpr btScalar kFace = btScalar(0.866);
/// A face that ends this much sooner than the other has its edge there.
constexpr btScalar kEdge = btScalar(0.25);
/// Normals that deviate less than this are those of one face [rad].
constexpr btScalar kFlat = btScalar(1e-3);

/// Root mean square of the deviation of normals from their mean [rad].
btScalar bend(const std::vector<ProbedSample>& measured, btVector3 OpposedPoints::*normal) {
  btVector3 sum(0, 0, 0);
  btScalar squares = 0;
  const btScalar count = btMax(btScalar(measured.size()), btScalar(1));
  for (const ProbedSample& m : measured) sum += m.gap.*normal;
  for (const ProbedSample& m : measured) squares += (m.gap.*normal).distance2(sum / count);
  return btSqrt(squares / count);
}

/// Where the surfaces oppose each other. `face_a`: weight of A's normal if both are flat.
btVector3 mean(const OpposedPoints& gap, btScalar face_a) {
  const btScalar a = btFabs(gap.curvature_a), b = btFabs(gap.curvature_b);
  const btScalar weight_a = a + b > 0 ? b / (a + b) : face_a;
  return (gap.normal_a * weight_a + gap.normal_b * (1 - weight_a)).normalized();
}

/// The deepest contact of two faces that are tilted against each other; null if there is none.
const ProbedSample* deepestTilted(const std::vector<ProbedSample>& measured) {
  const ProbedSample* deepest = nullptr;
  btScalar most = 0;
  for (const ProbedSample& m : measured) {
    const OpposedPoints& gap = m.gap;
    if (!opposed(gap) || gap.curvature_a != 0 || gap.curvature_b != 0) continue;
    if (gap.normal_a.distance(gap.normal_b) < kFlat) continue;
    const btScalar depth = (gap.on_a - gap.on_b).dot(m.direction);
    if (deepest == nullptr || depth > most) {
      deepest = &m;
      most = depth;
    }
  }
  return deepest;
}

/// Of two faces that meet at an angle, whether A's bears the other one, which ends in an edge where the
/// contact would get deeper. Nothing if two edges cross.
std::optional<bool> isFaceOfA(const OpposedPoints& gap, const SurfaceProbe& probe) {
  const SurfaceProbe::Reach reach = probe.reach(gap, (gap.normal_b - gap.normal_a).normalized());
  if (reach.a < kEdge * reach.b) return false;
  if (reach.b < kEdge * reach.a) return true;
  return std::nullopt;
}

}  // namespace

ContactNormal::ContactNormal(const std::vector<ProbedSample>& measured, const SurfaceProbe& probe)
    : probe_(&probe),
      flat_a_(bend(measured, &OpposedPoints::normal_a) < kFlat),
      flat_b_(bend(measured, &OpposedPoints::normal_b) < kFlat) {
  if (flat_a_ != flat_b_) {
    face_a_ = flat_a_ ? btScalar(1) : btScalar(0);
  } else if (const ProbedSample* m = deepestTilted(measured)) {
    if (const std::optional<bool> a = isFaceOfA(m->gap, probe)) face_a_ = *a ? btScalar(1) : btScalar(0);
  }
}

btVector3 ContactNormal::at(const ProbedSample& m) const {
  const btVector3 &a = m.gap.normal_a, &b = m.gap.normal_b;
  if (opposed(m.gap)) return mean(m.gap, face_a_);
  const bool one_is_flat = flat_a_ != flat_b_;
  if (one_is_flat && probe_->exactB()) return flat_a_ ? a : b;
  if (const std::optional<bool> on_a = isFaceOfA(m.gap, *probe_)) return *on_a ? a : b;
  if (one_is_flat) return flat_a_ ? a : b;
  const btVector3& nearest = a.dot(m.direction) > b.dot(m.direction) ? a : b;
  const bool edges = !flat_a_ && nearest.dot(m.direction) < kFace;
  return edges ? m.direction : nearest;
}

bool opposed(const OpposedPoints& gap) {
  return gap.normal_a.dot(gap.normal_b) > kOpposed;
}

btVector3 normalAlone(const OpposedPoints& gap, const btVector3& direction) {
  if (opposed(gap)) return mean(gap, btScalar(0.5));
  const btVector3& nearest =
      gap.normal_a.dot(direction) > gap.normal_b.dot(direction) ? gap.normal_a : gap.normal_b;
  return nearest.dot(direction) < kFace ? direction : nearest;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
