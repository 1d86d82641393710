// Holds the grids of a model: one for each prefix and set of radii that was asked for.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "grid/model_grid.hpp"
#include "innersphere/collision_model.hpp"
#include "surface/surface_tree.hpp"

namespace innersphere {

/// Returns a number that no spheres of any model had so far, from 1 on.
std::uint64_t newVersion();

struct CollisionModel::Impl : GridSource {
  explicit Impl(std::shared_ptr<const Packing> packing);

  /// Returns the grid for the first `prefix` spheres (0: all). Safe to call from several threads at once.
  const ModelGrid& grid(std::uint32_t prefix, Estimator estimator);

  /// Returns the tree of the packing's triangles, which the first call builds. Safe to call from several
  /// threads at once. Throws Error: what SurfaceTree throws, and bad_argument after update().
  const SurfaceTree& surface();

  /// Tells whether the packing's triangles enclose as much as the solid has, to 1e-3: they do not where they
  /// enclose parts of it twice or are chords of a curve. The first call adds them up. Safe to call from
  /// several threads at once.
  bool surfaceHasVolumeOfSolid();

  /// Does what CollisionModel::update() says.
  void update(const Sphere* spheres, std::size_t count);

  std::uint64_t version() const override { return version_; }
  void withSpheres(std::size_t count, const VolumeTrueRadii* radii, const Use& use) override;
  double volume(const VolumeTrueRadii* radii) const override;

  std::shared_ptr<const Packing> packing;

 private:
  using Key = std::pair<std::uint32_t, const VolumeTrueRadii*>;

  float radiusOf(std::size_t sphere, const VolumeTrueRadii& radii) const;
  void setUsualRadii();
  void checkEach(const Sphere* spheres, std::size_t count) const;

  struct Radii {
    float least, most;  ///< [m]
  };
  Radii usual_radii_{};  ///< of moved spheres, that need no closer look

  std::mutex mutex_;
  std::map<Key, ModelGrid> grids_;
  std::optional<SurfaceTree> surface_;
  std::optional<bool> surface_has_volume_of_solid_;
  std::uint64_t version_ = newVersion();  ///< of the spheres
  std::vector<Sphere> moved_;             ///< those of the last update; empty: those of the packing

  /// Holds memory that is kept from update to update.
  struct Scratch {
    std::mutex mutex;
    GridScratch grid;
    std::vector<Sphere> spheres;
  };
  Scratch scratch_;
};

}  // namespace innersphere
