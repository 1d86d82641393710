// How bodies move against each other, and how contacts go with them.
#pragma once

#include <vector>

#include <LinearMath/btTransform.h>

#include "contact_patch.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Where the two bodies of a pair are.
struct Placed {
  btTransform a;
  btTransform b;
};

/// An upper bound for how far a place on one body moves, as seen from the other, where both reach: no point
/// of A is further than `size_a` [m] from its origin, nor of B than `size_b`.
btScalar motionBetween(const Placed& before, const Placed& now, btScalar size_a, btScalar size_b);

/// Contacts measured at `then`, as they are at `now` if the bodies have hardly moved against each other: each
/// has a point that moves with A and one that moves with B. The origins are those of A's packing, which
/// positions are relative to.
void carry(const std::vector<ContactPatch>& measured, const Placed& then, const btVector3& origin_then,
           const Placed& now, const btVector3& origin_now, std::vector<ContactPatch>& patches);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
