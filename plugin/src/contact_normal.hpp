// The direction of contact between two measured surfaces.
#pragma once

#include <vector>

#include "gauge.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A contact of a sphere, measured on the surfaces.
struct Measured {
  Gap gap;
  std::size_t index = 0;  ///< of the contact
  std::uint64_t id = 0;   ///< of the sphere
};

/// How much the normal of A counts against that of B. Beside the deepest point both lean away from the normal
/// of contact, each in proportion to its curvature, so the flatter surface counts for more; a flat one counts
/// alone.
class ContactNormal {
 public:
  /// `trust_b`: where there are too few measurements to see a curvature, B's normal is the better one.
  ContactNormal(const std::vector<Measured>& measured, bool trust_b);

  /// At a gap; `direction` is that of the overlap around.
  btVector3 at(const Gap& gap, const btVector3& direction) const;

 private:
  btScalar weight_a_;  ///< where the surfaces oppose each other
  bool flat_a_;
  bool flat_b_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
