#include "polyhedron.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace innersphere::test {
namespace {

using Vector = Polyhedron::Vector;

constexpr double kFar = 1e9;        // [m]
constexpr double kRounding = 1e-9;  // [m]

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// a + s b
Vector plus(const Vector& a, const Vector& b, double s) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}

Vector minus(const Vector& a, const Vector& b) {
  return plus(a, b, -1);
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector times(const Vector& a, double s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}

}  // namespace

Polyhedron::Polyhedron(std::vector<Vector> corners) : corners_(std::move(corners)) {
  const int count = static_cast<int>(corners_.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      for (int k = j + 1; k < count; ++k) addIfOutermost(i, j, k);
    }
  }
}

void Polyhedron::addIfOutermost(int i, int j, int k) {
  Vector normal = cross(minus(corners_[j], corners_[i]), minus(corners_[k], corners_[i]));
  normal = times(normal, 1 / std::sqrt(dot(normal, normal)));
  double low = 0, high = 0;
  for (const Vector& c : corners_) {
    const double height = dot(minus(c, corners_[i]), normal);
    low = std::min(low, height);
    high = std::max(high, height);
    if (low < -kRounding && high > kRounding) return;
  }
  if (high > kRounding) {
    std::swap(j, k);
    normal = times(normal, -1);
  }
  faces_.push_back({{i, j, k}, normal, dot(normal, corners_[i])});
}

Polyhedron::Near Polyhedron::near(const Vector& p) const {
  Near inside{-kFar, {}}, outside{kFar, {}};
  for (const Face& face : faces_) {
    const double height = dot(p, face.normal) - face.offset;
    if (height > inside.distance) inside = {height, face.normal};
    // The nearest place lies on a face that is seen from p, which is at least that far away.
    if (height < 0 || height > outside.distance) continue;
    const Vector way = minus(p, nearestOf(p, face, height));
    const double distance = std::sqrt(dot(way, way));
    if (distance < outside.distance) outside = {distance, times(way, 1 / distance)};
  }
  return inside.distance < 0 ? inside : outside;
}

Vector Polyhedron::nearestOf(const Vector& p, const Face& face, double height) const {
  Vector nearest = plus(p, face.normal, -height);
  double least = kFar;
  for (int e = 0; e < 3; ++e) {
    const Vector &a = corners_[face.corners[e]], &b = corners_[face.corners[(e + 1) % 3]];
    const Vector way = minus(b, a), from_a = minus(p, a);
    if (!(dot(cross(way, from_a), face.normal) < 0)) continue;
    const Vector q = plus(a, way, std::clamp(dot(from_a, way) / dot(way, way), 0.0, 1.0));
    const Vector off = minus(p, q);
    if (dot(off, off) < least) {
      least = dot(off, off);
      nearest = q;
    }
  }
  return nearest;
}

}  // namespace innersphere::test
