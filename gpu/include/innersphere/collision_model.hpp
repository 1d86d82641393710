// A packing made ready for queries.
#pragma once

#include <cstddef>
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
/// first use, by the first query in which the bounds of both bodies meet and where it runs, on the CPU or the
/// device, and live as long as the model: one for each prefix and estimator. All members but update() are
/// safe to call from several threads at once.
class CollisionModel {
 public:
  /// Throws Error if the packing is not valid (see validate()) or has lengths beyond 1e15 m.
  explicit CollisionModel(std::shared_ptr<const Packing> packing);
  ~CollisionModel();
  CollisionModel(const CollisionModel&) = delete;
  CollisionModel& operator=(const CollisionModel&) = delete;

  /// As it was made; update() changes nothing here.
  const Packing& packing() const;

  /// For bodies that bend or grow: gives the spheres new places and sizes, in the order and the frame of the
  /// packing. `count` must be the packing's; radii may come in any order, so a prefix is no longer made of
  /// the largest spheres. Volume-true radii grow as their spheres do, which is exact where all grow alike.
  /// Grids are built anew in their old memory by the next query that needs them, so after a first update
  /// nothing is allocated, unless the spheres fill many more cells than before. No query with this model, in
  /// any context, and no other call of update() may run at the same time.
  ///
  /// Throws Error and changes nothing: bad_argument (a null pointer, another number of spheres, a radius that
  /// is not positive, lengths beyond 1e15 m), not_finite.
  void update(const Sphere* spheres, std::size_t count);

  struct Impl;  ///< private to the backends
  Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace innersphere
