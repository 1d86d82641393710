// Several constraint solvers that solve the same steps, one after the other.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <btBulletDynamicsCommon.h>
#include <tbb/task_arena.h>

namespace innersphere::benchmarks {

/// Stands in a world as its solver. Each step it gives the same bodies and contacts, with the same impulses
/// to start from, to each of its candidates, and then solves with `lead`, by which the world goes on.
class SolverTrial : public btConstraintSolver {
 public:
  struct Candidate {
    std::string name;
    std::shared_ptr<btConstraintSolver> solver;
    int threads;
    std::unique_ptr<tbb::task_arena> arena;
    std::vector<double> times;  ///< of the steps, each the least of a few tries [us]
  };

  std::shared_ptr<btConstraintSolver> lead;
  bool measures = false;  ///< else candidates rest
  std::vector<Candidate> candidates;

  void add(const std::string& name, std::shared_ptr<btConstraintSolver> solver, int threads);
  /// Returns the number of points in the last step that was measured.
  int points() const { return points_; }

  void prepareSolve(int bodies, int manifolds) override;
  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                      int manifold_count, btTypedConstraint** constraints, int constraint_count,
                      const btContactSolverInfo& info, btIDebugDraw* drawer,
                      btDispatcher* dispatcher) override;
  void allSolved(const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  void reset() override { lead->reset(); }
  btConstraintSolverType getSolverType() const override { return BT_SEQUENTIAL_IMPULSE_SOLVER; }

 private:
  struct Body {
    btTransform pose;
    btVector3 velocity, spin;
  };

  std::vector<Body> bodies_;
  std::vector<btManifoldPoint> saved_;
  int points_ = 0;
};

}  // namespace innersphere::benchmarks
