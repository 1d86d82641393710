// Finds the contact of a packing with a shape of another kind.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include "innersphere/contact_options.hpp"
#include "innersphere/packing_shape.hpp"
#include "narrow_phase/found_contact.hpp"
#include "narrow_phase/shapes/shape_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds the contact of a packing, A, with another shape, B.
class PackingVsShape : public FoundContact {
 public:
  /// Takes the packing and the shape, which must both outlive it.
  PackingVsShape(const PackingShape& packing, const btCollisionShape& other);

  /// Searches for contacts up to `step.needed` apart, all along the step if the pair is swept.
  void search(const ContactOptions& options, const Placed& now, const StepAhead& step);

  bool hasSameShapes() override;
  bool refine(const Placed& now, const StepAhead& step) override;
  const Overlap* overlap() const override { return overlap_ ? &*overlap_ : nullptr; }
  /// Returns what both share at `now`.
  Overlap volumesAt(const ContactOptions& options, const Placed& now) const;

 private:
  /// Searches where the bodies are at `now`, or will be then.
  void searchAt(const Placed& now, const ContactOptions& options, const StepAhead& step);
  /// Drops feelers that are through the middle of something thin: they see its other side, and the sphere
  /// next to them knows the way out.
  void dropFeelersThrough(const PlacedPacking& a);
  /// Lists what B cuts from the near spheres and feelers, as far as they search: one for each.
  void searchCapsOf(const PlacedPacking& a, std::vector<SphereContact>& caps) const;
  /// Lists what B cuts from the spheres themselves.
  void volumeCapsOf(const PlacedPacking& a, std::vector<SphereContact>& caps) const;

  const PackingShape& packing_;
  const btCollisionShape& other_;
  std::unique_ptr<ShapeSurface> surface_;  ///< null for shapes without one
  std::vector<NearSphere> near_spheres_;   ///< of the last search: the samples
  std::optional<Overlap> overlap_;         ///< where forces need it
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
