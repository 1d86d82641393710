#include "contact_normal.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Surfaces whose normals differ by less than 20 degrees oppose each other.
constexpr btScalar kOpposed = btScalar(0.94);
/// Else an edge or a corner lies on a face; if both bend, on one within 30 degrees of the direction of the
/// overlap.
constexpr btScalar kFace = btScalar(0.866);
/// Surfaces that bend less than this count as flat [rad].
constexpr btScalar kFlat = btScalar(1e-4);
/// Fewer measurements than this do not show whether a surface bends.
constexpr int kFew = 3;

/// Root mean square of the deviation of normals from their mean [rad].
btScalar bend(const std::vector<Measured>& measured, btVector3 Gap::*normal, bool only_opposed) {
  btVector3 sum(0, 0, 0);
  btScalar count = 0, squares = 0;
  for (const Measured& m : measured) {
    if (only_opposed && !opposed(m.gap)) continue;
    sum += m.gap.*normal;
    ++count;
  }
  if (!(count > 0)) return 0;
  for (const Measured& m : measured) {
    if (!only_opposed || opposed(m.gap)) squares += (m.gap.*normal).distance2(sum / count);
  }
  return btSqrt(squares / count);
}

}  // namespace

ContactNormal::ContactNormal(const std::vector<Measured>& measured, bool trust_b) {
  int count = 0;
  for (const Measured& m : measured) count += opposed(m.gap) ? 1 : 0;
  if (count < kFew) {
    weight_a_ = trust_b ? btScalar(0) : btScalar(0.5);
  } else {
    const btScalar a = bend(measured, &Gap::normal_a, true) + kFlat;
    const btScalar b = bend(measured, &Gap::normal_b, true) + kFlat;
    weight_a_ = b / (a + b);
  }
  flat_a_ = bend(measured, &Gap::normal_a, false) < 10 * kFlat;
  flat_b_ = bend(measured, &Gap::normal_b, false) < 10 * kFlat;
}

btVector3 ContactNormal::at(const Measured& m) const {
  const btVector3 &a = m.gap.normal_a, &b = m.gap.normal_b;
  if (opposed(m.gap)) return (a * weight_a_ + b * (1 - weight_a_)).normalized();
  if (flat_a_ != flat_b_) return flat_a_ ? a : b;
  const btVector3& nearest = a.dot(m.direction) > b.dot(m.direction) ? a : b;
  const bool edges = !flat_a_ && nearest.dot(m.direction) < kFace;
  return edges ? m.direction : nearest;
}

bool opposed(const Gap& gap) {
  return gap.normal_a.dot(gap.normal_b) > kOpposed;
}

btVector3 normalAlone(const Gap& gap, const btVector3& direction) {
  if (opposed(gap)) return (gap.normal_a + gap.normal_b).normalized();
  const btVector3& nearest =
      gap.normal_a.dot(direction) > gap.normal_b.dot(direction) ? gap.normal_a : gap.normal_b;
  return nearest.dot(direction) < kFace ? direction : nearest;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
