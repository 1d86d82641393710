// Finds the contacts of a patch on the solids' surfaces.
#pragma once

#include <vector>

#include "narrow_phase/contact_point.hpp"
#include "narrow_phase/deepest_points.hpp"
#include "narrow_phase/packing_probe.hpp"
#include "narrow_phase/sample_selection.hpp"
#include "narrow_phase/shape_probe.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// This is a point of contact, with the part of a patch of spheres that it stands for.
struct WeightedPoint {
  /// Says what it lies between.
  enum class Kind {
    faces,
    edge,      ///< and a face, somewhere along it
    corner,    ///< of the one, over a face of the other, where the one reaches furthest
    crossing,  ///< of two edges
    line,      ///< a face and an edge seen askew: the normal is only the line that was probed
  };
  ContactPoint point;
  Kind kind = Kind::faces;
  btScalar area = 0;          ///< its share [m^2]
  btVector3 centre{0, 0, 0};  ///< of the patch
  btScalar radius = 0;        ///< mean distance of the patch's area from there [m]
  bool is_top = false;        ///< see ProbedSample
  bool bends = false;         ///< between curved surfaces
  bool both_bend = false;     ///< neither of them is flat
  btScalar beyond_end = 0;    ///< what is deeper, and no further away than this, bears instead [m]
  btVector3 slope{0, 0, 0};   ///< B's normal less A's
  btVector3 moved{0, 0, 0};   ///< the point on B, from where that was measured
  btVector3 across{0, 0, 0};  ///< how far A's point is beside B's, across the normal
};

/// Keeps room to work in from one patch to the next.
struct SampleScratch {
  SampleScratch();
  struct Tried {
    ProbedSample sample;
    bool found;
  };
  std::vector<Tried> tried;          ///< all samples of a patch
  std::vector<ProbedSample> probed;  ///< those whose lines met both surfaces, then the deepest points
  std::vector<std::size_t> places;   ///< of the former, among the samples
  std::vector<Top> tops;             ///< of the step before: first those of the patch
  std::vector<LineStarts::Start> line_starts;
  std::vector<ProbedSample> sideways;   ///< those whose line leaves A by its side
  std::vector<EdgeContact> corners;     ///< at one sample
  std::vector<EdgeContact> peaks;       ///< the same for corners that neither face lies flat at
  FaceOverlaps overlaps;                ///< of the patch, as far as known
  std::vector<std::uint32_t> vertices;  ///< see EdgeProbe
};

/// Says which places of two surfaces are contacts.
struct ContactReach {
  btScalar separation = 0;  ///< no further apart than that [m]
  btVector3 turn{0, 0, 0};  ///< of A as seen from B in the step [rad]: what it brings nearer counts, too
};

/// Appends those contacts of the samples' patch `p` that are on, or near, both surfaces. `tops` are those of
/// ascendAgain(). Leaves the lines that were probed in the samples.
void findContactPoints(const PackingProbe& probe, std::size_t p, const ContactReach& reach,
                       const std::vector<Top>& tops, Samples& samples, SampleScratch& scratch,
                       std::vector<WeightedPoint>& found);
void findContactPoints(const ShapeProbe& probe, std::size_t p, const ContactReach& reach,
                       const std::vector<Top>& tops, Samples& samples, SampleScratch& scratch,
                       std::vector<WeightedPoint>& found);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
