// Solids that make packing hard: moved far away, scaled, or with many equal distances.
#pragma once

#include <memory>
#include <utility>

#include "innersphere/mesh.hpp"
#include "innersphere/solid.hpp"

namespace innersphere::benchmarks {

/// A solid scaled about the origin, then moved.
class MovedSolid : public Solid {
 public:
  MovedSolid(std::shared_ptr<const Solid> solid, double scale, const Vec3d& shift)
      : solid_(std::move(solid)), scale_(scale), shift_(shift) {}

  ClosestPoint closestPoint(const Vec3d& p, double cutoff) const override;
  bool contains(const Vec3d& p) const override { return solid_->contains(from(p)); }
  Bounds bounds() const override;
  MassProperties massProperties() const override;
  Mesh surface() const override;
  std::string name() const override { return solid_->name(); }

 private:
  Vec3d from(const Vec3d& p) const;
  Vec3d to(const Vec3d& p) const;

  std::shared_ptr<const Solid> solid_;
  double scale_;
  Vec3d shift_;
};

/// Names and closed meshes: a sphere of 32,768 triangles, a shell 1 % thick, a box with finely rounded
/// edges.
std::vector<std::pair<std::string, Mesh>> hardMeshes();

}  // namespace innersphere::benchmarks
