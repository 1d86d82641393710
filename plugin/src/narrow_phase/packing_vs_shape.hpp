// The contact of a packing with a shape of another kind.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include "innersphere/contact_options.hpp"
#include "innersphere/packing_shape.hpp"
#include "narrow_phase/contact_point.hpp"
#include "narrow_phase/contact_settings.hpp"
#include "narrow_phase/contact_transport.hpp"
#include "narrow_phase/shapes/shape_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

class SurfaceContact {
 public:
  /// `packing` and `other` are what the two wrappers of update() will hold.
  SurfaceContact(const PackingShape& packing, const btCollisionShape& other);

  /// A is the packing.
  void update(const ContactOptions& options, const btTransform& packing, const btTransform& other,
              btScalar separation);
  const std::vector<ContactPatch>& patches() const { return memory_.patches; }
  /// How far the bodies may move on, from where they were in the last update, until contact has to be
  /// searched for again, as long as they come no nearer than reach() in a step [m]; not positive if in every
  /// step.
  btScalar leeway() const { return leeway_; }
  btScalar reach() const { return reach_; }
  /// Whether the other shape is as it was. If not, contact is searched for in the next update.
  bool isAsBefore();
  /// What both share, at the places of the last update. Its torque is about the origin of the packing.
  const Overlap& volumesOf(const ContactOptions& options, const btTransform& packing,
                           const btTransform& other);

 private:
  const PackingShape& packing_;
  const btCollisionShape& other_;
  /// Contacts on the surfaces from those of earlier steps. False if they need to be searched for.
  bool remember(const PlacedPacking& a, const ContactSettings& measure, const Placed& now,
                btScalar separation);

  std::unique_ptr<ShapeSurface> surface_;    ///< null for shapes without one
  ContactTransport memory_;                  ///< its samples are indices of near spheres
  std::vector<NearSphere> near_spheres_;     ///< of the last search
  std::optional<ContactSettings> measured_;  ///< of it, if it found contact of the surfaces
  btScalar margin_ = 0;                      ///< of the packing, then
  btScalar scale_ = 0;
  btScalar leeway_ = -1;
  btScalar reach_ = 0;
  std::optional<Overlap> overlap_;  ///< once it was asked for
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
