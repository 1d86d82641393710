#include "centre_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_math.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

using Points = std::vector<Vec3d>;

Vec3d minus(const Vec3d& a, const Vec3d& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double dot(const Vec3d& a, const Vec3d& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Points placed(const CentreLine& line, const BodyState& state) {
  const auto& [x, y, z, w] = state.rotation;
  Points points;
  for (const Vec3d& p : line.points) {
    const Vec3d u{2 * (y * p[2] - z * p[1]), 2 * (z * p[0] - x * p[2]), 2 * (x * p[1] - y * p[0])};
    points.push_back({state.position[0] + p[0] + w * u[0] + y * u[2] - z * u[1],
                      state.position[1] + p[1] + w * u[1] + z * u[0] - x * u[2],
                      state.position[2] + p[2] + w * u[2] + x * u[1] - y * u[0]});
  }
  if (line.closed) points.push_back(points.front());
  return points;
}

// Squared, of a point and a segment.
double squareToSegment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d along = minus(b, a), to_p = minus(p, a);
  const double t = std::clamp(dot(to_p, along) / dot(along, along), 0.0, 1.0);
  const Vec3d off{to_p[0] - t * along[0], to_p[1] - t * along[1], to_p[2] - t * along[2]};
  return dot(off, off);
}

double squareFromCorners(const Points& corners, const Points& line) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3d& p : corners) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
      least = std::min(least, squareToSegment(p, line[i], line[i + 1]));
  }
  return least;
}

}  // namespace

CentreLine centreLineOf(const SceneWorld& world, std::size_t body, const Points& points, bool closed) {
  CentreLine line{body, {}, closed};
  const btTransform& to_body = world.solidOf(body)->shape->principalTransform();
  for (const Vec3d& p : points) line.points.push_back(toVec3d(to_body * vec(p[0], p[1], p[2])));
  return line;
}

double distanceOf(const CentreLine& a, const CentreLine& b, const Recording& r, std::size_t step) {
  const Points p = placed(a, r.body(a.body, step)), q = placed(b, r.body(b.body, step));
  return std::sqrt(std::min(squareFromCorners(p, q), squareFromCorners(q, p)));
}

}  // namespace innersphere::demo
