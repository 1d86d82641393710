// A packing made ready for queries.
#pragma once

#include <cstdint>
#include <memory>

#include "innersphere/packing.hpp"

namespace innersphere {

/// Which radii a query uses.
enum class Estimator {
  raw,  ///< the packing's own spheres, as in the paper: the gaps between them count as empty (25 to 70 % low)
  volume_true  ///< radii whose volumes sum to the solid's: right in the mean. Falls back to raw where none
               ///< are stored
};

/// A packing with its hierarchical hash grids. Bodies of the same shape share one model. Grids are built on
/// first use, on the device only when a query runs there, and live as long as the model: one for each prefix
/// and estimator. All members are safe to call from several threads at once.
class CollisionModel {
 public:
  /// Throws Error if the packing is not valid (see validate()) or has lengths beyond 1e15 m.
  explicit CollisionModel(std::shared_ptr<const Packing> packing);
  ~CollisionModel();
  CollisionModel(const CollisionModel&) = delete;
  CollisionModel& operator=(const CollisionModel&) = delete;

  const Packing& packing() const;

  struct Impl;  ///< private to the backends
  Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace innersphere
