// Finds the nearest point of one triangle, in double.
#pragma once

#include <array>
#include <optional>

#include "common/bounds.hpp"

namespace innersphere {

/// This is a triangle with what its nearest-point query needs again and again, in two lines of the cache.
class alignas(64) Triangle {
 public:
  Triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) : a_(a), b_(b), c_(c) {
    const Vec3d ab = b - a, ac = c - a, bc = c - b, n = cross(ab, ac);
    const double bb = dot(ab, ab);
    const double cc = dot(ac, ac);
    const double bc2 = dot(bc, bc);
    const double nn = dot(n, n);
    // Below this sine the coordinates of the foot point lose too many digits to decide what is nearest.
    constexpr double kThinSine2 = 1e-10;
    thin_ = !(nn > kThinSine2 * bb * cc && nn > kThinSine2 * bb * bc2);
    if (nn > 0) {
      to_s_ = (1 / nn) * cross(ac, n);
      to_t_ = (1 / nn) * cross(n, ab);
    }
  }

  /// Finds the nearest point to p and returns its squared distance [m^2]. The point lies on the triangle even
  /// where rounding picks a wrong one, so the distance errs upwards only, and by no more than rounding.
  double closest(const Vec3d& p, Vec3d& point) const {
    const Vec3d ap = p - a_, ab = b_ - a_, ac = c_ - a_;
    const double s = dot(to_s_, ap);
    const double t = dot(to_t_, ap);
    const bool inside = s >= 0 && t >= 0 && s + t <= 1;
    Vec3d best{};
    double best2 = std::numeric_limits<double>::infinity();
    const auto offer = [&](const Vec3d& q) {
      const Vec3d away = ap - q;
      const double d2 = dot(away, away);
      if (d2 < best2) {
        best2 = d2;
        best = q;
      }
    };
    if (inside) offer(s * ab + t * ac);
    const auto part = [](double along, const Vec3d& edge) {
      const double length2 = dot(edge, edge);
      return length2 > 0 ? clamp01(along * (1 / length2)) : 0;
    };
    // Outside, the nearest point lies on an edge whose line separates the triangle from the foot point.
    if (!inside || thin_) {
      if (t < 0 || thin_) offer(part(dot(ap, ab), ab) * ab);
      if (s < 0 || thin_) offer(part(dot(ap, ac), ac) * ac);
      if (s + t > 1 || thin_) {
        const Vec3d bc = ac - ab;
        offer(ab + part(dot(ap - ab, bc), c_ - b_) * bc);
      }
    }
    point = a_ + best;
    return best2;
  }

  /// Returns the corners, or nothing of a triangle so thin that rounding decides where it faces.
  std::optional<std::array<Vec3d, 3>> cornersIfNotThin() const {
    if (thin_) return std::nullopt;
    return std::array<Vec3d, 3>{a_, a_ + (b_ - a_), a_ + (c_ - a_)};
  }

  /// Returns how far p is in front of the triangle's plane [m], if the nearest point of the triangle is
  /// clearly inside of it, away from its edges, or `anywhere`; else 0.
  double inFront(const Vec3d& p, bool anywhere) const {
    constexpr double kClear = 1e-9;
    const Vec3d ap = p - a_;
    const double s = dot(to_s_, ap), t = dot(to_t_, ap);
    if (thin_ || !(anywhere || (s > kClear && t > kClear && s + t < 1 - kClear))) return 0;
    const Vec3d n = cross(b_ - a_, c_ - a_);
    return dot(n, ap) / norm(n);
  }

 private:
  static double clamp01(double x) { return x < 0 ? 0 : x > 1 ? 1 : x; }

  Vec3d a_, b_, c_;
  Vec3d to_s_{}, to_t_{};  ///< dual basis: foot point = a + s ab + t ac with s = to_s . ap, t = to_t . ap
  bool thin_;
};

}  // namespace innersphere
