// The grids of a model: one for each prefix, set of radii and growth that was asked for.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>

#include "hash_grid.hpp"
#include "innersphere/collision_model.hpp"

namespace innersphere {

struct CollisionModel::Impl {
  explicit Impl(std::shared_ptr<const Packing> packing);

  /// The grid for the first `prefix` spheres (0: all), to be queried with margins up to `margin` (in the
  /// packing's lengths). Built on the first call; later ones return the same. Safe to call from several
  /// threads at once.
  const HashGrid& grid(std::uint32_t prefix, Estimator estimator, double margin);

  std::shared_ptr<const Packing> packing;

 private:
  using Key = std::tuple<std::uint32_t, const VolumeTrueRadii*, float>;
  struct Entry {
    std::once_flag built;
    std::unique_ptr<const HashGrid> grid;
  };
  std::mutex mutex_;
  std::map<Key, Entry> grids_;
};

}  // namespace innersphere
