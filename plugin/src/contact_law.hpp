// How strongly a patch of contact pushes.
#pragma once

#include <vector>

#include "contact_patch.hpp"
#include "innersphere/contact_options.hpp"

class btCollisionObject;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// What Bullet's solver is told of one contact point.
struct PointLaw {
  bool spring = false;     ///< stiffness and damping are to be set
  btScalar depth = 0;      ///< to report [m]
  btScalar stiffness = 0;  ///< [N/m]
  btScalar damping = 0;    ///< [N s/m]
};

/// The law of one pair of bodies in one step. A contact with stiffness k and damping c is, in Bullet's
/// solver, exactly a backward-Euler spring-damper: any stiffness is stable.
///
/// With m the reduced mass of the pair, dt the step, and T = sum A max(0, n n') the area that pushes along n:
///   stiffness along n   K = options.stiffness T,  or by default  K = 16 m / dt^2, for which a body that lies
///   still under
///                       gravity g sinks by g dt^2 / 16 (0.17 mm at 1/60 s), whatever its size and mass;
///   damping along n     C = options.damping 2 sqrt(K m).
/// Each patch takes the share A / T of both and divides it among its points.
class ContactLaw {
 public:
  /// `size` [m] of the smaller body bounds the speed at which the default law drives bodies apart.
  ContactLaw(const ContactOptions& options, btScalar reduced_mass, btScalar time_step, btScalar size);

  /// To be called once a step.
  void weigh(const std::vector<ContactPatch>& patches);
  /// A point of patch `index` of those.
  PointLaw point(std::size_t index, btScalar depth) const;

 private:
  struct PatchLaw {
    btScalar stiffness;  ///< of each point
    btScalar damping;
  };
  const ContactOptions& options_;
  btScalar mass_;
  btScalar time_step_;
  btScalar deepest_;
  std::vector<PatchLaw> laws_;
};

/// 1 / (1/m_a + 1/m_b), static and kinematic bodies counting as infinitely heavy; 0 if both are.
btScalar reducedMass(const btCollisionObject& a, const btCollisionObject& b);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
