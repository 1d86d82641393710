// Chooses the number of substeps.
#pragma once

#include <vector>

#include "innersphere/substep_solver.hpp"
#include "solver/constraint_rows.hpp"
#include "solver/contact_rows.hpp"
#include "solver/solver_bodies.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Returns the number of substeps for a step [s] of a group: the one that is given; else as many as keep
/// substeps short enough, and contacts shallow enough. A body of mass m that bears R m under the acceleration
/// g gives way by
///   R g h^2 / p^2,
/// with h the substep and p = kContactPhase, the phase of the spring. R is the largest ratio of two masses
/// that meet.
int substepsFor(const SubstepOptions& options, btScalar time_step, const SolverBodies& bodies,
                const std::vector<TouchingPair>& pairs, const ConstraintRows& constraints);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
