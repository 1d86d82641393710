#include "narrow_phase/contact_patches.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <type_traits>

#include "innersphere/patch.hpp"
#include "narrow_phase/contact_samples.hpp"
#include "narrow_phase/deepest_points.hpp"
#include "narrow_phase/manifold_reduction.hpp"
#include "narrow_phase/passing.hpp"
#include "narrow_phase/patch_moments.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Keeps quotients of zeros finite, at any scale.
constexpr btScalar kTiny = btScalar(1e-30);
/// What there is room for from the start: few pairs have more, and need memory again.
constexpr std::size_t kUsualSamples = 96;
constexpr std::size_t kUsualPatches = 16;

/// The contacts of each patch, as moments and indices.
struct SortedContacts {
  SortedContacts() : members(kUsualPatches) {
    patches.reserve(kUsualPatches);
    moments.reserve(kUsualPatches);
    for (std::vector<std::size_t>& m : members) m.reserve(kUsualSamples);
  }
  std::vector<Patch> patches;
  std::vector<std::vector<std::size_t>> members;
  std::vector<PatchMoments> moments;
};

/// All the memory that the geometry of one pair works in.
struct Scratch {
  Scratch() { found.reserve(2 * kUsualSamples); }
  SortedContacts sorted;
  std::vector<SphereContact> aimed;
  std::vector<btScalar> depths;
  std::vector<std::size_t> indices;
  std::vector<std::uint64_t> old_ids;
  std::vector<ContactPoint> old_points;
  std::vector<Top> tops;
  SelectionScratch selection;
  SampleScratch sampling;
  std::vector<WeightedPoint> found;
  ReductionScratch reduction;
};

/// Each thread has its own. No two pairs use it at once: while a thread waits for others it takes on no work
/// but theirs, see inParallel.
Scratch& scratchOfThread() {
  static thread_local Scratch scratch;
  return scratch;
}

/// The patch whose direction and place a contact fits best.
std::size_t bestPatch(const SphereContact& contact, const std::vector<Patch>& patches,
                      const PatchOptions& options) {
  if (patches.size() == 1) return 0;
  const btVector3 area = toBullet(contact.area);
  const btVector3 x = toBullet(contact.centroid);
  const btScalar length = area.length() + kTiny;
  std::size_t best = 0;
  btScalar best_cost = BT_LARGE_FLOAT;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const Mat3d& c = patches[p].covariance;
    const btScalar extent2 = btScalar(c[0] + c[4] + c[8]) + kTiny;
    const btScalar misfit = 2 * (1 - area.dot(toBullet(patches[p].normal)) / length);
    const btScalar cost = misfit / btScalar(options.max_angle * options.max_angle) +
                          x.distance2(toBullet(patches[p].centroid)) / extent2;
    if (cost < best_cost) {
      best_cost = cost;
      best = p;
    }
  }
  return best;
}

void sortIntoPatches(const std::vector<SphereContact>& contacts, SortedContacts& sorted) {
  const PatchOptions options;
  buildPatches(contacts.data(), contacts.size(), options, sorted.patches);
  const std::size_t count = sorted.patches.size();
  if (sorted.members.size() < count) sorted.members.resize(count);
  for (std::vector<std::size_t>& m : sorted.members) m.clear();
  if (count > 0) {
    for (std::size_t i = 0; i < contacts.size(); ++i)
      sorted.members[bestPatch(contacts[i], sorted.patches, options)].push_back(i);
  }
}

void measure(const std::vector<SphereContact>& contacts, const btMatrix3x3& reference,
             SortedContacts& sorted) {
  sorted.moments.clear();
  for (std::size_t p = 0; p < sorted.patches.size(); ++p)
    sorted.moments.push_back(patchMoments(contacts, sorted.members[p], reference));
}

bool hasDirection(const SphereContact& contact) {
  return !toBullet(contact.area).isZero();
}

/// Whether most of what overlaps, by volume, has no direction.
bool lacksDirection(const std::vector<SphereContact>& contacts) {
  double with = 0, without = 0;
  for (const SphereContact& contact : contacts) (hasDirection(contact) ? with : without) += contact.volume;
  return without > with;
}

/// Where the enlarged spheres of one solid are so large that those of the other vanish in them, their overlap
/// has no direction. The way to the nearest surface takes its place.
void aimAtSurface(const std::vector<SphereContact>& contacts, const SurfaceProbe& probe,
                  std::vector<SphereContact>& aimed) {
  aimed = contacts;
  for (std::size_t i = 0; i < aimed.size(); ++i) {
    if (hasDirection(aimed[i])) continue;
    btVector3 direction(0, 0, 0);
    OpposedPoints points;
    probe.nearest(i, direction, points);
    aimed[i].area =
        toFloats(direction * btScalar(std::cbrt(contacts[i].volume) * std::cbrt(contacts[i].volume)));
  }
}

/// Where there are spheres of the packing, they alone say where and how large a patch is.
void measureByPacking(const std::vector<SphereContact>& contacts, const ContactSpheres& spheres,
                      const btMatrix3x3& reference, std::vector<std::size_t>& indices,
                      SortedContacts& sorted) {
  sorted.moments.clear();
  for (std::size_t p = 0; p < sorted.patches.size(); ++p) {
    const std::vector<std::size_t>& members = sorted.members[p];
    indices.clear();
    std::copy_if(members.begin(), members.end(), std::back_inserter(indices),
                 [&](std::size_t i) { return spheres.isOfPacking(i); });
    PatchMoments moments;
    if (!indices.empty()) moments = patchMoments(contacts, indices, reference);
    if (!(moments.area > 0)) moments = patchMoments(contacts, members, reference);
    sorted.moments.push_back(moments);
  }
}

void collectIds(const std::vector<ContactPatch>& patches, std::vector<std::uint64_t>& ids) {
  ids.clear();
  for (const ContactPatch& patch : patches) {
    for (int i = 0; i < patch.count; ++i) ids.push_back(patch.points[i].id);
  }
}

void collectPoints(const std::vector<ContactPatch>& patches, std::vector<ContactPoint>& points) {
  points.clear();
  for (const ContactPatch& patch : patches)
    points.insert(points.end(), patch.points.begin(), patch.points.begin() + patch.count);
}

void clear(Samples& samples) {
  samples.indices.clear();
  samples.lines.clear();
  samples.patches.clear();
}

void makeRoom(Samples& samples) {
  samples.indices.reserve(kUsualSamples);
  samples.lines.reserve(kUsualSamples);
  samples.patches.reserve(kUsualPatches);
}

/// filter(indices) drops contacts of a patch that are not worth probing.
template <typename Probe, typename Filter>
void selectFiltered(const std::vector<SphereContact>& contacts, const Probe& probe,
                    const btMatrix3x3& reference, const std::vector<ContactPatch>& patches,
                    const Filter& filter, Samples& samples) {
  Scratch& scratch = scratchOfThread();
  collectIds(patches, scratch.old_ids);
  clear(samples);
  // Most pairs of a pile are apart, and take no memory.
  if (!contacts.empty()) makeRoom(samples);
  if (lacksDirection(contacts)) {
    aimAtSurface(contacts, probe, scratch.aimed);
    sortIntoPatches(scratch.aimed, scratch.sorted);
    measure(scratch.aimed, reference, scratch.sorted);
  } else {
    sortIntoPatches(contacts, scratch.sorted);
    measureByPacking(contacts, probe, reference, scratch.indices, scratch.sorted);
  }
  for (std::size_t p = 0; p < scratch.sorted.moments.size(); ++p) {
    const PatchMoments& moments = scratch.sorted.moments[p];
    if (!(moments.area > 0)) continue;
    scratch.indices = scratch.sorted.members[p];
    filter(scratch.indices);
    appendSamples({contacts, scratch.indices, moments, scratch.old_ids, probe}, scratch.selection, samples);
  }
}

template <typename Probe>
bool refine(Samples& samples, const Probe& probe, const ContactSettings& settings, const StepAhead& step,
            std::vector<ContactPatch>& patches) {
  Scratch& scratch = scratchOfThread();
  std::vector<WeightedPoint>& found = scratch.found;
  collectIds(patches, scratch.old_ids);
  scratch.tops.clear();
  // Bullet's curved shapes have no triangles that make several tops of one, and fast bodies have left theirs
  // behind.
  if (std::is_same_v<Probe, PackingProbe> && !step.motion.isSwept()) {
    collectPoints(patches, scratch.old_points);
    ascendAgain({probe, samples.indices, scratch.sampling.line_starts}, settings.separation,
                scratch.old_points, scratch.tops);
  }
  found.clear();
  const ContactReach reach{settings.separation, step.motion.spin() * step.time_step};
  const bool first_time = samples.lines.empty();
  for (std::size_t p = 0; p < samples.patches.size(); ++p)
    findContactPoints(probe, p, reach, scratch.tops, samples, scratch.sampling, found);
  if (first_time) dropUnprobed(samples);
  const bool near = std::any_of(found.begin(), found.end(),
                                [&](const WeightedPoint& p) { return p.point.depth > -settings.spacing; });
  dropBeyondEnds(found);
  dropPassing(probe, step, found);
  keepLeastWaysOut(settings.spacing, scratch.reduction, found);
  keepTops(settings.separation, step, found);
  reduceToManifolds(found, scratch.old_ids, settings.spacing, step, scratch.reduction, patches);
  return near;
}

void appendVolumePatch(const PatchMoments& moments, btScalar spacing, std::vector<ContactPatch>& patches) {
  if (!(moments.area > 0)) return;
  ContactPatch patch;
  patch.normal = moments.normal;
  patch.centre = moments.centre;
  patch.area = moments.area;
  patch.radius = moments.radius;
  patch.by_volume = true;
  pointsFromMoments(moments, spacing, patch);
  if (patch.count > 0) patches.push_back(patch);
}

}  // namespace

void selectSamples(const std::vector<SphereContact>& contacts, const PackingProbe& probe,
                   const btMatrix3x3& reference, const std::vector<ContactPatch>& patches, Samples& samples) {
  selectFiltered(
      contacts, probe, reference, patches, [](std::vector<std::size_t>&) {}, samples);
}

void selectSamples(const std::vector<SphereContact>& contacts, const ShapeProbe& probe,
                   const ContactSettings& settings, const StepAhead& step, const btMatrix3x3& reference,
                   const std::vector<ContactPatch>& patches, Samples& samples) {
  std::vector<btScalar>& depths = scratchOfThread().depths;
  depths.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) depths.push_back(probe.depth(i));
  const auto filter = [&](std::vector<std::size_t>& indices) {
    dropShallow(depths, settings.spacing, step.needed, settings.inset_a, indices);
  };
  selectFiltered(contacts, probe, reference, patches, filter, samples);
}

bool refinePatches(Samples& samples, const PackingProbe& probe, const ContactSettings& settings,
                   const StepAhead& step, std::vector<ContactPatch>& patches) {
  return refine(samples, probe, settings, step, patches);
}

bool refinePatches(Samples& samples, const ShapeProbe& probe, const ContactSettings& settings,
                   const StepAhead& step, std::vector<ContactPatch>& patches) {
  return refine(samples, probe, settings, step, patches);
}

void wayOutPatch(const OverlappingPackings& packings, const btVector3& before, btScalar spacing,
                 const StepAhead& step, std::vector<ContactPatch>& patches) {
  Scratch& scratch = scratchOfThread();
  collectIds(patches, scratch.old_ids);
  findWayOut(packings, patches, before, scratch.found);
  reduceToManifolds(scratch.found, scratch.old_ids, spacing, step, scratch.reduction, patches);
}

void volumePatches(const std::vector<SphereContact>& contacts, btScalar spacing, const btMatrix3x3& reference,
                   std::vector<ContactPatch>& patches) {
  SortedContacts& sorted = scratchOfThread().sorted;
  patches.clear();
  sortIntoPatches(contacts, sorted);
  measure(contacts, reference, sorted);
  for (const PatchMoments& m : sorted.moments) appendVolumePatch(m, spacing, patches);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
