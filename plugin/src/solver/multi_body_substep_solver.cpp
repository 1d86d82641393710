#include "innersphere/multi_body_substep_solver.hpp"

#include <algorithm>

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "common/log.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

MultiBodySubstepSolver::MultiBodySubstepSolver(const SubstepOptions& options,
                                               btMultiBodyConstraintSolver* others)
    : substep_solver_(options), others_(others) {}

bool MultiBodySubstepSolver::isMovingLink(const btCollisionObject& object) {
  return btMultiBodyLinkCollider::upcast(&object) != nullptr && !object.isStaticOrKinematicObject();
}

void MultiBodySubstepSolver::prepareSolve(int bodies, int manifolds) {
  substep_solver_.prepareSolve(bodies, manifolds);
  solved_ = false;
  if (others_ != nullptr) others_->prepareSolve(bodies, manifolds);
}

void MultiBodySubstepSolver::solveMultiBodyGroup(btCollisionObject** bodies, int body_count,
                                                 btPersistentManifold** manifolds, int manifold_count,
                                                 btTypedConstraint** constraints, int constraint_count,
                                                 btMultiBodyConstraint** multi_body_constraints,
                                                 int multi_body_constraint_count,
                                                 const btContactSolverInfo& info, btIDebugDraw* drawer,
                                                 btDispatcher* dispatcher) {
  const auto moving = [](const btCollisionObject* body) { return isMovingLink(*body); };
  if (multi_body_constraint_count == 0 && std::none_of(bodies, bodies + body_count, moving)) {
    solved_ = true;
    substep_solver_.solveGroup(bodies, body_count, manifolds, manifold_count, constraints, constraint_count,
                               info, drawer, dispatcher);
    return;
  }
  const auto rigid = [](const btCollisionObject* body) {
    return btRigidBody::upcast(body) != nullptr && !body->isStaticOrKinematicObject();
  };
  if (info.m_minimumSolverBatchSize > 1 && std::any_of(bodies, bodies + body_count, rigid)) logBatches();
  if (others_ != nullptr) {
    others_->solveMultiBodyGroup(bodies, body_count, manifolds, manifold_count, constraints, constraint_count,
                                 multi_body_constraints, multi_body_constraint_count, info, drawer,
                                 dispatcher);
  } else {
    btMultiBodyConstraintSolver::solveMultiBodyGroup(bodies, body_count, manifolds, manifold_count,
                                                     constraints, constraint_count, multi_body_constraints,
                                                     multi_body_constraint_count, info, drawer, dispatcher);
  }
}

void MultiBodySubstepSolver::logBatches() {
  if (logged_) return;
  logged_ = true;
  log("MultiBodySubstepSolver was given rigid bodies in one group with a btMultiBody, which Bullet's solver "
      "solves: set world.getSolverInfo().m_minimumSolverBatchSize = -1, so that only those that touch are in "
      "one group. This is said once.");
}

void MultiBodySubstepSolver::allSolved(const btContactSolverInfo& info, btIDebugDraw* drawer) {
  if (solved_) substep_solver_.allSolved(info, drawer);
  if (others_ != nullptr) others_->allSolved(info, drawer);
}

void MultiBodySubstepSolver::reset() {
  substep_solver_.reset();
  btMultiBodyConstraintSolver::reset();
  if (others_ != nullptr) others_->reset();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
