// Remembers what is known of a contact from the steps before.
#pragma once

#include <vector>

#include <LinearMath/btTransform.h>

#include "innersphere/packing_shape.hpp"
#include "narrow_phase/contact_point.hpp"
#include "narrow_phase/sample_selection.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Says where the two bodies of a pair are: it has the frames of their shapes.
struct Placed {
  btTransform a;
  btTransform b;
  bool operator==(const Placed& other) const { return a == other.a && b == other.b; }
};

/// In units of the spacing: samples are good for bodies that have moved by less than this since a search. So
/// searches look so much further than they need to.
constexpr btScalar kSearchAgain = btScalar(0.5);
/// In units of the spacing: contacts are moved along with bodies that have moved by less than this since
/// depths were evaluated. The error is of second order: on a ball of five spacings a hundredth of this.
constexpr btScalar kRefineAgain = btScalar(0.1);
/// The same for bodies that are enclosed. They touch now here and now there within their clearance, so that
/// other spheres are the ones to measure sooner, and other samples the deepest.
constexpr btScalar kSearchEnclosedAgain = btScalar(0.1);
constexpr btScalar kRefineEnclosedAgain = btScalar(0.01);
/// In units of the spacing: where surfaces are so flat together that a contact would roll on further than
/// this, it stays. That is a sixteenth of a body's size, on which they bend about alike.
constexpr btScalar kRollsOn = 3;

/// Returns an upper bound for how far a place on one body moves, as seen from the other, where both reach:
/// within the smaller one [m].
btScalar motionBetween(const Placed& before, const Placed& now, btScalar size_a, btScalar size_b);

/// Carries contacts along. While bodies do not move much against each other, the spheres that were found in
/// contact are good for being measured again, and while they hardly move, the contacts themselves are, if
/// they go along.
class ContactTransport {
 public:
  bool isEmpty() const { return samples.indices.empty(); }
  const Placed& searchedAt() const { return searched_at_; }
  const Placed& measuredAt() const { return measured_at_; }
  /// Returns true for a nut on its thread, a peg, teeth that mesh: bodies that rattle in their clearance
  /// touch now here and now there, so that contact is searched for again sooner.
  bool isEnclosed() const { return enclosed_; }
  /// Returns the narrowest gap when depths were evaluated [m]; it is negative where the bodies overlap.
  btScalar gap() const { return gap_; }

  /// Notes that samples have been found anew. Gives memory back if there are none.
  void noteSearch(const Placed& now);
  /// Turns the samples along, to be measured again.
  void turnTo(const Placed& now);
  /// Notes that patches have been measured, with all contacts up to `found` [m] apart.
  void noteDepths(const Placed& now, btScalar found);
  /// Forgets all patches.
  void drop() {
    patches.clear();
    measured_.clear();
  }
  /// Moves the patches along: each contact has a point that moves with A and one that moves with B, and rolls
  /// on where surfaces are curved. A's is the packing that positions are relative to the origin of.
  void carryTo(const Placed& now, const PackingShape& a, btScalar spacing);

  Samples samples;
  std::vector<ContactPatch> patches;

 private:
  Placed searched_at_;
  bool enclosed_ = false;
  Placed measured_at_;
  btScalar gap_ = 0;
  std::vector<ContactPatch> measured_;
};

/// Gives back the memory of a list that is empty.
template <typename T>
void releaseIfEmpty(std::vector<T>& list) {
  if (list.empty()) list.shrink_to_fit();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
