// Declares a SubstepSolver for the rigid bodies of a btMultiBodyDynamicsWorld.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/substep_solver.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Takes the place of btMultiBodyConstraintSolver. A SubstepSolver solves groups (islands) of rigid bodies; a
/// group with a btMultiBody that can move is solved by Bullet's sequential impulses, whole. There contacts of
/// packings are as with Response::rigid.
///
///     MultiBodySubstepSolver solver;
///     btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
///     world.getSolverInfo().m_minimumSolverBatchSize = -1;
///
/// The last line has each group solved by itself. Bullet's default, 128, puts small groups into one, in which
/// a btMultiBody has all of them solved by sequential impulses; the log says so once. Worlds of deformable
/// bodies (btDeformableMultiBodyDynamicsWorld) solve in another way, and must have a solver of theirs.
class MultiBodySubstepSolver : public btMultiBodyConstraintSolver {
 public:
  /// others: solves the groups with a btMultiBody, and has to outlive this; null: this does, as its base
  /// class. Throws Error bad_argument if an option is out of range.
  explicit MultiBodySubstepSolver(const SubstepOptions& options = {},
                                  btMultiBodyConstraintSolver* others = nullptr);

  /// Returns the solver of the groups of rigid bodies.
  SubstepSolver& substepSolver() { return substep_solver_; }
  /// Returns the solver of the groups with a btMultiBody, or null if it is this one's base class.
  btMultiBodyConstraintSolver* others() const { return others_; }

  /// Returns true for a link, or base, of a btMultiBody that is neither static nor kinematic: its group is
  /// one of those that `others` solve.
  static bool isMovingLink(const btCollisionObject& object);

  /// Begins a step. Bullet calls it, so programs need not; the same holds for all that follows.
  void prepareSolve(int bodies, int manifolds) override;
  /// Solves a group of bodies that may be of both kinds.
  void solveMultiBodyGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                           int manifold_count, btTypedConstraint** constraints, int constraint_count,
                           btMultiBodyConstraint** multi_body_constraints, int multi_body_constraint_count,
                           const btContactSolverInfo& info, btIDebugDraw* drawer,
                           btDispatcher* dispatcher) override;
  /// Ends a step.
  void allSolved(const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  /// Forgets what constraints have borne.
  void reset() override;

 private:
  void logBatches();

  SubstepSolver substep_solver_;
  btMultiBodyConstraintSolver* others_;
  bool solved_ = false;  ///< a group of rigid bodies in this step
  bool logged_ = false;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
