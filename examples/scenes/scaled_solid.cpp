#include "scaled_solid.hpp"

#include <cmath>

namespace innersphere::demo {
namespace {

class ScaledSolid : public Solid {
 public:
  ScaledSolid(std::shared_ptr<const Solid> solid, double scale) : solid_(std::move(solid)), scale_(scale) {}

  ClosestPoint closestPoint(const Vec3d& p, double cutoff) const override {
    const ClosestPoint closest = solid_->closestPoint(times(p, 1 / scale_), cutoff / scale_);
    return {closest.distance * scale_, times(closest.point, scale_)};
  }
  bool contains(const Vec3d& p) const override { return solid_->contains(times(p, 1 / scale_)); }
  Bounds bounds() const override {
    const Bounds b = solid_->bounds();
    return {times(b.min, scale_), times(b.max, scale_)};
  }
  MassProperties massProperties() const override {
    MassProperties m = solid_->massProperties();
    m.volume *= std::pow(scale_, 3);
    m.centre_of_mass = times(m.centre_of_mass, scale_);
    for (double& element : m.inertia) element *= std::pow(scale_, 5);
    return m;
  }
  Mesh surface() const override {
    Mesh s = solid_->surface();
    for (Vec3d& vertex : s.vertices) vertex = times(vertex, scale_);
    return s;
  }
  std::string name() const override { return solid_->name(); }
  std::string hash() const override { return solid_->hash(); }

 private:
  static Vec3d times(const Vec3d& v, double s) { return {v[0] * s, v[1] * s, v[2] * s}; }

  std::shared_ptr<const Solid> solid_;
  double scale_;
};

}  // namespace

std::shared_ptr<const Solid> scaledSolid(std::shared_ptr<const Solid> solid, double scale) {
  if (scale == 1) return solid;
  return std::make_shared<ScaledSolid>(std::move(solid), scale);
}

double diagonalOf(const Bounds& b) {
  return std::hypot(b.max[0] - b.min[0], b.max[1] - b.min[1], b.max[2] - b.min[2]);
}

std::shared_ptr<const Solid> withDiagonal(std::shared_ptr<const Solid> solid, double diagonal) {
  const double scale = diagonal / diagonalOf(solid->bounds());
  return scaledSolid(std::move(solid), scale);
}

}  // namespace innersphere::demo
