#include "packer/container.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/bounds.hpp"
#include "common/frame_origin.hpp"
#include "innersphere/error.hpp"
#include "mesh/mesh_report.hpp"
#include "mesh/mesh_solid.hpp"

namespace innersphere {
namespace {

// Sizes of a solid that it may be away from the origin: double precision then resolves 1e-8 of it.
constexpr double kFarthest = 1e8;

}  // namespace

Container::Container(const Solid& solid, const Reporter* reporter)
    : solid_(solid), reporter_(reporter), mesh_(dynamic_cast<const MeshSolid*>(&solid)) {
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
  if (farthest > kFarthest * longest) {
    throw Error(ErrorCode::no_sphere_fits,
                "'" + solid.name() + "' is " + text(farthest / longest) +
                    " of its sizes away from the origin, too far for double precision; move it there");
  }
  origin_ = frameOrigin(box);
  // A little room, so that no corner of the solid lies on the boundary of the unit cube.
  side_ = longest * (1 + 1e-9);
  corner_ = centre(box) - origin_ - 0.5 * Vec3d{side_, side_, side_};
  const Vec3d low = box.min - origin_, high = box.max - origin_;
  double reach = 0;
  for (int k = 0; k < 3; ++k) reach = std::max({reach, std::abs(low[k]), std::abs(high[k])});
  margin_ = 16 * std::numeric_limits<double>::epsilon() * (1 + farthest / side_);
  coarseness_ = std::sqrt(3.0) / 2 * std::numeric_limits<float>::epsilon() * reach / side_ + margin_;
}

Vec3d Container::inFrame(const Point& x) const {
  return {corner_[0] + side_ * x[0], corner_[1] + side_ * x[1], corner_[2] + side_ * x[2]};
}

Point Container::fromFrame(const Vec3d& p) const {
  return Point(p[0] - corner_[0], p[1] - corner_[1], p[2] - corner_[2]) / side_;
}

Vec3d Container::toWorld(const Point& x) const {
  return origin_ + inFrame(x);
}

Point Container::fromWorld(const Vec3d& p) const {
  return fromFrame(p - origin_);
}

Container::Nearest Container::closest(const Point& x, double cutoff) const {
  goOn();
  ClosestTriangle::Nearest hit;
  if (mesh_) {
    hit = mesh_->closestTriangle(toWorld(x), cutoff * side_);
  } else {
    static_cast<ClosestPoint&>(hit) = solid_.closestPoint(toWorld(x), cutoff * side_);
  }
  if (std::isinf(hit.distance)) return {hit.distance, x};
  if (!std::isfinite(hit.distance + hit.point[0] + hit.point[1] + hit.point[2])) {
    throw Error(ErrorCode::not_finite, "'" + solid_.name() + "' has a closest point that is not a number");
  }
  return {hit.distance / side_, fromWorld(hit.point), hit.triangle};
}

Ball Container::emptyBall(const Point& wall, const Point& side, double least, double most) const {
  const auto ball = [&](double radius) {
    return Ball{wall + radius * side, ClosestTriangle::kEmpty * radius};
  };
  if (mesh_) {
    const Vec3d way{side[0], side[1], side[2]};
    return ball(mesh_->emptyRadius(toWorld(wall), way, side_ * least, side_ * most) / side_);
  }
  Ball found = ball(most);
  for (int attempt = 0; attempt < 3; ++attempt) {
    const Nearest hit = closest(found.centre, found.radius);
    if (std::isinf(hit.distance)) return found;
    // The ball through both points, and a little less, as there may be a third.
    const Point way = hit.point - wall;
    const double next = 0.8 * way.squaredNorm() / (2 * way.dot(side));
    if (!(next > least && next < found.radius)) break;
    found = ball(next);
  }
  return {wall, 0};
}

bool Container::contains(const Point& x, const Nearest& nearest) const {
  return nearest.triangle ? mesh_->contains(toWorld(x), *nearest.triangle) : contains(x);
}

Ball Container::rounded(const Ball& ball) const {
  Vec3d p = inFrame(ball.centre);
  for (double& component : p) {
    // Volatile: GCC 12 drops the rounding when it vectorises two such conversions.
    const volatile float rounded = static_cast<float>(component);
    component = rounded;
  }
  const Point centre = fromFrame(p);
  const double radius = (ball.radius - (centre - ball.centre).norm() - margin_) * side_;
  float rounded = static_cast<float>(radius);
  if (rounded > radius) rounded = std::nextafter(rounded, 0.0f);
  return {centre, rounded / side_};
}

Sphere Container::toSphere(const Ball& ball) const {
  const Vec3d p = inFrame(ball.centre);
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]),
          static_cast<float>(ball.radius * side_)};
}

Surface Container::toSurface(const Mesh& mesh) const {
  Surface surface;
  surface.triangles = mesh.triangles;
  for (const Vec3d& v : mesh.vertices) {
    const Vec3d p = v - origin_;
    surface.vertices.push_back(
        {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  }
  return surface;
}

}  // namespace innersphere
