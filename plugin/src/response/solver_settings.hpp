// Says what contacts have to know of the solver that they are for.
#pragma once

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <LinearMath/btMinMax.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/multi_body_substep_solver.hpp"
#include "innersphere/substep_solver.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds Bullet's defaults, or the settings of a world.
struct SolverSettings {
  SolverSettings() = default;
  explicit SolverSettings(const btContactSolverInfo& info)
      : warm_starting((info.m_solverMode & SOLVER_USE_WARMSTARTING) != 0 ? info.m_warmstartingFactor
                                                                         : btScalar(0)),
        erp(btMax(btMax(info.m_erp, info.m_erp2), btScalar(1e-3))),
        friction_erp(info.m_frictionERP),
        deepest_push(info.m_splitImpulse ? -info.m_splitImpulsePenetrationThreshold : BT_LARGE_FLOAT),
        deepest_spring(info.m_splitImpulse ? kSpringShare * deepest_push : BT_LARGE_FLOAT),
        one_friction_row((info.m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS) == 0) {}
  explicit SolverSettings(btDynamicsWorld& world) : SolverSettings(world.getSolverInfo()) {
    // A world for btMultiBody never calls a solver that is not of its own kind.
    const btConstraintSolver* solver = world.getConstraintSolver();
    substeps = dynamic_cast<const btMultiBodyDynamicsWorld*>(&world) == nullptr
                   ? dynamic_cast<const SubstepSolver*>(solver) != nullptr
                   : dynamic_cast<const MultiBodySubstepSolver*>(solver) != nullptr;
    if (substeps) one_friction_row = false;
  }

  /// The part of its last impulse that a contact starts with.
  btScalar warm_starting = btScalar(0.85);
  /// The part of its depth that a contact without a spring loses in a step.
  btScalar erp = btScalar(0.2);
  /// The part of a slip that friction anchors undo in a step.
  btScalar friction_erp = btScalar(0.2);
  /// Deeper contacts are pushed apart without giving the bodies a speed: the threshold of split impulses [m].
  btScalar deepest_push = btScalar(0.04);
  /// Contacts deeper than the threshold of split impulses lose their spring: none is told to be deeper than
  /// this, three quarters of it [m].
  btScalar deepest_spring = btScalar(0.03);
  /// The solver is known to have one row of friction for each point. Its direction is that of the sliding
  /// before contacts push, and no point can set it: bodies that fall together have none, and the row may lie
  /// across the load.
  bool one_friction_row = false;
  /// It is a SubstepSolver, which makes contacts soft by itself, remembers friction, and bounces bodies in
  /// the substep in which they meet: it is told of contacts as they are.
  bool substeps = false;

 private:
  static constexpr btScalar kSpringShare = btScalar(0.75);
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
