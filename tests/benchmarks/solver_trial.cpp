#include "solver_trial.hpp"

#include <algorithm>

#include "timing.hpp"

namespace innersphere::benchmarks {
namespace {

constexpr int kTries = 3;

}  // namespace

void SolverTrial::add(const std::string& name, std::shared_ptr<btConstraintSolver> solver, int threads) {
  candidates.push_back({name, std::move(solver), threads, std::make_unique<tbb::task_arena>(threads), {}});
}

void SolverTrial::prepareSolve(int bodies, int manifolds) {
  points_ = 0;
  if (measures) {
    for (Candidate& candidate : candidates) {
      candidate.solver->prepareSolve(bodies, manifolds);
      candidate.times.push_back(0);
    }
  }
  lead->prepareSolve(bodies, manifolds);
}

btScalar SolverTrial::solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                                 int manifold_count, btTypedConstraint** constraints, int constraint_count,
                                 const btContactSolverInfo& info, btIDebugDraw* drawer,
                                 btDispatcher* dispatcher) {
  const auto solve = [&](btConstraintSolver& solver) {
    return solver.solveGroup(bodies, body_count, manifolds, manifold_count, constraints, constraint_count,
                             info, drawer, dispatcher);
  };
  if (!measures) return solve(*lead);
  bodies_.clear();
  saved_.clear();
  for (int i = 0; i < body_count; ++i) {
    const btRigidBody& body = *btRigidBody::upcast(bodies[i]);
    bodies_.push_back({body.getWorldTransform(), body.getLinearVelocity(), body.getAngularVelocity()});
  }
  const auto forEachPoint = [&](const auto& work) {
    for (int i = 0; i < manifold_count; ++i) {
      for (int k = 0; k < manifolds[i]->getNumContacts(); ++k) work(manifolds[i]->getContactPoint(k));
    }
  };
  forEachPoint([&](const btManifoldPoint& point) { saved_.push_back(point); });
  points_ += static_cast<int>(saved_.size());
  const auto restore = [&] {
    for (int i = 0; i < body_count; ++i) {
      btRigidBody& body = *btRigidBody::upcast(bodies[i]);
      const Body& from = bodies_[static_cast<std::size_t>(i)];
      body.setWorldTransform(from.pose);
      body.setLinearVelocity(from.velocity);
      body.setAngularVelocity(from.spin);
    }
    std::size_t next = 0;
    forEachPoint([&](btManifoldPoint& point) { point = saved_[next++]; });
  };
  for (Candidate& candidate : candidates) {
    double least = 1e300;
    for (int i = 0; i < kTries; ++i) {
      candidate.arena->execute([&] { least = std::min(least, timeOf([&] { solve(*candidate.solver); })); });
      restore();
    }
    candidate.times.back() += least;
  }
  return solve(*lead);
}

void SolverTrial::allSolved(const btContactSolverInfo& info, btIDebugDraw* drawer) {
  for (Candidate& candidate : candidates) {
    if (measures) candidate.solver->allSolved(info, drawer);
  }
  lead->allSolved(info, drawer);
}

}  // namespace innersphere::benchmarks
