// Declares a constraint solver that lets bodies stand, hang and turn in steps of 1/60 s.
#pragma once

#include <memory>

#include <BulletDynamics/ConstraintSolver/btConstraintSolver.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Says how a SubstepSolver divides its steps.
struct SubstepOptions {
  /// The number of substeps, 1 to 1,000; 0: it is chosen for each group of bodies, by what follows.
  int substeps = 0;
  /// Substeps are at least so short [s]: what stands in stacks sways less, the shorter they are.
  /// It is a time, however small bodies are: models of millimetres that are stepped fast get one or two
  /// substeps, and sink by some 0.4 % of their size unless it is made shorter as well.
  btScalar longest = btScalar(1) / 960;
  /// How deep a body may be pressed into what it bears by a heavier one, as a share of its own size (the
  /// diameter of its bounding sphere). Half of it takes 1.4 times as many substeps.
  btScalar depth = btScalar(0.0015);
  /// The largest number of substeps that is chosen, however unequal masses are.
  int most = 64;
};

/// Takes the place of btSequentialImpulseConstraintSolver:
///
///     SubstepSolver solver;
///     btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
///
/// It divides a step into substeps, and looks for contact once a step: in between, contacts follow the
/// bodies. A substep takes one pass over all rows with soft contacts, or up to ten where bodies hit others,
/// moves the bodies, and takes as many without what drives bodies apart ("Soft Step" of E. Catto,
/// https://box2d.org/posts/2024/02/solver2d/; why substeps, M. Macklin et al., Small Steps in Physics
/// Simulation, SCA 2019). Errors fall with the square of the substep.
///
/// * Contacts of packings and of all other shapes, with friction in a cone, restitution, rolling and spinning
///   friction, stiffness and damping (or CFM and ERP) of the user's, and surface speeds (`m_contactMotion1`).
/// * Constraints of all kinds, the user's own included: their rows are asked for in each substep.
/// * Gyroscopic torque keeps the angular momentum of bodies that may turn freely, unless their flags forbid
/// it.
///
/// Not used of btContactSolverInfo: iterations, split impulse and its threshold, ERP, CFM and the second
/// direction of friction of contacts, the random order. m_erp and m_globalCfm are those of constraints, in
/// each substep.
///
/// It is for btDiscreteDynamicsWorld. A btMultiBodyDynamicsWorld solves with a solver of its own kind, like
/// MultiBodySubstepSolver, and never calls this one; the log says so once. Continuous collision detection of
/// Bullet's convex shapes (setCcdMotionThreshold) looks along the last part of a body's way in a step.
///
/// One solver may serve several worlds: those that step at the same time wait for each other. Bodies with
/// infinite or undefined velocities, forces or places are stopped and touch nothing in such a step, contacts
/// and rows of constraints that are not finite are left out, and the log says so once. Results are the same
/// bits for any number of threads (oneTBB; limit them by tbb::global_control or in a tbb::task_arena).
class SubstepSolver : public btConstraintSolver {
 public:
  /// Throws Error bad_argument if an option is out of range.
  explicit SubstepSolver(const SubstepOptions& options = {});
  ~SubstepSolver() override;
  SubstepSolver(const SubstepSolver&) = delete;
  SubstepSolver& operator=(const SubstepSolver&) = delete;

  /// Returns the options of the next step.
  const SubstepOptions& options() const;
  /// Replaces the options from the next step on. Throws Error bad_argument if one is out of range.
  void setOptions(const SubstepOptions& options);
  /// Returns the number of substeps in the last step, the largest where groups of bodies had several; 0
  /// before the first step, and if no body was awake.
  int substeps() const;

  /// Begins a step. Bullet calls it, so programs need not; the same holds for all that follows.
  void prepareSolve(int bodies, int manifolds) override;
  /// Solves a group of bodies, and moves them.
  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                      int manifold_count, btTypedConstraint** constraints, int constraint_count,
                      const btContactSolverInfo& info, btIDebugDraw* drawer,
                      btDispatcher* dispatcher) override;
  /// Ends a step.
  void allSolved(const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  /// Forgets what constraints have borne.
  void reset() override;
  /// Returns BT_SEQUENTIAL_IMPULSE_SOLVER, in whose place it stands.
  btConstraintSolverType getSolverType() const override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
