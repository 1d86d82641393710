#include "camera.hpp"

#include <algorithm>
#include <cmath>

#include "film/pose.hpp"

namespace innersphere::demo {
namespace {

using Eigen::Vector3f;

constexpr float kMargin = 1.08f;  // room around the outermost point

// Points that bound what is seen: surface vertices, or the spheres' centres with their radii where there is
// no surface.
struct Blob {
  Vector3f centre;
  float radius;
};

void addBlobs(const Film& film, std::size_t frame, std::vector<Blob>& blobs) {
  for (std::size_t i = 0; i < film.actors.size(); ++i) {
    const Shape& shape = film.shapes[film.actors[i].shape];
    const Eigen::Isometry3f to_world = transformOf(film.frame(frame)[i]);
    for (const auto& v : shape.surface.vertices) blobs.push_back({to_world * Vector3f(v[0], v[1], v[2]), 0});
    if (!shape.surface.vertices.empty()) continue;
    for (const Sphere& s : shape.spheres) blobs.push_back({to_world * Vector3f(s.x, s.y, s.z), s.radius});
  }
}

// The shortest distance from `target` at which every blob is between the two planes that bound the picture
// along `axis`, and how far the middle of the picture then is from the middle of the blobs.
struct Fit {
  float distance;
  float offset;
};

Fit fitAlong(const std::vector<Blob>& blobs, const Vector3f& target, const Vector3f& axis,
             const Vector3f& forward, float tangent) {
  const float widen = std::sqrt(1 + tangent * tangent);
  float positive = -1e30f;  // along the axis, what the planes have to clear
  float negative = -1e30f;
  for (const Blob& blob : blobs) {
    const Vector3f p = blob.centre - target;
    const float depth = p.dot(forward) * tangent;
    positive = std::max(positive, p.dot(axis) + blob.radius * widen - depth);
    negative = std::max(negative, -p.dot(axis) + blob.radius * widen - depth);
  }
  return {0.5f * (positive + negative) / tangent, 0.5f * (positive - negative)};
}

}  // namespace

Camera frameCamera(const Film& film, std::size_t frame, double aspect) {
  return frameCamera(film, std::vector<std::size_t>{frame}, aspect);
}

Camera frameCamera(const Film& film, const std::vector<std::size_t>& frames, double aspect) {
  const Viewpoint& view = film.viewpoint;
  Camera camera;
  const auto a = static_cast<float>(view.azimuth);
  const auto e = static_cast<float>(view.elevation);
  camera.forward = -Vector3f(std::sin(a) * std::cos(e), -std::cos(a) * std::cos(e), std::sin(e));
  camera.right = camera.forward.cross(Vector3f::UnitZ()).normalized();
  camera.up = camera.right.cross(camera.forward);
  camera.half_height = static_cast<float>(std::tan(view.field_of_view / 2));
  camera.half_width = camera.half_height * static_cast<float>(aspect);

  std::vector<Blob> blobs;
  for (const std::size_t frame : frames) addBlobs(film, frame, blobs);
  if (blobs.empty()) blobs.push_back({Vector3f::Zero(), 1});
  Vector3f target = blobs.front().centre;
  const Fit horizontal = fitAlong(blobs, target, camera.right, camera.forward, camera.half_width / kMargin);
  const Fit vertical = fitAlong(blobs, target, camera.up, camera.forward, camera.half_height / kMargin);
  target += horizontal.offset * camera.right + vertical.offset * camera.up;
  const float back = std::max(horizontal.distance, vertical.distance);
  camera.eye = target - back * camera.forward;

  float depth = 0;
  for (const Blob& blob : blobs) depth += (blob.centre - camera.eye).dot(camera.forward);
  camera.distance = depth / static_cast<float>(blobs.size());
  return camera;
}

}  // namespace innersphere::demo
