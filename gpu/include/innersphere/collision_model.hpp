// Declares a packing that is ready for queries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "innersphere/packing.hpp"

namespace innersphere {

/// Says what stands for the solids in a query.
enum class Estimator {
  raw,  ///< The packing's own radii. The gaps between spheres count as empty: volumes are 25 to 70 % low.
  /// Radii whose volumes sum to the solid's, right in the mean. Raw radii where none are stored.
  volume_true,
  /// The triangles that both packings carry, which must be closed: volume, centroid and area are exact for
  /// these, however thin the solids and however small the overlap. What shells of one surface enclose twice
  /// counts twice; expectedError() is then NaN. The law of force is another one than with
  /// spheres: energy is the volume, force is area, torque is minus the gradient of the volume by a rotation
  /// about the origin of B, and stiffness is the area of B's surface in A. pair_count are pairs of triangles
  /// that meet: none where one solid is wholly inside the other. Spheres (volume-true ones) give Want::touch,
  /// contacts and pairs, which may be missing where an overlap is smaller than they are. It costs 1 to 3
  /// times as much as volume_true with 4,000 spheres where less than 1 % of a solid overlaps, 1 to 11 times
  /// where more does (with AVX-512, which sums spheres faster, up to twice that), and grows with the length
  /// of the line in which both surfaces meet. The CPU works on the triangles, also where the spheres are on a
  /// device; each thread keeps memory for the largest surface that it was asked for. Swapping A and B negates
  /// force and area to rounding only.
  surface
};

/// Holds a packing with its hierarchical hash grids, one for each prefix and estimator in use. Bodies of the
/// same shape share one model. A grid is built by the first query that needs it, on the CPU or the device
/// where the query runs, and lives as long as the model. All members but update() are safe to call from
/// several threads at once.
class CollisionModel {
 public:
  /// Makes a model of a packing, which it shares. Throws Error: bad_argument for a null pointer, 2^29 spheres
  /// or more, or lengths beyond 1e15 m, and what validate() throws.
  explicit CollisionModel(std::shared_ptr<const Packing> packing);
  ~CollisionModel();
  CollisionModel(const CollisionModel&) = delete;
  CollisionModel& operator=(const CollisionModel&) = delete;

  /// Returns the packing as it was made. update() does not change it.
  const Packing& packing() const;

  /// Gives the spheres new places and sizes, for bodies that bend or grow. Spheres come in the order and the
  /// frame of the packing, and `count` must be the packing's. Radii need not fall, so a prefix need not hold
  /// the largest spheres. Volume-true radii grow as their spheres do, which is exact where all grow alike.
  /// The next query that needs a grid builds it anew in its old memory. After a first update nothing is
  /// allocated, unless the spheres fill many more cells than before. No query with this model, in any
  /// context, and no other call of update() may run at the same time.
  ///
  /// Throws Error and changes nothing: bad_argument (a null pointer, another number of spheres, a radius that
  /// is not positive, lengths beyond 1e15 m), not_finite.
  void update(const Sphere* spheres, std::size_t count);

  struct Impl;  ///< This is private to the backends.
  Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace innersphere
