#include "packer/prism.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace innersphere {

Prism::Prism(const std::array<Point, 3>& corners, const Point& inwards)
    : corners_(corners), inwards_(inwards) {
  for (int k = 0; k < 3; ++k) {
    outwards_[k] = (corners[(k + 1) % 3] - corners[k]).cross(inwards).normalized();
    if (outwards_[k].dot(corners[(k + 2) % 3] - corners[k]) > 0) outwards_[k] *= -1;
  }
}

double Prism::beside(const Point& x) const {
  double nearest2 = std::numeric_limits<double>::infinity();
  bool inside = true;
  for (int k = 0; k < 3; ++k) {
    if (outwards_[k].dot(x - corners_[k]) <= 0) continue;
    inside = false;
    const Point edge = corners_[(k + 1) % 3] - corners_[k];
    const Point foot = x - corners_[k] - height(x) * inwards_;
    const double along = std::clamp(foot.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    nearest2 = std::min(nearest2, (foot - along * edge).squaredNorm());
  }
  return inside ? 0 : std::sqrt(nearest2);
}

double Prism::distance(const Point& x) const {
  const double h = height(x), away = beside(x);
  if (away > 0) return h > 0 ? std::hypot(h, away) : away;
  double most = h;
  if (h < 0) {
    for (int k = 0; k < 3; ++k) most = std::max(most, outwards_[k].dot(x - corners_[k]));
  }
  return most;
}

double Prism::farthestBehind(const Point& centre, double half) const {
  double depth = 0, away = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Point x = centre + half * Point(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    depth = std::max(depth, -height(x));
    away = std::max(away, beside(x));
  }
  return depth > 0 ? std::hypot(depth, away) : 0;
}

}  // namespace innersphere
