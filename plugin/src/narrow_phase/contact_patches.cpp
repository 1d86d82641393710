#include "narrow_phase/contact_patches.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "innersphere/patch.hpp"
#include "narrow_phase/contact_samples.hpp"
#include "narrow_phase/manifold_reduction.hpp"
#include "narrow_phase/patch_moments.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Keeps quotients of zeros finite, at any scale.
constexpr btScalar kTiny = btScalar(1e-30);
/// What there is room for from the start: few pairs have more, and need memory again.
constexpr std::size_t kUsualSamples = 96;
constexpr std::size_t kUsualPatches = 16;

/// The patch whose direction and place a contact fits best.
std::size_t bestPatch(const SphereContact& contact, const std::vector<Patch>& patches,
                      const PatchOptions& options) {
  const btVector3 area = toBullet(contact.area);
  const btVector3 x = toBullet(contact.centroid);
  std::size_t best = 0;
  btScalar best_cost = BT_LARGE_FLOAT;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const Mat3d& c = patches[p].covariance;
    const btScalar extent2 = btScalar(c[0] + c[4] + c[8]) + kTiny;
    const btScalar misfit = 2 * (1 - area.dot(toBullet(patches[p].normal)) / (area.length() + kTiny));
    const btScalar cost = misfit / btScalar(options.max_angle * options.max_angle) +
                          x.distance2(toBullet(patches[p].centroid)) / extent2;
    if (cost < best_cost) {
      best_cost = cost;
      best = p;
    }
  }
  return best;
}

/// The contacts of each patch, as moments and indices. Valid until the next call in the same thread.
struct Sorted {
  Sorted() : members(kUsualPatches) {
    patches.reserve(kUsualPatches);
    moments.reserve(kUsualPatches);
    for (std::vector<std::size_t>& m : members) m.reserve(kUsualSamples);
  }
  std::vector<Patch> patches;
  std::vector<std::vector<std::size_t>> members;
  std::vector<PatchMoments> moments;
};

const Sorted& sortIntoPatches(const std::vector<SphereContact>& contacts, const btMatrix3x3& reference) {
  static thread_local Sorted sorted;
  const PatchOptions options;
  buildPatches(contacts.data(), contacts.size(), options, sorted.patches);
  const std::size_t count = sorted.patches.size();
  if (sorted.members.size() < count) sorted.members.resize(count);
  for (std::vector<std::size_t>& m : sorted.members) m.clear();
  if (count > 0) {
    for (std::size_t i = 0; i < contacts.size(); ++i)
      sorted.members[bestPatch(contacts[i], sorted.patches, options)].push_back(i);
  }
  sorted.moments.clear();
  for (std::size_t p = 0; p < count; ++p)
    sorted.moments.push_back(patchMoments(contacts, sorted.members[p], reference));
  return sorted;
}

/// Where the enlarged spheres of one solid are so large that those of the other vanish in them, their overlap
/// has no direction. The way to the nearest surface takes its place.
const std::vector<SphereContact>& aimed(const std::vector<SphereContact>& contacts,
                                        const SurfaceProbe& probe) {
  static thread_local std::vector<SphereContact> result;
  result = contacts;
  for (std::size_t i = 0; i < result.size(); ++i) {
    btVector3 direction(0, 0, 0);
    OpposedPoints gap;
    probe.nearest(i, direction, gap);
    result[i].area =
        toFloats(direction * btScalar(std::cbrt(contacts[i].volume) * std::cbrt(contacts[i].volume)));
  }
  return result;
}

void collectIds(const std::vector<ContactPatch>& patches, std::vector<std::uint64_t>& ids) {
  ids.clear();
  for (const ContactPatch& patch : patches) {
    for (int i = 0; i < patch.count; ++i) ids.push_back(patch.points[i].id);
  }
}

void appendVolumePatch(const PatchMoments& moments, btScalar spacing, std::vector<ContactPatch>& patches) {
  if (!(moments.area > 0)) return;
  ContactPatch patch;
  patch.normal = moments.normal;
  patch.centre = moments.centre;
  patch.area = moments.area;
  patch.radius = moments.radius;
  pointsFromMoments(moments, spacing, patch);
  if (patch.count > 0) patches.push_back(patch);
}

}  // namespace

void selectSamples(const std::vector<SphereContact>& contacts, const SurfaceProbe& probe, btScalar spacing,
                   const btMatrix3x3& reference, const std::vector<ContactPatch>& patches, Samples& samples) {
  static thread_local std::vector<std::uint64_t> old_ids;
  collectIds(patches, old_ids);
  samples.indices.clear();
  samples.indices.reserve(kUsualSamples);
  samples.lines.clear();
  samples.lines.reserve(kUsualSamples);
  samples.patches.clear();
  samples.patches.reserve(kUsualPatches);
  const Sorted* sorted = &sortIntoPatches(contacts, reference);
  if (sorted->patches.empty() && !contacts.empty())
    sorted = &sortIntoPatches(aimed(contacts, probe), reference);
  for (std::size_t p = 0; p < sorted->moments.size(); ++p) {
    const PatchMoments& moments = sorted->moments[p];
    if (moments.area > 0)
      appendSamples({contacts, sorted->members[p], moments, old_ids, probe, spacing}, samples);
  }
}

bool refinePatches(Samples& samples, const SurfaceProbe& probe, const ContactSettings& measure,
                   std::vector<ContactPatch>& patches) {
  static thread_local std::vector<std::uint64_t> old_ids;
  static thread_local std::vector<WeightedPoint> found;
  collectIds(patches, old_ids);
  found.clear();
  found.reserve(2 * kUsualSamples);
  const bool first_time = samples.lines.empty();
  for (std::size_t p = 0; p < samples.patches.size(); ++p)
    findContactPoints(samples, p, probe, measure.separation, found);
  if (first_time) dropUnprobed(samples);
  keepLeastWaysOut(measure.spacing, found);
  reduceToManifolds(found, old_ids, measure.spacing, patches);
  return std::any_of(found.begin(), found.end(),
                     [&](const WeightedPoint& m) { return m.point.depth > -measure.spacing; });
}

void gradientPatch(const std::vector<SphereContact>& contacts, btScalar spacing, const btMatrix3x3& reference,
                   std::vector<ContactPatch>& patches) {
  static thread_local std::vector<std::size_t> all;
  all.resize(contacts.size());
  std::iota(all.begin(), all.end(), std::size_t(0));
  patches.clear();
  appendVolumePatch(patchMoments(contacts, all, reference), spacing, patches);
}

void volumePatches(const std::vector<SphereContact>& contacts, btScalar spacing, const btMatrix3x3& reference,
                   std::vector<ContactPatch>& patches) {
  patches.clear();
  for (const PatchMoments& m : sortIntoPatches(contacts, reference).moments)
    appendVolumePatch(m, spacing, patches);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
