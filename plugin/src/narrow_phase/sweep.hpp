// Looks for contact all along a step.
#pragma once

#include <vector>

#include "common/pair_motion.hpp"
#include "narrow_phase/contact_point.hpp"
#include "narrow_phase/contact_transport.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Goes through the poses at which contact is searched for in a step. For most pairs that is one: where the
/// bodies are. Pairs that are swept go on from there along their way, by a quarter of the size of the smaller
/// body from pose to pose. Where they are about to meet, the contact is kept, and their way goes on along it.
///
/// The solver knows only where bodies are when the step begins. So what is kept is taken back to there, with
/// a gap as wide as the way to it: the solver lets the bodies go as far, and no further.
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
  /// Takes what was found at the pose, and goes to the next one. If nothing at all was found, that is the
  /// first one again, in the end. Returns false if there is none left.
  bool goesOn(const std::vector<ContactPatch>& found);
  /// Returns true if contacts were kept, which are then those of the step.
  bool hasKept() const { return !kept_.empty(); }
  /// Replaces `patches`, of the last pose, by what was kept, if there is any.
  void finish(std::vector<ContactPatch>& patches) const;

 private:
  bool isNear() const;
  btScalar wayTo(const ContactPoint& point) const;
  bool stops(const ContactPatch& patch) const;
  bool stops(const ContactPoint& point) const;
  void keep(ContactPatch patch);
  void deflect(const std::vector<ContactPatch>& found);
  void advance();

  const PackingShape* a_ = nullptr;
  const btCollisionShape* b_ = nullptr;
  Placed now_;
  StepAhead step_;
  int poses_ = 1;
  int pose_ = 0;
  Placed placed_;
  StepAhead ahead_;
  btScalar time_ = 0;           ///< of the pose, since the step began [s]
  btVector3 moved_a_{0, 0, 0};  ///< the way of A's body to it [m]
  std::vector<ContactPatch> kept_;
  bool stopped_ = false;  ///< the bodies have met
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
