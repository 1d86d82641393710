// Says how far is near, and on what depth is found.
#pragma once

#include "innersphere/contact_options.hpp"
#include "shape/packing_shape_impl.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Tells the narrow phase what it needs to know of a pair, beside where its bodies are.
struct ContactSettings {
  /// Bodies that are not further apart than `needed` [m] still have a contact, if depth is found on the
  /// surfaces. The search goes a little further, so that its contacts are good for the next steps too, and at
  /// least as far as the distance at which Bullet drops contacts: see separation.
  ContactSettings(const ContactOptions& options, const PackingShape& a, const btCollisionShape& b,
                  btScalar needed);

  /// Returns the search margins of both bodies together [m].
  btScalar search_margin() const { return search_margin_a + search_margin_b; }

  /// Whether depth is found on the surfaces of the solids. Otherwise it is volume over area, which a given
  /// stiffness (force per volume) asks for, and a packing without a surface.
  bool on_surfaces = false;
  Estimator estimator = Estimator::raw;  ///< radii of the spheres
  btScalar spacing;                      ///< points closer to each other are one [m]
  btScalar separation;                   ///< surfaces further apart than this have no contact [m]
  bool thin = false;                     ///< of packings: a body is so thin that faces end near all points
  btScalar inset_a = 0;                  ///< how far spheres of A may end inside of its surface [m]
  btScalar search_margin_a = 0;          ///< how far beyond their radii spheres of A search for contacts [m]
  btScalar search_margin_b = 0;
  const Prefix* prefix_a;            ///< spheres to use
  const Prefix* prefix_b = nullptr;  ///< null if B is no packing
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
