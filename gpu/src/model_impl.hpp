// The grids of a model: one for each prefix and set of radii that was asked for.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "hash_grid.hpp"
#include "innersphere/collision_model.hpp"

namespace innersphere {

struct CollisionModel::Impl {
  explicit Impl(std::shared_ptr<const Packing> packing);

  /// The grid for the first `prefix` spheres (0: all). Built on the first call, and on the first one after an
  /// update(), in place. Safe to call from several threads at once.
  const HashGrid& grid(std::uint32_t prefix, Estimator estimator);

  /// See CollisionModel::update().
  void update(const Sphere* spheres, std::size_t count);

  std::shared_ptr<const Packing> packing;

 private:
  using Key = std::pair<std::uint32_t, const VolumeTrueRadii*>;
  struct Entry {
    std::mutex mutex;
    std::atomic<std::uint64_t> version{0};  ///< of the spheres in the grid; 0: it is not built yet
    HashGrid grid;
  };

  void build(Entry& entry, std::size_t count, const VolumeTrueRadii* radii);
  float radiusOf(std::size_t sphere, const VolumeTrueRadii& radii) const;

  std::mutex mutex_;
  std::map<Key, Entry> grids_;
  std::uint64_t version_ = 1;  ///< of the spheres
  std::vector<Sphere> moved_;  ///< those of the last update; empty: those of the packing

  /// Kept from update to update.
  struct Scratch {
    std::mutex mutex;
    GridScratch grid;
    std::vector<Sphere> spheres;
  };
  Scratch scratch_;
};

}  // namespace innersphere
