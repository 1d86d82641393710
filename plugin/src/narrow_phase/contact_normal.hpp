// Finds the direction of contact between two surfaces that were probed.
#pragma once

#include <optional>
#include <vector>

#include "narrow_phase/surface_probe.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Returns true if the surfaces lie on each other: their normals differ by less than 20 degrees.
bool opposed(const OpposedPoints& points);

/// Returns a first estimate from one sample alone: where a line across the contact should point.
btVector3 normalAlone(const OpposedPoints& points, const btVector3& direction);

/// Tells where faces end.
class FaceExtents {
 public:
  virtual ~FaceExtents() = default;
  struct EdgeDistances {
    btScalar a;
    btScalar b;
  };
  /// Returns how far the faces at opposed points go on in direction `towards` (unit) until they end in a
  /// sharp edge [m]. It is BT_LARGE_FLOAT where no edge is near.
  virtual EdgeDistances edgeDistances(const OpposedPoints& points, const btVector3& towards) const = 0;
};

/// Finds the direction of contact at each of the samples of a patch. Beside the deepest point both normals
/// lean away from it, each in proportion to its curvature, so the flatter surface counts for more; a flat one
/// counts alone. In a hollow both lean the same way, and that of a shape of Bullet's, which is exact, counts.
/// Of two faces that meet at an angle, that one counts which the other one's edge lies on.
class ContactNormal {
 public:
  /// Takes the samples of one patch. `extents` is null where nothing is known of B but its distance: its
  /// faces are then taken as endless. `bends` is null where it is not known how B bends along each axis: it
  /// is then taken as round.
  ContactNormal(const std::vector<ProbedSample>& samples, const FaceExtents* extents,
                const SurfaceProbe* bends = nullptr);

  /// Returns the direction at a sample: unit, from A to B.
  btVector3 at(const ProbedSample& sample) const;

 private:
  std::optional<btVector3> betweenBends(const OpposedPoints& points, bool lie) const;

  const FaceExtents* extents_;
  const SurfaceProbe* bends_;
  bool flat_a_;  ///< all of the patch is one face of A
  bool flat_b_;
  btScalar face_a_ = btScalar(0.5);  ///< weight of A's normal where two faces meet
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
