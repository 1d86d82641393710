// Decides what of a pair's contact can be used again in a new step.
#pragma once

#include "pair_cache/body_snapshot.hpp"
#include "pair_cache/contact_pair.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Returns, as the one rule of reuse, what has to be done for `pair` in a step of `time_step` [s] whose
/// bodies are `a` and `b`, if nothing less than `least` is allowed. Asks the shapes whether they have
/// changed, which they tell once a step.
Reuse reuseOf(const ContactPair& pair, const BodySnapshot& a, const BodySnapshot& b, btScalar time_step,
              Reuse least = Reuse::idle);

/// Returns the width up to which gaps of the pair are to have a contact in the step [m]: they might close in
/// it, also where another body stops one of the two.
btScalar neededSeparation(const ContactPair& pair, const BodySnapshot& a, const BodySnapshot& b,
                          btScalar time_step);

/// Notes on both bodies how much nearer they come to each other in the step, if they may meet in it: what
/// flies along with one of them does not stop with it.
void noteWay(const ContactPair& pair, BodySnapshot& a, BodySnapshot& b, btScalar time_step);

/// Returns for how far the bodies of a pair without contacts stay apart, after an update that is published.
SafeDistance safeDistanceOf(const ContactPair& pair, const BodySnapshot& a, const BodySnapshot& b);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
