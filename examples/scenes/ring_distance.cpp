#include "ring_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

namespace innersphere::demo {
namespace {

using Eigen::Vector3d;

struct Ring {
  Vector3d centre, u, v, normal;

  Ring(const BodyState& state, int axis) : centre(state.position.data()) {
    const auto& q = state.rotation;
    const Eigen::Matrix3d axes = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
    normal = axes.col(axis);
    u = axes.col((axis + 1) % 3);
    v = axes.col((axis + 2) % 3);
  }
};

// The distance of a point to a circle.
double toCircle(const Vector3d& p, const Ring& ring, double radius) {
  const Vector3d d = p - ring.centre;
  const double height = d.dot(ring.normal);
  const double across = std::sqrt(std::max(0.0, d.squaredNorm() - height * height));
  return std::hypot(height, across - radius);
}

}  // namespace

double distanceOfRings(const BodyState& a, const BodyState& b, int axis, double radius) {
  const Ring ring_a(a, axis), ring_b(b, axis);
  const auto at = [&](double angle) {
    return toCircle(ring_a.centre + radius * (std::cos(angle) * ring_a.u + std::sin(angle) * ring_a.v),
                    ring_b, radius);
  };
  constexpr int kSamples = 48;
  double best = std::numeric_limits<double>::infinity(), where = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSamples;
    if (const double d = at(angle); d < best) best = d, where = angle;
  }
  for (double step = std::numbers::pi / kSamples; step > 1e-4; step /= 2) {
    for (const double angle : {where - step, where + step}) {
      if (const double d = at(angle); d < best) best = d, where = angle;
    }
  }
  return best;
}

}  // namespace innersphere::demo
