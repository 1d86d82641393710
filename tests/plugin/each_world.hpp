// Worlds that a test runs in, one after the other.
#pragma once

#include "innersphere/substep_solver.hpp"
#include "test_world.hpp"

namespace innersphere::test {

/// Calls for a world with each solver, at 60 and at 240 steps a second.
template <typename Run>
void inEachWorld(const Run& run) {
  SubstepSolver solver;
  for (const bool substeps : {false, true}) {
    for (const double rate : {60.0, 240.0}) {
      TestWorld world;
      if (substeps) world.world.setConstraintSolver(&solver);
      PackingCollisionAlgorithm::prepareWorld(world.world);
      run(world, substeps, rate);
    }
  }
}

}  // namespace innersphere::test
