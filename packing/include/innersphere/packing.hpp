// Declares an inner-sphere packing: the result of packing/ and the input of gpu/.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "innersphere/geometry.hpp"

namespace innersphere {

/// Holds radii that make the first `count` spheres stand for the whole volume of the solid. A sphere's cell
/// is the part of the solid that is nearer to its surface than to any other sphere's. Its volume-true radius
/// is that of a ball with the volume of its cell, a little larger at the surface and a little smaller behind,
/// so that shallow overlaps come out right as well. No sphere is smaller than it was. The balls' volumes sum
/// to the solid's, so neighbouring volume-true spheres overlap a little, and some reach out of the surface.
struct VolumeTrueRadii {
  std::uint32_t count = 0;   ///< The length of the prefix.
  std::vector<float> radii;  ///< The radii [m], `count` of them, in the order of the spheres.
  double sampling_error =
      0;  ///< The standard error of one cell's volume, relative to the mean volume, 0 to 1.
};

/// Tells what the packer guarantees about the fill.
struct Certificate {
  /// Each sphere had at least 1/(1+delta) of the largest radius that was possible when it was placed. 0 means
  /// that nothing is certified (an imported packing).
  double delta = 0;
  /// No sphere larger than this fits any more [m].
  double largest_missing_radius = 0;
};

/// Tells what the first spheres of a packing are chosen for.
enum class SphereOrder {
  radius,   ///< The largest spheres come first: prefixes fill most of the solid.
  coverage  ///< After the first few, spheres come first where the surface is farthest from all before.
};

/// Tells how well the packing fills its solid.
struct Quality {
  double density = 0;   ///< The volume of the spheres over the volume of the solid, 0 to 1.
  double gap_mean = 0;  ///< The mean distance from the surface to the nearest sphere [m].
  double gap_p95 = 0;   ///< The 95th percentile of that distance [m].
  /// The largest of that distance at 50,000 points spread over the surface [m], by which a contact is late.
  /// Between them it may be larger, by as much as the next of them is away.
  double gap_max = 0;
};

/// Tells how near the first spheres of a packing come to the surface. What is far from all of them is not
/// felt by other packings.
struct Coverage {
  std::uint32_t count = 0;  ///< The number of spheres.
  double mean = 0;          ///< The mean distance from the surface to the nearest of them [m].
  double p95 = 0;           ///< The 95th percentile of that distance [m].
  double max = 0;           ///< The largest of it at points spread over the surface [m], as Quality::gap_max.
  Vec3d farthest{};         ///< Where that is [m].
  /// The part of the surface, 0 to 1, that is farther from them than kCoverageDistance.
  double uncovered = 0;
};

/// This is the distance, relative to the diagonal of the solid's bounding box, beyond which a point of the
/// surface counts as not covered.
inline constexpr double kCoverageDistance = 0.01;

/// Tells how far a volume that was found with spheres may be from the truth. The error is relative to the
/// larger of both, |found - true| / max(found, true): from 0 to 1, where both have nothing in common.
/// Relative to the truth it has no finite mean for thin walls, of which some poses find a thousand times too
/// much. If the error is e, the truth lies between found * (1 - e) and found / (1 - e).
struct ExpectedError {
  /// The mean error: a prediction limit, which the mean of as many poses as it was measured in
  /// (kOverlapErrorPoses) exceeds in 1 of 20 cases.
  double mean = 0;
  /// What the error of a single volume exceeds in 1 of 20 cases.
  double bound = 0;
};

/// Returns how deep an overlap is [m]: its volume over its area, which is how thick a layer it would be. At
/// most the cube root of the volume: opposite walls have areas that cancel, but are not deep for that.
double overlapDepth(double volume, const Vec3d& area);

/// Tells how far overlap volumes found with the spheres are from the truth. The packer measures this with the
/// solid and copies of it, unless PackOptions::overlap_errors is off. Of the copies one third is turned at
/// random, one third lies upon the solid but for some degrees and one third has a face flat on a face of it,
/// so that walls lie along walls. They share 0.001 to 45 % of the volume. Spheres err at surfaces, so errors
/// depend on how deep an overlap is, whatever its volume: a layer is as far off as a corner that is as deep.
/// Depth is what the spheres find, not the truth, which a query does not know.
///
/// Copies that share more lie nearly upon the solid. Volume-true spheres, which overlap each other, then find
/// too much, because they meet themselves. So 2 kOverlapErrorPoses more copies, a little turned, moved or
/// both, share 45 to 100 %. Their errors go with what is found, which for these may be more than the solid
/// has. A query finds no more than that: then the error is anything from none to that where the sum has just
/// come down to it, half of which is the mean. For bodies of other shapes that share as much of both they are
/// too large.
///
/// Copies of a thin solid are thin: they do not tell how well its spheres fill what is deep in a thick body.
/// So the solid is also cut by planes, which are as thick as any. And what is small in a large solid may be
/// far from its surface, and as deep as the solid's own copies, but meets fewer of its spheres. So balls are
/// put inside the solid, too.
struct OverlapErrors {
  /// Holds the errors of kOverlapErrorPoses poses, next to each other in depth: a limit of 95 % for the mean
  /// of as many others, from the scatter of the poses of all depths, relative to their mean, and the largest
  /// one, which one more pose exceeds with a probability of 1 / (kOverlapErrorPoses + 1), whatever
  /// the distribution.
  struct AtDepth {
    double depth = 0;     ///< See overlapDepth(), relative to the cube root of the solid's volume.
    ExpectedError error;  ///< The errors there.
    /// The volume of these overlaps, relative to the solid's: the geometric mean.
    double volume = 1;
    /// The power of the volume with which errors fall at this depth, less its standard error: up to 1/2,
    /// where those of all spheres cancel; 0 where all err alike; down to -1/2, where walls lie along walls
    /// and spheres leave them out. From the poses of five depths.
    double power = 0;
  };
  /// Holds the errors with one kind of radii, by rising depth.
  struct Estimate {
    std::vector<AtDepth> copies;  ///< Empty if the spheres find next to nothing.
    /// How thick the lenses of copies are where they are thickest: an overlap's volume over its stiffness,
    /// relative to the cube root of the solid's volume, in the mean of kOverlapErrorPoses poses. Thicker ones
    /// are with the larger spheres of a thick body.
    double thickest = 0;
    /// The errors of the solid cut by planes, times the root of two: the other body's are not smaller. Empty
    /// if the surface is not closed.
    std::vector<AtDepth> planes;
    /// The errors of copies that share or find more than kDeepOverlap of the solid, since they lie nearly
    /// upon it, by the volume that the spheres find in place of the depth. Each is from a
    /// few poses; bounds are as many times the mean as the largest error of any is that of its row. (One row
    /// with a power, of the first files, is for all volumes.) True volumes are sampled if the surface is not
    /// closed or has another volume than the solid, to some percent if it is thin. Empty for the spheres' own
    /// radii, which do not overlap each other.
    std::vector<AtDepth> deep;
    /// The errors of balls inside the solid, times the root of two as those of planes are, by the volume in
    /// place of the depth. Errors beyond the last row fall with the root of the volume, as those of spheres
    /// that know nothing of each other. Empty for the spheres' own radii, and from files that do not know
    /// them: those of copies and planes are then all there is.
    std::vector<AtDepth> inside;
  };
  /// Holds the errors of one prefix.
  struct Prefix {
    std::uint32_t count = 0;  ///< The length of the prefix, one that has volume-true radii.
    Estimate raw;             ///< The errors with the spheres' own radii.
    Estimate volume_true;     ///< The errors with volume-true radii.
  };
  std::uint32_t poses = 0;  ///< The number of copies. 0: nothing was measured.
  /// The least part of the solid's volume that was measured. It is larger if the solid has no closed surface:
  /// true volumes are then sampled.
  double shallowest = 0;
  /// The relative standard error of true volumes: the root of the mean square. 0 where they come from the
  /// surface.
  double sampling_error = 0;
  std::vector<Prefix> prefixes;  ///< The errors by rising count. May be empty.
};

/// The number of poses from which the errors at one depth are found.
inline constexpr std::size_t kOverlapErrorPoses = 19;

/// The part of both solids from which on an overlap may be one of a solid with a copy that lies nearly upon
/// it. Volume-true spheres of one solid overlap each other, and are counted twice where they meet themselves.
inline constexpr double kDeepOverlap = 0.45;

/// Tells where a packing comes from, so that a file can be traced and made again.
struct Provenance {
  std::string source;       ///< The path of the mesh or the name of the solid.
  std::string source_hash;  ///< The hash of the geometry, hexadecimal.
  std::string options;      ///< The options that change the spheres, as a command line.
  std::string version;      ///< The version of InnerSphere that wrote it.
};

/// Holds spheres inside a solid that do not overlap each other, the most important first: the first n of them
/// are a valid, coarser packing. A packing is immutable by convention once made; share it with
/// std::shared_ptr<const Packing>. All places are in the packing's own frame, which is the solid's, moved to
/// `origin`.
struct Packing {
  /// Where the frame of the packing is in the solid's coordinates [m]: x_solid = origin + x. Zero unless the
  /// solid is farther than eight of its sizes away, where single precision would coarsen the spheres.
  Vec3d origin{};
  std::vector<Sphere> spheres;              ///< The spheres, in this order:
  SphereOrder order = SphereOrder::radius;  ///< What the first spheres are chosen for.
  /// The volume-true radii by rising count: 64, 128, 256, ..., spheres.size(). May be empty.
  std::vector<VolumeTrueRadii> volume_true;
  MassProperties solid;     ///< The exact mass properties of the solid, not of the spheres.
  Surface surface;          ///< The surface of the solid. May be empty.
  Certificate certificate;  ///< What the packer guarantees. Its delta is 0 if nothing is certified.
  Quality quality;          ///< How well the spheres fill the solid.
  /// How near prefixes come to the surface, by rising count: 64, 128, 256, ..., spheres.size(). Empty if the
  /// solid has no surface.
  std::vector<Coverage> coverage;
  OverlapErrors overlap_errors;  ///< How far off overlap volumes are. May be empty.
  /// Densities relative to the solid's, one for each sphere. Spheres of these densities have the volume,
  /// centre of mass and inertia of the solid, to 1e-6 of each. Empty if the spheres cannot have them, or if
  /// nothing is known of the solid.
  std::vector<float> mass_weights;
  /// What a user should know, a sentence each, such as parts of the solid that got no sphere.
  std::vector<std::string> warnings;
  Provenance provenance;  ///< Where the packing comes from.
};

/// Returns the stored volume-true radii of the longest prefix that is not longer than `count`, or null if
/// there is none.
const VolumeTrueRadii* volumeTrueRadii(const Packing& packing, std::size_t count);

/// Returns the errors to expect at a depth that is relative to the cube root of the solid's volume. Between
/// two depths of the estimate the logarithms are linear; beyond the first and the last their errors hold.
/// Where lenses have a larger `thickness` than Estimate::thickest, those of planes count if they are smaller,
/// from the depth of the first of them on.
/// Errors are those of overlaps of this `volume`, relative to the solid's, and no smaller than those of balls
/// inside the solid; 0: as large as those measured.
/// Where they are more than kDeepOverlap `of_larger`, the part of the larger of both solids, or than the
/// first of Estimate::deep, if that is less, those of copies that lie nearly upon the solid count instead;
/// NaN if these were not measured.
ExpectedError expectedError(const OverlapErrors::Estimate& estimate, double depth, double thickness = 0,
                            double volume = 0, double of_larger = 0);

/// Returns the coverage of the longest measured prefix that is not longer than `count`, or null if there is
/// none.
const Coverage* coverageOf(const Packing& packing, std::size_t count);

/// Returns a sentence for a user if a twentieth of the surface is farther from the first `count` spheres than
/// a twentieth of the diagonal: thin walls and slender parts without spheres. Volumes leave them out.
/// Empty if not, or if nothing was measured.
std::string bareSurface(const Packing& packing, std::size_t count);

/// Throws Error if a caller could not use the packing: no spheres, non-finite numbers, radii that are not
/// positive or not sorted though the order is SphereOrder::radius, volume-true radii or mass weights of the
/// wrong length, surface triangles without their vertices. It does not look for overlaps; see check.hpp for
/// that.
void validate(const Packing& packing);

}  // namespace innersphere
