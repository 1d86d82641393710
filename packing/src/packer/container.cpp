#include "packer/container.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "innersphere/error.hpp"

namespace innersphere {

Container::Container(const Solid& solid) : solid_(solid) {
  const Bounds box = solid.bounds();
  double longest = 0, farthest = 0;
  for (int k = 0; k < 3; ++k) {
    if (!std::isfinite(box.min[k]) || !std::isfinite(box.max[k])) {
      throw Error(ErrorCode::bad_argument, "the bounds of '" + solid.name() + "' are not finite");
    }
    if (!(box.min[k] < box.max[k])) {
      throw Error(ErrorCode::no_sphere_fits,
                  "the bounds of '" + solid.name() + "' are empty, so there is nothing to fill");
    }
    longest = std::max(longest, box.max[k] - box.min[k]);
    farthest = std::max({farthest, std::abs(box.min[k]), std::abs(box.max[k])});
  }
  if (longest < 1e-20 || farthest > 1e20) {
    throw Error(ErrorCode::bad_argument,
                "the size of '" + solid.name() + "' is outside of 1e-20 to 1e20 m; scale it");
  }
  // A little room, so that no corner of the solid lies on the boundary of the unit cube.
  side_ = longest * (1 + 1e-9);
  for (int k = 0; k < 3; ++k) origin_[k] = 0.5 * (box.min[k] + box.max[k]) - 0.5 * side_;
  coarseness_ = std::sqrt(3.0) / 2 * std::numeric_limits<float>::epsilon() * farthest / side_;
  margin_ = 16 * std::numeric_limits<double>::epsilon() * (1 + farthest / side_);
}

Vec3d Container::toWorld(const Point& x) const {
  return {origin_[0] + side_ * x[0], origin_[1] + side_ * x[1], origin_[2] + side_ * x[2]};
}

Point Container::fromWorld(const Vec3d& p) const {
  return Point(p[0] - origin_[0], p[1] - origin_[1], p[2] - origin_[2]) / side_;
}

Container::Nearest Container::closest(const Point& x, double cutoff) const {
  const ClosestPoint hit = solid_.closestPoint(toWorld(x), cutoff * side_);
  if (std::isinf(hit.distance)) return {hit.distance, x};
  if (!std::isfinite(hit.distance + hit.point[0] + hit.point[1] + hit.point[2])) {
    throw Error(ErrorCode::not_finite, "'" + solid_.name() + "' has a closest point that is not a number");
  }
  return {hit.distance / side_, fromWorld(hit.point)};
}

Point Container::snap(const Point& x) const {
  Vec3d p = toWorld(x);
  for (double& component : p) {
    // Volatile: GCC 12 drops the rounding when it vectorises two such conversions.
    const volatile float rounded = static_cast<float>(component);
    component = rounded;
  }
  return fromWorld(p);
}

Ball Container::fit(const Point& snapped, double room) const {
  const double radius = (room - margin_) * side_;
  float rounded = static_cast<float>(radius);
  if (rounded > radius) rounded = std::nextafter(rounded, 0.0f);
  return {snapped, rounded / side_};
}

Sphere Container::toSphere(const Ball& ball) const {
  const Vec3d p = toWorld(ball.centre);
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]),
          static_cast<float>(ball.radius * side_)};
}

}  // namespace innersphere
