// How overlap becomes contact.
#pragma once

#include "innersphere/query.hpp"

namespace innersphere {

/// What Bullet's solver is given.
enum class Response {
  compliant,  ///< contact points with stiffness and damping: an implicit spring, stable at any stiffness and
              ///< step
  rigid,      ///< ordinary contact points: the solver removes the penetration
};

/// Options of a registration; they hold for every pair of the dispatcher.
struct ContactOptions {
  Response response = Response::compliant;
  Backend backend = Backend::automatic;
  Estimator estimator = Estimator::volume_true;
  /// Pressure that a metre of overlap causes [N/m^3]: a patch of area A that is d deep pushes with stiffness
  /// * A * d. 0: from the masses, the size of the patch and the step, so that contacts are as stiff as the
  /// step can resolve.
  double stiffness = 0;
  /// Fraction of critical damping of a contact, 0 (bouncy) to 1 (no rebound from the spring itself).
  double damping = 1;
};

}  // namespace innersphere
