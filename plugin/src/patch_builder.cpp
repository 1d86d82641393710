#include "patch_builder.hpp"

#include <algorithm>

#include "innersphere/patch.hpp"
#include "measured_points.hpp"
#include "patch_moments.hpp"
#include "point_selection.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Keeps quotients of zeros finite, at any scale.
constexpr btScalar kTiny = btScalar(1e-30);

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

}  // namespace

void buildContactPatches(const std::vector<SphereContact>& contacts, const Gauge& gauge,
                         const Measure& measure, const btMatrix3x3& reference,
                         std::vector<ContactPatch>& result) {
  static thread_local std::vector<Patch> patches;
  static thread_local std::vector<std::vector<std::size_t>> members;
  static thread_local std::vector<std::uint64_t> old_ids;
  old_ids.clear();
  for (const ContactPatch& old : result) {
    for (int i = 0; i < old.count; ++i) old_ids.push_back(old.points[i].id);
  }
  result.clear();
  const PatchOptions options;
  buildPatches(contacts.data(), contacts.size(), options, patches);
  if (patches.empty()) return;
  if (members.size() < patches.size()) members.resize(patches.size());
  for (std::vector<std::size_t>& m : members) m.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i)
    members[bestPatch(contacts[i], patches, options)].push_back(i);

  static thread_local std::vector<PatchMoments> moments;
  moments.clear();
  for (std::size_t p = 0; p < patches.size(); ++p)
    moments.push_back(patchMoments(contacts, members[p], reference));
  if (measure.on_surfaces) {
    static thread_local std::vector<MeasuredPoint> found;
    found.clear();
    for (std::size_t p = 0; p < patches.size(); ++p) {
      if (moments[p].area > 0)
        measurePoints({contacts, members[p], moments[p], old_ids, gauge, measure}, found);
    }
    selectPatches(found, old_ids, measure.spacing, result);
    if (std::any_of(found.begin(), found.end(), [](const MeasuredPoint& m) { return m.point.depth > 0; }))
      return;
  }
  // Bodies that are deep inside each other have no surface near; their overlap still says which way is out.
  for (const PatchMoments& m : moments) {
    if (!(m.area > 0)) continue;
    ContactPatch patch;
    patch.normal = m.normal;
    patch.centre = m.centre;
    patch.area = m.area;
    pointsFromMoments(m, measure.slack(), measure.spacing, patch);
    if (patch.count > 0) result.push_back(patch);
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
