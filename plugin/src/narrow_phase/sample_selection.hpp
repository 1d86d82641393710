// Chooses which spheres in contact are worth probing on the surfaces.
#pragma once

#include <cstdint>
#include <vector>

#include <LinearMath/btMatrix3x3.h>

#include "innersphere/overlap.hpp"
#include "narrow_phase/patch_moments.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds contacts of spheres to probe, patch after patch.
struct Samples {
  struct OfPatch {
    btVector3 normal;  ///< unit, from A to B
    btScalar area;     ///< [m^2]
    btScalar radius;   ///< mean distance of the area from its centre [m]
    std::size_t end;   ///< behind its last index
  };
  /// Says where a sample was probed last. It is probed there again first.
  struct Line {
    btVector3 direction{0, 0, 0};  ///< unit, from A to B; 0 if the line met no surfaces
    std::size_t triangle_a = 0;
    std::size_t triangle_b = 0;
  };
  std::vector<std::size_t> indices;  ///< of contacts
  std::vector<Line> lines;           ///< one for each of them, none before the first time
  std::vector<OfPatch> patches;
};

/// Knows the spheres behind a list of contacts.
class ContactSpheres {
 public:
  virtual ~ContactSpheres() = default;
  /// Returns a number of the sphere that is the same from step to step.
  virtual std::uint64_t id(std::size_t index) const = 0;
  /// Says how far a sphere stands out of its solid along `normal` (from A to B), or, where that is known,
  /// towards the other surface. Only differences between spheres of one solid matter [m].
  struct Protrusion {
    bool of_a;
    btScalar distance;
  };
  virtual Protrusion protrusion(std::size_t index, const btVector3& normal) const = 0;
  /// Returns false for a feeler: it overlaps spheres, which tell how large the contact is.
  virtual bool isOfPacking(std::size_t) const { return true; }
};

/// Holds what appendSamples() chooses from.
struct PatchContacts {
  const std::vector<SphereContact>& contacts;
  const std::vector<std::size_t>& indices;  ///< those of the patch
  const PatchMoments& moments;
  const std::vector<std::uint64_t>& old_ids;  ///< of the points of the step before
  const ContactSpheres& spheres;
};

/// Keeps room to work in from one patch to the next.
struct SelectionScratch {
  std::vector<std::size_t> indices;
  std::vector<std::size_t> picked;
};

/// Turns all directions of the samples.
void turn(const btMatrix3x3& by, Samples& samples);

/// Drops the samples without a line: it met no surfaces, or these were too far apart to be probed again.
void dropUnprobed(Samples& samples);

/// Drops contacts that only touch because they were enlarged, and are far less deep than the deepest.
/// `depths` are those of the spheres themselves, negative where they are apart [m]. But a sphere may end as
/// much as `inset` [m] further inside of the surface than the deepest, so what is less deep by that stays;
/// and where bodies move, all that might meet within the step: what is `needed` [m] less deep. `spacing` is
/// that of ContactSettings [m].
void dropShallow(const std::vector<btScalar>& depths, btScalar spacing, btScalar needed, btScalar inset,
                 std::vector<std::size_t>& indices);

/// Appends some contacts of a patch: those of the step before, those that span the patch, those that stand
/// out or face the other body most, and some of the others. It appends all of them if they are few.
void appendSamples(const PatchContacts& from, SelectionScratch& scratch, Samples& samples);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
