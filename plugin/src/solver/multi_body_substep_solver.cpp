#include "innersphere/multi_body_substep_solver.hpp"

#include <algorithm>

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

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
    substep_solver_.solveGroup(bodies, body_count, manifolds, manifold_count, constraints, constraint_count,
                               info, drawer, dispatcher);
  } else if (others_ != nullptr) {
    others_->solveMultiBodyGroup(bodies, body_count, manifolds, manifold_count, constraints, constraint_count,
                                 multi_body_constraints, multi_body_constraint_count, info, drawer,
                                 dispatcher);
  } else {
    btMultiBodyConstraintSolver::solveMultiBodyGroup(bodies, body_count, manifolds, manifold_count,
                                                     constraints, constraint_count, multi_body_constraints,
                                                     multi_body_constraint_count, info, drawer, dispatcher);
  }
}

void MultiBodySubstepSolver::allSolved(const btContactSolverInfo& info, btIDebugDraw* drawer) {
  substep_solver_.allSolved(info, drawer);
  if (others_ != nullptr) others_->allSolved(info, drawer);
}

void MultiBodySubstepSolver::reset() {
  substep_solver_.reset();
  btMultiBodyConstraintSolver::reset();
  if (others_ != nullptr) others_->reset();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
