// Solids made of other things than triangles: a user's distance function, and the difference of two solids.
#include <utility>

#include "common/bounds.hpp"
#include "common/hash.hpp"
#include "innersphere/error.hpp"
#include "innersphere/solids.hpp"
#include "solids/sampled_solid.hpp"

namespace innersphere {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kDifferenceResolution = 128;

// A finer surface than half the resolution costs more memory than it helps drawing.
int surfaceResolution(int resolution) {
  return std::max(1, resolution / 2);
}

double signedDistance(const Solid& solid, const Vec3d& p, double cutoff) {
  const double distance = std::min(cutoff, solid.closestPoint(p, cutoff).distance);
  return solid.contains(p) ? -distance : distance;
}

class DistanceSolid : public Solid {
 public:
  DistanceSolid(std::string name, std::function<double(const Vec3d&)> signed_distance, const Bounds& bounds,
                int resolution)
      : name_(std::move(name)),
        signed_distance_(std::move(signed_distance)),
        bounds_(bounds),
        resolution_(resolution),
        mass_(sampledMass(field(), bounds, resolution)) {
    if (mass_.volume > 0) return;
    throw Error(
        ErrorCode::not_a_solid,
        name_ + " has no inside: its distance is nowhere negative in the given bounds; check its sign");
  }

  ClosestPoint closestPoint(const Vec3d& p, double cutoff) const override {
    const double d = signed_distance_(p);
    if (!(std::abs(d) <= cutoff)) return {kInfinity, {}};
    const Vec3d q = towardsSurface(p, d);
    return {std::abs(d), towardsSurface(q, signed_distance_(q))};
  }
  bool contains(const Vec3d& p) const override { return signed_distance_(p) < 0; }
  Bounds bounds() const override { return bounds_; }
  MassProperties massProperties() const override { return mass_; }
  Mesh surface() const override { return sampledSurface(field(), bounds_, surfaceResolution(resolution_)); }
  std::string name() const override { return name_; }

 private:
  SignedDistance field() const {
    return [this](const Vec3d& p, double) { return signed_distance_(p); };
  }

  // From p against the gradient, by central differences, as far as the distance says.
  Vec3d towardsSurface(const Vec3d& p, double d) const {
    const double step = 1e-6 * diagonal(bounds_);
    Vec3d gradient;
    for (int k = 0; k < 3; ++k) {
      Vec3d ahead = p, behind = p;
      ahead[k] += step;
      behind[k] -= step;
      gradient[k] = signed_distance_(ahead) - signed_distance_(behind);
    }
    const double n = norm(gradient);
    return n > 0 ? p - (d / n) * gradient : p;
  }

  std::string name_;
  std::function<double(const Vec3d&)> signed_distance_;
  Bounds bounds_;
  int resolution_;
  MassProperties mass_;
};

class Difference : public Solid {
 public:
  Difference(std::shared_ptr<const Solid> a, std::shared_ptr<const Solid> b)
      : a_(std::move(a)), b_(std::move(b)), mass_(sampledMass(field(), a_->bounds(), kDifferenceResolution)) {
    if (mass_.volume > 0) return;
    throw Error(ErrorCode::not_a_solid,
                name() + " is empty: nothing of the first solid is outside of the second");
  }

  ClosestPoint closestPoint(const Vec3d& p, double cutoff) const override {
    const ClosestPoint to_a = a_->closestPoint(p, cutoff);
    const ClosestPoint to_b = b_->closestPoint(p, std::min(cutoff, to_a.distance));
    return to_b.distance < to_a.distance ? to_b : to_a;
  }
  bool contains(const Vec3d& p) const override { return a_->contains(p) && !b_->contains(p); }
  Bounds bounds() const override { return a_->bounds(); }
  MassProperties massProperties() const override { return mass_; }
  Mesh surface() const override {
    return sampledSurface(field(), bounds(), surfaceResolution(kDifferenceResolution));
  }
  std::string name() const override { return a_->name() + " minus " + b_->name(); }
  std::string hash() const override {
    const std::string a = a_->hash(), b = b_->hash();
    if (a.empty() || b.empty()) return {};
    Hash hash;
    hash.add(a + " minus " + b);
    return hash.text();
  }

 private:
  // Not just the nearer of the two with a sign: outside of `a` the surface of `b` bounds nothing.
  SignedDistance field() const {
    return [this](const Vec3d& p, double cutoff) {
      return std::max(signedDistance(*a_, p, cutoff), -signedDistance(*b_, p, cutoff));
    };
  }

  std::shared_ptr<const Solid> a_, b_;
  MassProperties mass_;
};

}  // namespace

std::unique_ptr<Solid> makeDistanceSolid(const std::string& name,
                                         std::function<double(const Vec3d&)> signed_distance,
                                         const Bounds& bounds, int resolution) {
  for (int k = 0; k < 3; ++k) {
    if (!(bounds.min[k] < bounds.max[k]) || !std::isfinite(bounds.max[k] - bounds.min[k])) {
      throw Error(ErrorCode::bad_argument,
                  "the bounds of " + name + " are empty or not finite along axis " + "xyz"[k]);
    }
  }
  if (resolution < 1 || resolution > 1024) {
    throw Error(ErrorCode::bad_argument, "the resolution of " + name + " has to be from 1 to 1024 cells");
  }
  if (!signed_distance) throw Error(ErrorCode::bad_argument, name + " has no distance function");
  return std::make_unique<DistanceSolid>(name, std::move(signed_distance), bounds, resolution);
}

std::unique_ptr<Solid> makeDifference(std::shared_ptr<const Solid> a, std::shared_ptr<const Solid> b) {
  if (!a || !b) throw Error(ErrorCode::bad_argument, "a difference needs two solids; one is null");
  return std::make_unique<Difference>(std::move(a), std::move(b));
}

}  // namespace innersphere
