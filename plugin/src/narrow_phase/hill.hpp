// Describes the hill of the depth around a place where two curved surfaces meet.
#pragma once

#include <LinearMath/btVector3.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds two axes across a direction, the same for the same direction.
struct Across {
  explicit Across(const btVector3& direction) { btPlaneSpace1(direction, x, y); }
  Across(const btVector3& x_axis, const btVector3& y_axis) : x(x_axis), y(y_axis) {}
  btVector3 x, y;
};

/// Says how a surface bends: by how much its normal turns along a way on it [1/m], in two axes across the
/// normal. It is positive where convex.
struct Bend {
  btScalar xx = 0, xy = 0, yy = 0;

  static Bend round(btScalar curvature) { return {curvature, 0, curvature}; }
  /// Straight along an axis across the normal (unit), as an edge or a cylinder.
  static Bend about(const btVector3& axis, const Across& axes, btScalar curvature) {
    const btScalar x = axis.dot(axes.x), y = axis.dot(axes.y);
    return {curvature * y * y, -curvature * x * y, curvature * x * x};
  }
  btScalar mean() const { return (xx + yy) / 2; }
  /// Returns by how much it is more, or less, than the mean along the axes along which it is most and least.
  btScalar spread() const { return btSqrt((xx - yy) * (xx - yy) / 4 + xy * xy); }
  /// Returns true if it is hollow, at least along one axis, and along none convex, but for rounding.
  bool isHollow() const;
  /// Returns the bend of a surface that is convex by as much along each axis as this one is convex or hollow.
  Bend magnitude() const;
  /// Returns the turn of the normal along `way`.
  btVector3 turn(const btVector3& way, const Across& axes) const {
    const btScalar wx = way.dot(axes.x), wy = way.dot(axes.y);
    return axes.x * (xx * wx + xy * wy) + axes.y * (xy * wx + yy * wy);
  }
  /// Returns the same bend in two unit vectors across each other, instead of in `axes`.
  Bend along(const btVector3& x, const btVector3& y, const Across& axes) const {
    const btVector3 turn_x = turn(x, axes);
    return {turn_x.dot(x), turn_x.dot(y), turn(y, axes).dot(y)};
  }
};

/// Knows how fast the slope of the depth between two surfaces falls, in the two directions across where it
/// does so most and least. The slope is that of the depth over the place on B: of A's bend times the way
/// from there to the place on A, less A's normal, in which B's is the direction of the depth.
class Hill {
 public:
  Hill() = default;
  /// `depth` [m] is that at the place: surfaces in each other bend less than the sum of both.
  Hill(const Bend& a, const Bend& b, btScalar depth, const Across& axes);

  const btVector3& axis(int i) const { return axis_[i]; }
  /// Returns how fast the slope falls along an axis [1/m]. The first is the faster one.
  btScalar fall(int i) const { return fall_[i]; }
  /// Returns false if surfaces are flat along an axis, or one lies in the other, so that there is no top.
  bool hasTop(int i) const { return has_top_[i]; }
  /// Returns true if there is a top along the first axis only, and neither surface bends along the second
  /// one.
  bool isStraightRidge() const { return straight_ridge_; }
  /// Returns the way from where the slope is this to the top, as far as there is one [m].
  btVector3 toTop(const btVector3& slope) const;

 private:
  btVector3 axis_[2];
  btScalar fall_[2] = {0, 0};
  bool has_top_[2] = {false, false};
  bool straight_ridge_ = false;
};

/// Returns true if surfaces that touch are flat, or curved so that one lies in the other: their curvatures
/// add up to nothing, or less. Then there is no deepest point. A ball in a hollow that is hardly larger has
/// one: its hill is flat, but how far it spreads is for those to judge who ask for its top.
bool fitTogether(btScalar curvature_a, btScalar curvature_b);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
