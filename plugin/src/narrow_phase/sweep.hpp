// Looks for contact all along a step.
#pragma once

#include <vector>

#include "common/pair_motion.hpp"
#include "narrow_phase/contact_point.hpp"
#include "narrow_phase/contact_transport.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Goes through the poses at which contact is searched for in a step. For most pairs that is one: where the
/// bodies are. Pairs that are swept have more, as far apart as half the size of the smaller body, and the
/// search ends at the last one before they meet. The solver knows only where bodies are when the step begins,
/// and so the contacts that were found there are taken back to it, with gaps as wide as the way to them.
class Sweep {
 public:
  /// Has no pose.
  Sweep() = default;
  /// Begins where the bodies are now. `a` is the packing that positions are relative to the origin of, and
  /// `b` the other shape. Both must outlive the sweep.
  Sweep(const PackingShape& a, const btCollisionShape& b, const Placed& now, const StepAhead& step);

  /// Returns the pose to search at.
  const Placed& placed() const { return placed_; }
  /// Returns what the rest of the step brings from there on.
  const StepAhead& ahead() const { return ahead_; }
  /// Goes to the next pose, if the contacts that were `found` at this one stop the bodies too late. Where
  /// nothing stops them, the last pose is the first one again. Returns false if there is none left.
  bool goesOn(const std::vector<ContactPatch>& found);
  /// Takes contacts that were found at this pose back to where the bodies are now.
  void takeBack(std::vector<ContactPatch>& patches) const;

 private:
  void goTo(int pose);
  bool isNear() const;
  bool stops(const ContactPoint& point) const;

  const PackingShape* a_ = nullptr;
  const btCollisionShape* b_ = nullptr;
  Placed now_;
  StepAhead step_;
  int poses_ = 1;
  int pose_ = 0;
  btScalar time_ = 0;  ///< of the pose, since the step began [s]
  Placed placed_;
  StepAhead ahead_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
