// The grids of a model: one for each prefix and set of radii that was asked for.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "hash_grid.hpp"
#include "innersphere/collision_model.hpp"

namespace innersphere {

struct CollisionModel::Impl {
  explicit Impl(std::shared_ptr<const Packing> packing);

  /// The grid for the first `prefix` spheres (0: all). Built on the first call; later ones return the same.
  /// Safe to call from several threads at once.
  const HashGrid& grid(std::uint32_t prefix, Estimator estimator);

  std::shared_ptr<const Packing> packing;

 private:
  using Key = std::pair<std::uint32_t, const VolumeTrueRadii*>;
  struct Entry {
    std::once_flag built;
    std::unique_ptr<const HashGrid> grid;
  };
  std::mutex mutex_;
  std::map<Key, Entry> grids_;
};

}  // namespace innersphere
