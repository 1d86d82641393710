// Decides which points of contact become manifolds.
#pragma once

#include <array>
#include <vector>

#include "common/contact_tolerances.hpp"
#include "common/pair_motion.hpp"
#include "narrow_phase/contact_point.hpp"
#include "narrow_phase/contact_samples.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Keeps room to work in from one pair to the next.
struct ReductionScratch {
  ReductionScratch();
  std::vector<WeightedPoint> all;
  std::array<std::vector<ContactPoint>, kMaxManifolds> groups;
  std::vector<btScalar> worth;
};

/// Crossing edges that have sunk into each other are apart again after the least of several ways out. Drops
/// those that are longer, and pushes along other ways, from where they have sunk in; faces stay.
void keepLeastWaysOut(btScalar spacing, ReductionScratch& scratch, std::vector<WeightedPoint>& found);

/// Drops places of faces that end before the place where they would bear what is round, and of rims beside
/// the deepest one, if something deeper is as near as `beyond_end`. They would hold it as if they went on.
void dropBeyondEnds(std::vector<WeightedPoint>& found);

/// Where curved surfaces touch, the top of a hill bears, and nothing beside it does: spheres of several
/// patches find the same hill, and see it from places of their own. Drops what lies on the hill of a top that
/// was reached, and all but one of the tops of a hill. Of swept bodies it stays, as all of it might sink in.
void keepTops(btScalar separation, const StepAhead& step, std::vector<WeightedPoint>& found);

/// Groups points by their normals, wherever they are: rigid bodies feel only the wrench, and four points
/// spread over everything that faces one way carry any load that all of them could. Each group becomes a
/// patch with up to four points: the deepest, then those that span the largest area with it. Points with ids
/// of the step before are preferred, so that the choice does not flicker; of points closer than `spacing` [m]
/// to each other one is left. Replaces `patches`, and reorders `found`.
void reduceToManifolds(std::vector<WeightedPoint>& found, const std::vector<std::uint64_t>& old_ids,
                       btScalar spacing, const StepAhead& step, ReductionScratch& scratch,
                       std::vector<ContactPatch>& patches);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
