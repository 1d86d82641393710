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
  /// Radii for overlap volumes, where these decide the depth of contact (see stiffness).
  Estimator estimator = Estimator::volume_true;
  /// For Response::compliant.
  /// 0: as stiff as the step can resolve, 64 m / dt^2 with m the reduced mass of the pair, divided among the
  /// points that push the same way: a body that lies still sinks by 0.04 mm at 60 Hz, whatever its mass.
  /// Depth is measured on the solids' surfaces, so bodies meet where they are drawn. Above 0: pressure that a
  /// metre of overlap causes [N/m^3]. A contact pushes with stiffness times overlap volume, which the spheres
  /// alone decide.
  double stiffness = 0;
  /// Fraction of critical damping of a contact: 0 is bouncy, 1 has no rebound from the spring itself.
  /// Bullet's restitution works on top of it.
  double damping = 1;
};

}  // namespace innersphere
