// Solids with closed forms, written for the tests alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "innersphere/solid.hpp"

namespace innersphere::test {

/// Shares what the packer does not look into. `size` scales and `place` moves the solid.
class AnalyticSolid : public Solid {
 public:
  AnalyticSolid(double size, const Vec3d& place) : size_(size), place_(place) {}

  ClosestPoint closestPoint(const Vec3d& p, double cutoff) const final {
    const Vec3d q = nearest(local(p));
    const Vec3d at{place_[0] + size_ * q[0], place_[1] + size_ * q[1], place_[2] + size_ * q[2]};
    const double distance = std::hypot(p[0] - at[0], p[1] - at[1], p[2] - at[2]);
    if (distance > cutoff) return {std::numeric_limits<double>::infinity(), {}};
    return {distance, at};
  }
  bool contains(const Vec3d& p) const final { return inside(local(p)); }
  Bounds bounds() const final {
    const Vec3d h = halfSize();
    Bounds box;
    for (int k = 0; k < 3; ++k) {
      box.min[k] = place_[k] - size_ * h[k];
      box.max[k] = place_[k] + size_ * h[k];
    }
    return box;
  }
  MassProperties massProperties() const final {
    MassProperties mass;
    mass.volume = unitVolume() * size_ * size_ * size_;
    mass.centre_of_mass = place_;
    return mass;
  }
  Mesh surface() const override { return {}; }

 protected:
  virtual Vec3d nearest(const Vec3d& p) const = 0;
  virtual bool inside(const Vec3d& p) const = 0;
  virtual Vec3d halfSize() const = 0;
  virtual double unitVolume() const = 0;

 private:
  Vec3d local(const Vec3d& p) const {
    return {(p[0] - place_[0]) / size_, (p[1] - place_[1]) / size_, (p[2] - place_[2]) / size_};
  }

  double size_;
  Vec3d place_;
};

/// A cube of edge 1.
class Cube : public AnalyticSolid {
 public:
  explicit Cube(double size = 1, const Vec3d& place = {}) : AnalyticSolid(size, place) {}
  std::string name() const override { return "test cube"; }
  Mesh surface() const override {
    const Bounds b = bounds();
    Mesh s;
    for (int i = 0; i < 8; ++i) {
      s.vertices.push_back(
          {i & 1 ? b.max[0] : b.min[0], i & 2 ? b.max[1] : b.min[1], i & 4 ? b.max[2] : b.min[2]});
    }
    s.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return s;
  }

 protected:
  Vec3d nearest(const Vec3d& p) const override {
    Vec3d q = p;
    for (double& x : q) x = std::clamp(x, -0.5, 0.5);
    if (q != p) return q;
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
      if (std::abs(p[k]) > std::abs(p[axis])) axis = k;
    }
    q[axis] = p[axis] < 0 ? -0.5 : 0.5;
    return q;
  }
  bool inside(const Vec3d& p) const override {
    return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])}) < 0.5;
  }
  Vec3d halfSize() const override { return {0.5, 0.5, 0.5}; }
  double unitVolume() const override { return 1; }
};

/// A ball of radius 1.
class TestBall : public AnalyticSolid {
 public:
  explicit TestBall(double size = 1, const Vec3d& place = {}) : AnalyticSolid(size, place) {}
  std::string name() const override { return "test ball"; }

 protected:
  Vec3d nearest(const Vec3d& p) const override {
    const double length = std::hypot(p[0], p[1], p[2]);
    if (length == 0) return {1, 0, 0};
    return {p[0] / length, p[1] / length, p[2] / length};
  }
  bool inside(const Vec3d& p) const override { return std::hypot(p[0], p[1], p[2]) < 1; }
  Vec3d halfSize() const override { return {1, 1, 1}; }
  double unitVolume() const override { return 4.0 / 3.0 * std::numbers::pi; }
};

/// A torus about the z axis with ring radius 1 and tube radius 0.4.
class TestTorus : public AnalyticSolid {
 public:
  explicit TestTorus(double size = 1, const Vec3d& place = {}) : AnalyticSolid(size, place) {}
  std::string name() const override { return "test torus"; }

 protected:
  static constexpr double kTube = 0.4;
  Vec3d nearest(const Vec3d& p) const override {
    const double ring = std::hypot(p[0], p[1]);
    const double cosine = ring > 0 ? p[0] / ring : 1, sine = ring > 0 ? p[1] / ring : 0;
    const double length = std::hypot(ring - 1, p[2]);
    const double out = length > 0 ? (ring - 1) / length : 1, up = length > 0 ? p[2] / length : 0;
    return {(1 + kTube * out) * cosine, (1 + kTube * out) * sine, kTube * up};
  }
  bool inside(const Vec3d& p) const override { return std::hypot(std::hypot(p[0], p[1]) - 1, p[2]) < kTube; }
  Vec3d halfSize() const override { return {1 + kTube, 1 + kTube, kTube}; }
  double unitVolume() const override { return 2 * std::numbers::pi * std::numbers::pi * kTube * kTube; }
};

/// The cube of edge 1 without a ball of radius 0.4 about one of its corners.
class BittenCube : public AnalyticSolid {
 public:
  explicit BittenCube(double size = 1, const Vec3d& place = {}) : AnalyticSolid(size, place) {}
  std::string name() const override { return "test bitten cube"; }

 protected:
  static constexpr double kBite = 0.4;
  static Vec3d fromCorner(const Vec3d& p) { return {p[0] - 0.5, p[1] - 0.5, p[2] - 0.5}; }
  static double norm(const Vec3d& v) { return std::hypot(v[0], v[1], v[2]); }

  // Exact from inside; from outside the nearest of either surface, a lower bound.
  Vec3d nearest(const Vec3d& p) const override {
    Vec3d wall = p;
    int axis = 0;
    double least = 1e30;
    for (int k = 0; k < 3; ++k) {
      const double away = std::abs(0.5 - std::abs(p[k]));
      if (away < least) {
        least = away;
        axis = k;
      }
    }
    wall[axis] = p[axis] < 0 ? -0.5 : 0.5;
    const Vec3d v = fromCorner(p);
    const double length = norm(v);
    if (length == 0) return {0.5 - kBite, 0.5, 0.5};
    if (std::abs(length - kBite) > least) return wall;
    return {0.5 + v[0] / length * kBite, 0.5 + v[1] / length * kBite, 0.5 + v[2] / length * kBite};
  }
  bool inside(const Vec3d& p) const override {
    return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])}) < 0.5 && norm(fromCorner(p)) > kBite;
  }
  Vec3d halfSize() const override { return {0.5, 0.5, 0.5}; }
  double unitVolume() const override { return 1 - std::numbers::pi / 6 * kBite * kBite * kBite; }
};

}  // namespace innersphere::test
