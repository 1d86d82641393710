// Says how strongly a patch of contact pushes.
#pragma once

#include <vector>

#include "innersphere/contact_options.hpp"
#include "narrow_phase/contact_point.hpp"
#include "response/solver_settings.hpp"

class btCollisionObject;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Tells Bullet's solver of one contact point.
struct PointLaw {
  bool spring = false;     ///< the solver is to use stiffness and damping
  bool penalty = false;    ///< the solver is to leave the point alone
  bool solved = true;      ///< a solver reads the point; else whoever does wants to know it as it is
  btScalar depth = 0;      ///< to report [m]
  btScalar stiffness = 0;  ///< [N/m]
  btScalar damping = 0;    ///< [N s/m]
  btScalar friction = 1;   ///< share of it
  btScalar push = 0;       ///< speed at which the spring alone would drive the bodies apart [m/s]
  btScalar rolling = 0;    ///< how far ahead the load of bodies that roll lies [m]
  bool rocks = false;      ///< the bodies touch nowhere beside a line
  btScalar tilting = 0;    ///< how much further for each radian that they tilt in the step [m]
  btScalar bears = 0;      ///< impulse of the spring in a step at rest [N s]
  bool starts = false;     ///< the solver is to start with that, whatever the last impulse was
  bool held_back = false;  ///< the spring counts less than the depth, so that nothing is thrown
  btScalar time_step = 0;  ///< [s]
};

/// This is the law of one pair of bodies in one step. A contact with stiffness k and damping c is, in
/// Bullet's solver, exactly a backward-Euler spring-damper: any stiffness is stable.
///
/// With m the reduced mass of the pair, dt the step, and T = sum A max(0, n n') the area that pushes along n:
///   stiffness along n   K = options.stiffness T;
///                       default: K = 18 m / dt^2 (1 + d / (0.002 s)) at the depth d, s the size of the
///                       smaller body, for which a body that lies on a fixed one under gravity g sinks by
///                       g dt^2 / 18 (0.15 mm at 1/60 s), whatever its size and mass;
///                       in a chain: K = 31 m / dt^2 (1 + d / (0.005 s));
///   damping along n     C = options.damping 2 sqrt(K m), four times that by default.
/// Each patch takes the share A / T of both and divides it among its points. A chain is where both bodies
/// touch two others at most, at least one of them two, and each other in one round place. The default law
/// drives bodies that are inside each other apart no faster than half the size of the smaller one, or three
/// times the depth that was measured on their surfaces, in a second; where they touch in several directions,
/// so fast along the deepest patch only. So does Response::rigid as far as the solver would give them a
/// speed; what is deeper than the threshold of split impulses it moves apart at once.
///
/// A SubstepSolver is told the measured depth, without a spring but for one that is given: it has its own.
/// So is whoever reads contacts that no solver does, see areSolved().
///
/// Patches that press against each other, deeper than is seen, leave with less friction and push (Squeeze).
/// Not where a stiffness is given, which says how deep bodies are meant to be in each other.
///
/// Where bodies touch in one place or along a line, on which they could roll, they resist it as if their load
/// lay 0.00001 s ahead: a ball of 1 m loses 0.07 mm/s of its speed in a second. Links that bear several
/// others tilt against a stiffness N s of their load N, which a step takes as it was when it began. Backward
/// Euler takes it at the end, a way s w dt further ahead, with w the speed at which they tilt. So it does
/// where bodies rock on each other, as far as the step does not resolve it, see rockingSpeed().
class ContactLaw {
 public:
  /// Makes the law of a pair. `reduced_mass` is in kg, and 0 counts as 1; `time_step` is in s, and 0 counts
  /// as 1/60; `size` [m] is that of the smaller body; `of_links` says that both are of a chain,
  /// `solved` that a solver reads their contacts.
  ContactLaw(const ContactOptions& options, btScalar reduced_mass, btScalar time_step, btScalar size,
             const SolverSettings& solver = {}, bool of_links = false, bool solved = true);

  /// This is the law for the points of one patch.
  class OfPatch {
   public:
    /// Returns the law of a point with this depth [m], negative where the bodies do not touch yet.
    PointLaw at(btScalar depth) const;
    /// Returns the slip of the reduced mass that Bullet's friction anchors undo by this impulse [N s] in a
    /// step: of a slip s they undo the part e by m e s / dt [m].
    btScalar slipUndoneBy(btScalar impulse) const;
    /// Returns the size of the smaller body [m].
    btScalar size() const { return law_->size_; }

   private:
    friend class ContactLaw;
    const ContactLaw* law_;
    btScalar stiffness_;
    btScalar damping_;
    btScalar leaving_;  ///< how fast what is deep may be driven apart [m/s]
    btScalar rolling_;
    bool rocks_;
    btScalar push_left_;  ///< share, by what presses against it
    bool in_chain_;
  };
  /// Returns the law of patch `index`. All patches of the pair share its stiffness.
  OfPatch of(const std::vector<ContactPatch>& patches, std::size_t index) const;

  bool penalty() const { return response_ == Response::penalty; }
  const SolverSettings& solver() const { return solver_; }
  /// Returns the stiffness of Response::penalty [N/m^3].
  btScalar penaltyStiffness() const { return given_stiffness_; }

 private:
  bool defaultSpring() const { return response_ == Response::compliant && !(given_stiffness_ > 0); }

  Response response_;
  btScalar given_stiffness_;
  btScalar damping_ratio_;
  btScalar mass_;
  btScalar time_step_;
  btScalar size_;
  SolverSettings solver_;
  bool of_links_;
  bool solved_;
};

/// Returns 0 for static and kinematic bodies, and for parts of a multi-body that have no mass themselves
/// [1/kg].
btScalar inverseMass(const btCollisionObject& object);

/// Returns 1 / (1/m_a + 1/m_b) [kg], static and kinematic bodies counting as infinitely heavy; 0 if both are.
btScalar reducedMass(const btCollisionObject& a, const btCollisionObject& b);

/// Returns how deep a body sinks into a fixed one under its own weight, by the default law [m]; 0 if it has
/// no weight, or none of its own.
btScalar depthAtRest(const btCollisionObject& object, btScalar time_step);

/// Returns true if a solver does something about contacts of these bodies: both respond to them, and one of
/// the two can be moved. Those of sensors, of ghosts and characters on what stands still, and of bodies in a
/// world without dynamics are only read.
bool areSolved(const btCollisionObject& a, const btCollisionObject& b);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
