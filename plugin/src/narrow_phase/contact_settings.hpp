// How a pair measures its depth of contact.
#pragma once

#include "innersphere/contact_options.hpp"
#include "shape/packing_shape_impl.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

struct Measure {
  /// `needed` [m]: bodies that are not further apart than this still have a contact, if the surfaces are
  /// measured. They are looked for from a little further away, so that they are good for the next steps too,
  /// and at least from the distance at which Bullet drops contacts: see separation. `world_options`: the
  /// dispatcher's, which those of the shapes replace.
  Measure(const ContactOptions& world_options, const PackingShape& a, const btCollisionShape& b,
          btScalar needed);

  btScalar slack() const { return slack_a + slack_b; }

  /// On the surfaces of the solids; else volume over area, which a given stiffness (force per volume) asks
  /// for, and a packing without a surface.
  bool on_surfaces = false;
  Estimator estimator = Estimator::raw;  ///< radii of the spheres
  btScalar spacing;                      ///< points closer to each other are one [m]
  btScalar separation;
  btScalar slack_a = 0;  ///< how far beyond their radii spheres look for contacts [m]
  btScalar slack_b = 0;
  const Prefix* prefix_a;            ///< spheres to use
  const Prefix* prefix_b = nullptr;  ///< null if B is no packing
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
