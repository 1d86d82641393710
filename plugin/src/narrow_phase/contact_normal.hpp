// The direction of contact between two measured surfaces.
#pragma once

#include <vector>

#include "narrow_phase/surface_probe.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A contact of a sphere, measured on the surfaces.
struct ProbedSample {
  OpposedPoints gap;
  btVector3 direction{0, 0, 0};  ///< of the line, unit, from A to B
  std::size_t index = 0;         ///< of the contact
  std::uint64_t id = 0;          ///< of the sphere
  bool starts_climb = false;     ///< to the top of a hill, see climb
};

/// The surfaces lie on each other: their normals differ by less than 20 degrees.
bool opposed(const OpposedPoints& gap);

/// A first estimate from one measurement alone: where a line across the contact should point.
btVector3 normalAlone(const OpposedPoints& gap, const btVector3& direction);

/// The direction of contact at each of the measurements of a patch. Beside the deepest point both normals
/// lean away from it, each in proportion to its curvature, so the flatter surface counts for more; a flat one
/// counts alone. Of two faces that meet at an angle, that one counts which the other one's edge lies on.
class ContactNormal {
 public:
  ContactNormal(const std::vector<ProbedSample>& measured, const SurfaceProbe& probe);

  btVector3 at(const ProbedSample& measured) const;

 private:
  const SurfaceProbe* probe_;
  bool flat_a_;  ///< all of the patch is one face of A
  bool flat_b_;
  btScalar face_a_ = btScalar(0.5);  ///< weight of A's normal where two faces meet
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
