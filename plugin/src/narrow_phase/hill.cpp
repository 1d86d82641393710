#include "narrow_phase/hill.hpp"

#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Ratio: along a ridge, what is left of how fast the slope falls across it is less than this part, and so is
/// what is left of two curvatures where one surface lies in the other.
constexpr btScalar kRounding = 64 * SIMD_EPSILON;
/// Ratio: a surface that bends by no more than this part of what it does across is straight. Normals of
/// meshes are not right to the last digit.
constexpr btScalar kStraight = btScalar(1e-5);

}  // namespace

bool Bend::isHollow() const {
  if (!(mean() < 0)) return false;
  const btScalar apart = spread();
  return mean() + apart <= kConvex * (apart - mean());
}

Bend Bend::magnitude() const {
  const btScalar middle = mean(), apart = spread();  // the bends along both axes are middle +- apart
  if (btFabs(middle) >= apart) return middle < 0 ? Bend{-xx, -xy, -yy} : *this;
  const btScalar part = middle / apart;
  return {apart + part * (xx - middle), part * xy, apart + part * (yy - middle)};
}

Hill::Hill(const Bend& a, const Bend& b, btScalar depth, const Across& axes) {
  const btScalar xx = a.xx + b.xx - depth * (a.xx * b.xx + a.xy * b.xy);
  const btScalar yy = a.yy + b.yy - depth * (a.yy * b.yy + a.xy * b.xy);
  const btScalar xy = a.xy + b.xy - depth / 2 * (a.xy * (b.xx + b.yy) + b.xy * (a.xx + a.yy));
  const Bend falls{xx, xy, yy};
  const btScalar middle = falls.mean(), half = (xx - yy) / 2, spread = falls.spread();
  // Both lead to the axis without cancellation.
  btVector3 first =
      half > 0 ? axes.x * (half + spread) + axes.y * xy : axes.x * xy + axes.y * (spread - half);
  axis_[0] = first.length2() > 0 ? first.normalized() : axes.x;
  axis_[1] = axes.x * -axis_[0].dot(axes.y) + axes.y * axis_[0].dot(axes.x);
  if (xx == 0 && xy == 0 && yy == 0) return;
  fall_[0] = middle + spread;
  fall_[1] = middle - spread;
  const auto bendAlong = [&](const Bend& bend, int i) { return bend.turn(axis_[i], axes).dot(axis_[i]); };
  btScalar bent[2];
  for (int i = 0; i < 2; ++i) {
    const btScalar of_a = bendAlong(a, i), of_b = bendAlong(b, i);
    has_top_[i] = fall_[i] > kRounding * fall_[0] && !fitTogether(of_a, of_b);
    bent[i] = btFabs(of_a) + btFabs(of_b);
  }
  straight_ridge_ = has_top_[0] && !has_top_[1] && bent[1] <= kStraight * bent[0];
}

btVector3 Hill::toTop(const btVector3& slope) const {
  btVector3 way(0, 0, 0);
  for (int i = 0; i < 2; ++i) {
    if (has_top_[i]) way += axis_[i] * (slope.dot(axis_[i]) / fall_[i]);
  }
  return way;
}

bool fitTogether(btScalar curvature_a, btScalar curvature_b) {
  return !(curvature_a + curvature_b > kRounding * (btFabs(curvature_a) + btFabs(curvature_b)));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
