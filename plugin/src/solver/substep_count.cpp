#include "solver/substep_count.hpp"

#include <algorithm>
#include <cmath>

#include "solver/soft_step.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

int substepsFor(const SubstepOptions& options, btScalar time_step, const SolverBodies& bodies,
                const std::vector<TouchingPair>& pairs, const ConstraintRows& constraints) {
  if (options.substeps > 0) return options.substeps;
  // The largest load over what may give way [1/m].
  btScalar worst = 0;
  const auto notice = [&](int a, int b) {
    if (!bodies.isMovable(a) || !bodies.isMovable(b)) return;
    if (bodies.mass(a) > bodies.mass(b)) std::swap(a, b);
    const btScalar give = bodies.mass(a) * bodies.size(a);
    if (give > 0) worst = std::max(worst, bodies.mass(b) / give);
  };
  for (const TouchingPair& pair : pairs) notice(pair.a, pair.b);
  for (int i = 0; i < constraints.count(); ++i) notice(constraints.bodyA(i), constraints.bodyB(i));
  const btScalar by_load =
      time_step / kContactPhase * std::sqrt(worst * bodies.largestAcceleration() / options.depth);
  constexpr btScalar kRounding = btScalar(1e-3);
  const btScalar wanted = std::max(by_load, time_step / options.longest) - kRounding;
  if (!(wanted < btScalar(options.most))) return options.most;
  return std::max(1, static_cast<int>(std::ceil(wanted)));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
