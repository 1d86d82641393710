#include "contact_normal.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Surfaces whose normals differ by less than 20 degrees oppose each other.
constexpr btScalar kOpposed = btScalar(0.94);
/// Else an edge or a corner lies on a face; if both bend, on one within 30 degrees of the direction of the
/// overlap.
constexpr btScalar kFace = btScalar(0.866);
/// Normals that deviate less than this are those of one face [rad].
constexpr btScalar kFlat = btScalar(1e-3);

/// Root mean square of the deviation of normals from their mean [rad].
btScalar bend(const std::vector<Measured>& measured, btVector3 Gap::*normal) {
  btVector3 sum(0, 0, 0);
  btScalar squares = 0;
  const btScalar count = btMax(btScalar(measured.size()), btScalar(1));
  for (const Measured& m : measured) sum += m.gap.*normal;
  for (const Measured& m : measured) squares += (m.gap.*normal).distance2(sum / count);
  return btSqrt(squares / count);
}

/// Where the surfaces oppose each other.
btVector3 mean(const Gap& gap) {
  const btScalar a = btFabs(gap.curvature_a), b = btFabs(gap.curvature_b);
  const btScalar weight_a = a + b > 0 ? b / (a + b) : btScalar(0.5);
  return (gap.normal_a * weight_a + gap.normal_b * (1 - weight_a)).normalized();
}

}  // namespace

ContactNormal::ContactNormal(const std::vector<Measured>& measured)
    : flat_a_(bend(measured, &Gap::normal_a) < kFlat), flat_b_(bend(measured, &Gap::normal_b) < kFlat) {}

btVector3 ContactNormal::at(const Measured& m) const {
  const btVector3 &a = m.gap.normal_a, &b = m.gap.normal_b;
  if (opposed(m.gap)) return mean(m.gap);
  if (flat_a_ != flat_b_) return flat_a_ ? a : b;
  const btVector3& nearest = a.dot(m.direction) > b.dot(m.direction) ? a : b;
  const bool edges = !flat_a_ && nearest.dot(m.direction) < kFace;
  return edges ? m.direction : nearest;
}

bool opposed(const Gap& gap) {
  return gap.normal_a.dot(gap.normal_b) > kOpposed;
}

btVector3 normalAlone(const Gap& gap, const btVector3& direction) {
  if (opposed(gap)) return mean(gap);
  const btVector3& nearest =
      gap.normal_a.dot(direction) > gap.normal_b.dot(direction) ? gap.normal_a : gap.normal_b;
  return nearest.dot(direction) < kFace ? direction : nearest;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
