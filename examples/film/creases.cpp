#include "creases.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace innersphere::demo {
namespace {

using Eigen::Vector3f;

Vector3f load(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

// The angle of a triangle at its corner weights its share of the corner's normal, so that the result does not
// depend on how a flat face was cut into triangles.
float cornerAngle(const Vector3f& at, const Vector3f& b, const Vector3f& c) {
  const Vector3f u = b - at;
  const Vector3f v = c - at;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

struct Corner {
  std::uint32_t triangle;
  std::uint32_t index;  // 0, 1 or 2
  float weight;
};

}  // namespace

ShadedSurface splitCreases(const Surface& surface, double crease_angle) {
  std::vector<Vector3f> face_normals;
  std::vector<std::vector<Corner>> corners(surface.vertices.size());
  face_normals.reserve(surface.triangles.size());
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    std::array<Vector3f, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = load(surface.vertices[surface.triangles[t][k]]);
    face_normals.push_back((p[1] - p[0]).cross(p[2] - p[0]).normalized());
    for (std::uint32_t k = 0; k < 3; ++k) {
      corners[surface.triangles[t][k]].push_back({t, k, cornerAngle(p[k], p[(k + 1) % 3], p[(k + 2) % 3])});
    }
  }

  ShadedSurface result;
  result.triangles.resize(surface.triangles.size());
  const float limit = static_cast<float>(std::cos(crease_angle));
  for (std::uint32_t v = 0; v < surface.vertices.size(); ++v) {
    const std::size_t first_copy = result.vertices.size();
    for (const Corner& corner : corners[v]) {
      Vector3f normal = Vector3f::Zero();
      for (const Corner& other : corners[v]) {
        if (face_normals[corner.triangle].dot(face_normals[other.triangle]) >= limit) {
          normal += other.weight * face_normals[other.triangle];
        }
      }
      normal = normal.norm() > 0 ? normal.normalized() : face_normals[corner.triangle];
      // Corners with the same normal share a vertex.
      std::size_t copy = first_copy;
      while (copy < result.vertices.size() && load(result.normals[copy]).dot(normal) < 0.9999f) ++copy;
      if (copy == result.vertices.size()) {
        result.vertices.push_back(surface.vertices[v]);
        result.normals.push_back({normal.x(), normal.y(), normal.z()});
      }
      result.triangles[corner.triangle][corner.index] = static_cast<std::uint32_t>(copy);
    }
  }
  return result;
}

}  // namespace innersphere::demo
