#include "solids/analytic_solids.hpp"

#include <numbers>

#include "common/bounds.hpp"
#include "common/hash.hpp"
#include "common/steady_math.hpp"
#include "innersphere/error.hpp"
#include "innersphere/solids.hpp"
#include "solids/generators.hpp"

namespace innersphere {
namespace {

constexpr double kPi = std::numbers::pi;

void requirePositive(const char* solid, const char* what, double x) {
  if (x > 0 && std::isfinite(x)) return;
  throw Error(ErrorCode::bad_argument, std::string("the ") + what + " of a " + solid +
                                           " has to be a length over 0 m, not " + std::to_string(x));
}

MassProperties diagonalMass(double volume, const Vec3d& inertia) {
  return {volume, {}, {inertia[0], 0, 0, 0, inertia[1], 0, 0, 0, inertia[2]}};
}

// What the four have in common: a closed form for everything and a name. `half` is half the size of the
// bounding box.
class AnalyticSolid : public Solid {
 public:
  AnalyticSolid(std::string name, const Vec3d& half, const MassProperties& mass)
      : name_(std::move(name)), half_(half), mass_(mass) {}

  ClosestPoint closestPoint(const Vec3d& p, double cutoff) const override {
    const Vec3d point = nearest(p);
    const double distance = norm(p - point);
    if (!(distance <= cutoff)) return {std::numeric_limits<double>::infinity(), {}};
    return {distance, point};
  }
  Bounds bounds() const override { return {-half_, half_}; }
  MassProperties massProperties() const override { return mass_; }
  Mesh surface() const override { return mesh(); }
  std::string name() const override { return name_; }

  // The kind shows in the mass properties: no two of the four share them.
  std::string hash() const override {
    Hash hash;
    for (double x : half_) hash.add(x);
    hash.add(mass_.volume);
    for (double x : mass_.inertia) hash.add(x);
    return hash.text();
  }

 protected:
  virtual Vec3d nearest(const Vec3d& p) const = 0;
  virtual Mesh mesh() const = 0;

 private:
  std::string name_;
  Vec3d half_;
  MassProperties mass_;
};

// v scaled to `length`; any direction will do for a zero vector, so it takes `fallback`.
Vec3d withLength(const Vec3d& v, double length, const Vec3d& fallback) {
  const double n = norm(v);
  return n > 0 ? (length / n) * v : length * fallback;
}

class BallSolid : public AnalyticSolid {
 public:
  BallSolid(const std::string& name, double r) : AnalyticSolid(name, {r, r, r}, massOf(r)), radius_(r) {}
  bool contains(const Vec3d& p) const override { return norm(p) < radius_; }

 protected:
  Vec3d nearest(const Vec3d& p) const override { return withLength(p, radius_, {1, 0, 0}); }
  Mesh mesh() const override {
    constexpr int kRings = 32;
    std::vector<Ring> rings{{{0, 0, -radius_}}};
    for (int i = 1; i < kRings; ++i) {
      const double angle = kPi * i / kRings;
      rings.push_back(circle(radius_ * steady::sin(angle), -radius_ * steady::cos(angle), 2 * kRings));
    }
    rings.push_back({{0, 0, radius_}});
    return loft(rings, false);
  }

 private:
  static MassProperties massOf(double r) {
    const double volume = 4 * kPi / 3 * r * r * r;
    const double i = 0.4 * volume * r * r;
    return diagonalMass(volume, {i, i, i});
  }
  double radius_;
};

class Box : public AnalyticSolid {
 public:
  Box(const std::string& name, const Vec3d& size)
      : AnalyticSolid(name, 0.5 * size, massOf(size)), half_(0.5 * size) {}
  bool contains(const Vec3d& p) const override {
    return std::abs(p[0]) < half_[0] && std::abs(p[1]) < half_[1] && std::abs(p[2]) < half_[2];
  }

 protected:
  Vec3d nearest(const Vec3d& p) const override {
    Vec3d q;
    for (int k = 0; k < 3; ++k) q[k] = std::clamp(p[k], -half_[k], half_[k]);
    if (q != p) return q;
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
      if (half_[k] - std::abs(p[k]) < half_[axis] - std::abs(p[axis])) axis = k;
    }
    q[axis] = std::copysign(half_[axis], p[axis]);
    return q;
  }
  Mesh mesh() const override {
    const auto [x, y, z] = half_;
    const auto rectangle = [&](double height) {
      return Ring{{-x, -y, height}, {x, -y, height}, {x, y, height}, {-x, y, height}};
    };
    return loft({rectangle(-z), rectangle(z)}, false);
  }

 private:
  static MassProperties massOf(const Vec3d& s) {
    const double volume = s[0] * s[1] * s[2];
    const Vec3d square{s[0] * s[0], s[1] * s[1], s[2] * s[2]};
    return diagonalMass(
        volume, (volume / 12) * Vec3d{square[1] + square[2], square[2] + square[0], square[0] + square[1]});
  }
  Vec3d half_;
};

class Torus : public AnalyticSolid {
 public:
  Torus(const std::string& name, double ring, double tube)
      : AnalyticSolid(name, {ring + tube, ring + tube, tube}, massOf(ring, tube)), ring_(ring), tube_(tube) {}
  bool contains(const Vec3d& p) const override { return norm(p - onRing(p)) < tube_; }

 protected:
  Vec3d nearest(const Vec3d& p) const override {
    const Vec3d middle = onRing(p);
    return middle + withLength(p - middle, tube_, {0, 0, 1});
  }
  Mesh mesh() const override {
    constexpr int kAlong = 64, kAround = 32;
    std::vector<Ring> rings;
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * kPi * i / kAround;
      rings.push_back(circle(ring_ + tube_ * steady::cos(angle), tube_ * steady::sin(angle), kAlong));
    }
    return loft(rings, true);
  }

 private:
  Vec3d onRing(const Vec3d& p) const { return withLength({p[0], p[1], 0}, ring_, {1, 0, 0}); }
  static MassProperties massOf(double ring, double tube) {
    const double volume = 2 * kPi * kPi * ring * tube * tube;
    const double about_axis = volume * (ring * ring + 0.75 * tube * tube);
    const double across = volume * (0.5 * ring * ring + 0.625 * tube * tube);
    return diagonalMass(volume, {across, across, about_axis});
  }
  double ring_, tube_;
};

class Cylinder : public AnalyticSolid {
 public:
  Cylinder(const std::string& name, double r, double height)
      : AnalyticSolid(name, {r, r, height / 2}, massOf(r, height)), radius_(r), half_(height / 2) {}
  bool contains(const Vec3d& p) const override {
    return std::hypot(p[0], p[1]) < radius_ && std::abs(p[2]) < half_;
  }

 protected:
  Vec3d nearest(const Vec3d& p) const override {
    const Vec3d rim = withLength({p[0], p[1], 0}, radius_, {1, 0, 0});
    const double rho = std::hypot(p[0], p[1]);
    const double z = std::clamp(p[2], -half_, half_);
    const double to_side = radius_ - rho, to_end = half_ - std::abs(p[2]);
    if (to_side <= 0 || (to_end > 0 && to_side < to_end)) return {rim[0], rim[1], z};
    return {p[0], p[1], std::copysign(half_, p[2])};
  }
  Mesh mesh() const override {
    constexpr int kAround = 64;
    return loft({circle(radius_, -half_, kAround), circle(radius_, half_, kAround)}, false);
  }

 private:
  static MassProperties massOf(double r, double height) {
    const double volume = kPi * r * r * height;
    const double across = volume * (3 * r * r + height * height) / 12;
    return diagonalMass(volume, {across, across, volume * r * r / 2});
  }
  double radius_, half_;
};

}  // namespace

std::unique_ptr<Solid> ballSolid(const std::string& name, double radius) {
  requirePositive("ball", "radius", radius);
  return std::make_unique<BallSolid>(name, radius);
}

std::unique_ptr<Solid> boxSolid(const std::string& name, const Vec3d& size) {
  for (double x : size) requirePositive("box", "edge", x);
  return std::make_unique<Box>(name, size);
}

std::unique_ptr<Solid> torusSolid(const std::string& name, double ring_radius, double tube_radius) {
  requirePositive("torus", "tube radius", tube_radius);
  requirePositive("torus", "ring radius less its tube radius", ring_radius - tube_radius);
  return std::make_unique<Torus>(name, ring_radius, tube_radius);
}

std::unique_ptr<Solid> cylinderSolid(const std::string& name, double radius, double height) {
  requirePositive("cylinder", "radius", radius);
  requirePositive("cylinder", "height", height);
  return std::make_unique<Cylinder>(name, radius, height);
}

}  // namespace innersphere
