// An inner-sphere packing: the result of packing/ and the input of gpu/.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "innersphere/geometry.hpp"

namespace innersphere {

/// Radii that make the first `count` spheres stand for the whole volume of the solid. A sphere's share is the
/// volume of the solid that is nearer to its surface than to any other sphere's; its volume-true radius is
/// that of a ball with the volume of its share, a little larger at the surface and a little smaller behind,
/// so that shallow overlaps come out right as well. No sphere is smaller than it was. The balls' volumes sum
/// to the solid's, so neighbouring volume-true spheres overlap a little, and some reach out of the surface.
struct VolumeTrueRadii {
  std::uint32_t count = 0;    ///< length of the prefix
  std::vector<float> radii;   ///< [m], `count` of them, in the order of the spheres
  double sampling_error = 0;  ///< standard error of one share relative to the mean share, 0 to 1
};

/// What the packer guarantees about the fill.
struct Certificate {
  /// Each sphere had at least 1/(1+delta) of the largest radius that was possible when it was placed. 0 means
  /// that nothing is certified (an imported packing).
  double delta = 0;
  /// No sphere larger than this fits any more [m].
  double largest_missing_radius = 0;
};

/// How well the packing fills its solid.
struct Quality {
  double density = 0;   ///< volume of the spheres over volume of the solid, 0 to 1
  double gap_mean = 0;  ///< distance from the surface to the nearest sphere [m]: mean over the surface
  double gap_p95 = 0;   ///< 95th percentile [m]
  double gap_max = 0;   ///< largest sampled distance [m]: the covering radius, what a contact is late by
};

/// Depths of overlaps, as volumes relative to the solid's: errors are given for what lies between two of
/// these.
inline constexpr std::array<double, 5> kOverlapBins{0, 0.01, 0.05, 0.15, 1};

/// How far overlap volumes found with the spheres are from the truth: measured by the packer with the solid
/// and copies of it at different places, 0.2 % to 45 % of its volume deep. Arrays have a number for each bin
/// of kOverlapBins.
struct OverlapErrors {
  /// The errors of one prefix.
  struct Prefix {
    std::uint32_t count = 0;              ///< the first spheres, as many as there are volume-true radii for
    std::array<double, 4> raw{};          ///< mean of |relative error| with the spheres' own radii
    std::array<double, 4> volume_true{};  ///< and with volume-true radii
  };
  std::array<std::uint32_t, 4> poses{};    ///< number of copies
  std::array<double, 4> sampling_error{};  ///< relative standard error of a true volume: it is sampled, too
  std::vector<Prefix> prefixes;            ///< by rising count; may be empty
};

/// Where a packing comes from, so that a file can be traced and made again.
struct Provenance {
  std::string source;       ///< path of the mesh or name of the solid
  std::string source_hash;  ///< hash of the geometry, hexadecimal
  std::string options;      ///< the options that change the result, as a command line
  std::string version;      ///< version of InnerSphere that wrote it
};

/// Spheres inside a solid that do not overlap each other, sorted by falling radius: the first n of them are a
/// valid, coarser packing. Immutable by convention once made; share it with std::shared_ptr<const Packing>.
/// All places are in the packing's own frame, which is the solid's, moved to `origin`.
struct Packing {
  /// Where the frame of the packing is in the solid's coordinates [m]: x_solid = origin + x. Zero unless the
  /// solid is farther than eight of its sizes away, where single precision would coarsen the spheres.
  Vec3d origin{};
  std::vector<Sphere> spheres;  ///< by falling radius
  std::vector<VolumeTrueRadii>
      volume_true;               ///< by rising count: 64, 128, 256, ..., spheres.size(); may be empty
  MassProperties solid;          ///< exact, of the solid, not of the spheres
  Surface surface;               ///< of the solid; may be empty
  Certificate certificate;       ///< what the packer guarantees; delta 0 where nothing is certified
  Quality quality;               ///< how well the spheres fill the solid
  OverlapErrors overlap_errors;  ///< how far off overlap volumes are; may be empty
  /// Densities relative to the solid's, one for each sphere: spheres of these densities have the volume,
  /// centre of mass and inertia of the solid, to 1e-6 of each. Empty if the spheres cannot have them, or
  /// nothing is known of the solid.
  std::vector<float> mass_weights;
  /// What a user should know, a sentence each: parts of the solid that got no sphere, ...
  std::vector<std::string> warnings;
  Provenance provenance;  ///< where the packing comes from
};

/// The stored volume-true radii of the longest prefix that is not longer than `count`, or null if there is
/// none.
const VolumeTrueRadii* volumeTrueRadii(const Packing& packing, std::size_t count);

/// Throws Error if a caller could not use the packing: no spheres, non-finite numbers, radii that are not
/// positive or not sorted, volume-true radii or mass weights of the wrong length, surface triangles without
/// their vertices.
/// Does not look for overlaps; see check.hpp for that.
void validate(const Packing& packing);

}  // namespace innersphere
