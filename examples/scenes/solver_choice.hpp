// Which of the constraint solvers a scene runs with.
#pragma once

namespace innersphere::demo {

enum class SolverKind {
  bullet,  ///< btSequentialImpulseConstraintSolver
  substep  ///< SubstepSolver
};

struct SolverChoice {
  SolverKind kind = SolverKind::bullet;
  int substeps = 0;    ///< of a SubstepSolver; 0: it chooses
  int iterations = 0;  ///< of Bullet's solver in a step; 0: as many as Bullet does, which is 10
};

}  // namespace innersphere::demo
