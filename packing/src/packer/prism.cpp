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

CubeCorners cornersOf(const Point& centre, double half) {
  CubeCorners corners;
  for (int corner = 0; corner < 8; ++corner) {
    for (int k = 0; k < 3; ++k) corners(corner, k) = centre[k] + (corner >> k & 1 ? half : -half);
  }
  return corners;
}

double Prism::beside(const Point& x, double height) const {
  double nearest2 = std::numeric_limits<double>::infinity();
  bool inside = true;
  for (int k = 0; k < 3; ++k) {
    if (outwards_[k].dot(x - corners_[k]) <= 0) continue;
    inside = false;
    const Point edge = corners_[(k + 1) % 3] - corners_[k];
    const Point foot = x - corners_[k] - height * inwards_;
    const double along = std::clamp(foot.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    nearest2 = std::min(nearest2, (foot - along * edge).squaredNorm());
  }
  return inside ? 0 : std::sqrt(nearest2);
}

double Prism::farthestBehind(const CubeCorners& cube, CornerValues& distances) const {
  double depth = 0, farthest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Point x = cube.row(corner).matrix();
    const double height = inwards_.dot(x - corners_[0]), away = beside(x, height);
    depth = std::max(depth, -height);
    farthest = std::max(farthest, away);
    if (away > 0) {
      distances[corner] = height > 0 ? std::hypot(height, away) : away;
      continue;
    }
    distances[corner] = height;
    for (int k = 0; height < 0 && k < 3; ++k)
      distances[corner] = std::max(distances[corner], outwards_[k].dot(x - corners_[k]));
  }
  return depth > 0 ? std::hypot(deepest(cube, depth), farthest) : 0;
}

// Between the triangle's plane and the ball a sliver is left, which is deepest farthest from where they
// touch.
double Prism::deepest(const CubeCorners& cube, double depth) const {
  const double centre = inwards_.dot(corners_[0] - outside_.centre);
  if (outside_.radius == 0 || depth > centre) return depth;
  double beside2 = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Point way = cube.row(corner).matrix().transpose() - outside_.centre;
    beside2 = std::max(beside2, (way - inwards_.dot(way) * inwards_).squaredNorm());
  }
  const double chord2 = outside_.radius * outside_.radius - beside2;
  return chord2 > 0 ? std::clamp(centre - std::sqrt(chord2), 0.0, depth) : depth;
}

}  // namespace innersphere
