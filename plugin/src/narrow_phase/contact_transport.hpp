// What is known of a contact from the steps before.
#pragma once

#include <vector>

#include <LinearMath/btTransform.h>

#include "common/parallel.hpp"
#include "innersphere/packing_shape.hpp"
#include "narrow_phase/contact_point.hpp"
#include "narrow_phase/sample_selection.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Where the two bodies of a pair are: the frames of their shapes.
struct Placed {
  btTransform a;
  btTransform b;
  bool operator==(const Placed& other) const { return a == other.a && b == other.b; }
};

/// While bodies do not move much against each other, the spheres that were found in contact are good for
/// being measured again, and while they hardly move, the contacts themselves are, if they go along.
class ContactTransport {
 public:
  enum class Age {
    current,  ///< patches are right, once carried along
    moved,    ///< the samples need to be measured again
    stale,    ///< contact has to be searched for
  };
  /// Contacts up to `needed` [m] apart are wanted now, and were found up to `found`. Sizes [m]: no point of A
  /// is further than `size_a` from its origin, nor of B than `size_b`. `spacing`: see ContactSettings.
  /// `empty`: there is nothing to be measured.
  Age ageAt(const Placed& now, btScalar size_a, btScalar size_b, btScalar needed, btScalar found,
            btScalar spacing, bool empty) const;
  /// How much further apart than needed contacts are to be found, so that they are good for later steps.
  static btScalar reserve(btScalar spacing);

  /// How far bodies without samples may move on until contact has to be searched for again [m]. Negative
  /// if there are samples.
  btScalar leeway(const Placed& now, btScalar size_a, btScalar size_b, btScalar spacing) const;

  /// samples have been found anew.
  void searchedAt(const Placed& now);
  /// Turns the samples along, to be measured again.
  void turnTo(const Placed& now);
  /// patches have been measured, with all contacts up to `found` [m] apart.
  void measuredAt(const Placed& now, btScalar found);
  /// Asks for the memory of what is moved along.
  void fetchPatches() const {
    fetch(measured_.data(), measured_.size());
    fetch(patches.data(), patches.size());
  }
  /// Moves the patches along: each contact has a point that moves with A and one that moves with B, and rolls
  /// on where surfaces are curved. A's is the packing that positions are relative to the origin of.
  void carryTo(const Placed& now, const PackingShape& a, btScalar spacing);

  Samples samples;
  std::vector<ContactPatch> patches;

 private:
  Placed searched_at_;
  /// A nut on its thread, a peg, teeth that mesh: bodies that rattle in their clearance touch now here and
  /// now there, so that contact is searched for whenever they move.
  bool enclosed_ = false;
  Placed measured_at_;
  btScalar gap_ = 0;  ///< the narrowest there [m]; negative: overlap
  std::vector<ContactPatch> measured_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
