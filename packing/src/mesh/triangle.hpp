// Finds the nearest point of one triangle, in double.
#pragma once

#include <array>
#include <optional>

#include "common/bounds.hpp"

namespace innersphere {

/// This is a triangle with what its nearest-point query needs again and again.
class Triangle {
 public:
  Triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) : a_(a), ab_(b - a), ac_(c - a) {
    const Vec3d bc = c - b;
    const double bb = dot(ab_, ab_);
    const double cc = dot(ac_, ac_);
    const double bc2 = dot(bc, bc);
    inverse_ab_ = bb > 0 ? 1 / bb : 0;
    inverse_ac_ = cc > 0 ? 1 / cc : 0;
    inverse_bc_ = bc2 > 0 ? 1 / bc2 : 0;
    const Vec3d n = cross(ab_, ac_);
    const double nn = dot(n, n);
    // Below this sine the coordinates of the foot point lose too many digits to decide what is nearest.
    constexpr double kThinSine2 = 1e-10;
    thin_ = !(nn > kThinSine2 * bb * cc && nn > kThinSine2 * bb * bc2);
    if (nn > 0) {
      to_s_ = (1 / nn) * cross(ac_, n);
      to_t_ = (1 / nn) * cross(n, ab_);
    }
  }

  /// Finds the nearest point to p and returns its squared distance [m^2]. The point lies on the triangle even
  /// where rounding picks a wrong one, so the distance errs upwards only, and by no more than rounding.
  double closest(const Vec3d& p, Vec3d& point) const {
    const Vec3d ap = p - a_;
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
    if (inside) offer(s * ab_ + t * ac_);
    // Outside, the nearest point lies on an edge whose line separates the triangle from the foot point.
    if (!inside || thin_) {
      if (t < 0 || thin_) offer(clamp01(dot(ap, ab_) * inverse_ab_) * ab_);
      if (s < 0 || thin_) offer(clamp01(dot(ap, ac_) * inverse_ac_) * ac_);
      if (s + t > 1 || thin_) {
        const Vec3d bc = ac_ - ab_;
        offer(ab_ + clamp01(dot(ap - ab_, bc) * inverse_bc_) * bc);
      }
    }
    point = a_ + best;
    return best2;
  }

  /// Returns the corners, or nothing of a triangle so thin that rounding decides where it faces.
  std::optional<std::array<Vec3d, 3>> cornersIfNotThin() const {
    if (thin_) return std::nullopt;
    return std::array<Vec3d, 3>{a_, a_ + ab_, a_ + ac_};
  }

  /// Returns how far p is in front of the triangle's plane [m], if the nearest point of the triangle is
  /// clearly inside of it, away from its edges, or `anywhere`; else 0.
  double inFront(const Vec3d& p, bool anywhere) const {
    constexpr double kClear = 1e-9;
    const Vec3d ap = p - a_;
    const double s = dot(to_s_, ap), t = dot(to_t_, ap);
    if (thin_ || !(anywhere || (s > kClear && t > kClear && s + t < 1 - kClear))) return 0;
    const Vec3d n = cross(ab_, ac_);
    return dot(n, ap) / norm(n);
  }

 private:
  static double clamp01(double x) { return x < 0 ? 0 : x > 1 ? 1 : x; }

  Vec3d a_, ab_, ac_;
  Vec3d to_s_{}, to_t_{};  ///< dual basis: foot point = a + s ab + t ac with s = to_s . ap, t = to_t . ap
  double inverse_ab_, inverse_ac_, inverse_bc_;
  bool thin_;
};

}  // namespace innersphere
