#include "narrow_phase/packing_vs_shape.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "narrow_phase/contact_patches.hpp"
#include "narrow_phase/contact_settings.hpp"
#include "narrow_phase/one_way_out.hpp"
#include "narrow_phase/sweep.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// The cap that a plane at signed distance `s` from its centre cuts from a ball. The ball is at `centre`, the
/// plane's normal points to the side that is kept out.
SphereContact cap(const NearSphere& near_sphere, const btVector3& centre, double r) {
  const double s = near_sphere.distance;
  SphereContact contact;
  contact.sphere = near_sphere.sphere;
  if (s <= -r) {
    contact.volume = static_cast<float>(4.0 / 3.0 * M_PI * r * r * r);
    contact.centroid = toFloats(centre);
    return contact;
  }
  const double h = r - s;
  contact.volume = static_cast<float>(M_PI * h * h * (3 * r - h) / 3);
  // The cap's centroid lies 3 (2r - h)^2 / (4 (3r - h)) from the centre of the ball.
  const double offset = 3 * (2 * r - h) * (2 * r - h) / (4 * (3 * r - h));
  contact.centroid = toFloats(centre - near_sphere.normal * btScalar(offset));
  contact.area = toFloats(near_sphere.normal * btScalar(-M_PI * (r * r - s * s)));
  return contact;
}

/// Potential of a cap's volume as a force along its normal: pi (r h^3 / 3 - h^4 / 12), h = r - s; beyond that
/// the volume of the ball is constant.
double capEnergy(double s, double r) {
  const double h = std::min(r - s, 2 * r);
  const double ball = 4.0 / 3.0 * M_PI * r * r * r;
  return M_PI * (r * h * h * h / 3 - h * h * h * h / 12) + ball * std::max(0.0, -s - r);
}

Overlap sumOf(const PlacedPacking& a, const std::vector<NearSphere>& near_spheres) {
  Overlap sum;
  btVector3 force(0, 0, 0), torque(0, 0, 0), area(0, 0, 0), moment(0, 0, 0);
  for (const NearSphere& near_sphere : near_spheres) {
    const btScalar r = a.radiusOf(near_sphere.sphere) + a.margin;
    if (!(near_sphere.distance < r) || a.isFeeler(near_sphere.sphere)) continue;
    const btVector3 centre = a.centreOf(near_sphere.sphere);
    const SphereContact contact = cap(near_sphere, centre, r);
    const btVector3 push = near_sphere.normal * btScalar(-contact.volume);
    force += push;
    torque += centre.cross(push);
    area += toBullet(contact.area);
    moment += toBullet(contact.centroid) * btScalar(contact.volume);
    sum.volume += contact.volume;
    sum.stiffness += toBullet(contact.area).length();
    sum.energy += capEnergy(near_sphere.distance, r);
    ++sum.pair_count;
  }
  sum.force = toDoubles(force);
  sum.torque = toDoubles(torque);
  sum.area = toDoubles(area);
  if (sum.volume > 0) sum.centroid = toDoubles(moment / btScalar(sum.volume));
  return sum;
}

}  // namespace

PackingVsShape::PackingVsShape(const PackingShape& packing, const btCollisionShape& other)
    : packing_(packing), other_(other), surface_(makeShapeSurface(other)) {}

void PackingVsShape::search(const ContactOptions& options, const Placed& now, const StepAhead& step) {
  Sweep sweep(packing_, other_, now, step);
  do {
    searchAt(sweep.placed(), options, sweep.ahead());
  } while (isKnown() && settings->on_surfaces && sweep.goesOn(memory.patches));
  sweep.finish(memory.patches);
}

void PackingVsShape::searchAt(const Placed& now, const ContactOptions& options, const StepAhead& step) {
  static thread_local std::vector<SphereContact> contacts;
  forget();
  overlap_.reset();
  if (!surface_) {
    memory.drop();
    return;
  }
  const ContactSettings measure(options, packing_, other_, step.needed);
  PlacedPacking a(packing_, now.a, measure.estimator, measure.search_margin_a, measure.prefix_a);
  if (measure.on_surfaces) a.addFeelers();
  near_spheres_.clear();
  surface_->findNearSpheres(a, now.b, near_spheres_);
  if (measure.on_surfaces) {
    leaveByOneSide(a, *surface_, now.b, memory.patches, measure.inset_a, near_spheres_);
    dropFeelersThrough(a);
  }
  releaseIfEmpty(near_spheres_);
  on_surfaces = measure.on_surfaces;
  if (measure.on_surfaces) {
    searchCapsOf(a, contacts);
    assert(contacts.size() == near_spheres_.size());  // the probe counts on it
    const ShapeProbe probe(a, *surface_, now.b, near_spheres_);
    selectSamples(contacts, probe, measure, step, now.a.getBasis(), memory.patches, memory.samples);
    const bool near = refinePatches(memory.samples, probe, measure, step, memory.patches);
    // Spheres that overlap where no surface is near: the packing is too deep for them.
    if (!near) volumeCapsOf(a, contacts);
    on_surfaces = near || contacts.empty();
  } else {
    volumeCapsOf(a, contacts);
    if (options.response == Response::penalty) overlap_ = sumOf(a, near_spheres_);
  }
  if (!on_surfaces) volumePatches(contacts, measure.spacing, now.a.getBasis(), memory.patches);
  memory.noteSearch(now);
  memory.noteDepths(now, measure.separation);
  settings = measure;
}

void PackingVsShape::dropFeelersThrough(const PlacedPacking& a) {
  static thread_local std::vector<const NearSphere*> nearest;
  const auto isInside = [&](const NearSphere& n) { return a.isFeeler(n.sphere) && n.distance < 0; };
  if (std::none_of(near_spheres_.begin(), near_spheres_.end(), isInside)) return;
  findNearestOfEach(a, near_spheres_, nearest);
  std::vector<NearSphere> kept;
  kept.reserve(near_spheres_.size());
  for (const NearSphere& n : near_spheres_) {
    const NearSphere* const beside = isInside(n) ? nearest[a.sphereBeside(n.sphere)] : nullptr;
    if (beside == nullptr || beside->normal.dot(n.normal) > 0) kept.push_back(n);
  }
  near_spheres_ = std::move(kept);
}

void PackingVsShape::searchCapsOf(const PlacedPacking& a, std::vector<SphereContact>& caps) const {
  caps.clear();
  for (const NearSphere& near_sphere : near_spheres_)
    caps.push_back(cap(near_sphere, a.centreOf(near_sphere.sphere) + near_sphere.aside,
                       a.searchRadius(near_sphere.sphere)));
}

void PackingVsShape::volumeCapsOf(const PlacedPacking& a, std::vector<SphereContact>& caps) const {
  caps.clear();
  for (const NearSphere& near_sphere : near_spheres_) {
    const btScalar reach = a.radiusOf(near_sphere.sphere) + a.margin;
    if (near_sphere.distance < reach && !a.isFeeler(near_sphere.sphere))
      caps.push_back(cap(near_sphere, a.centreOf(near_sphere.sphere) + near_sphere.aside, reach));
  }
}

bool PackingVsShape::hasSameShapes() {
  const bool same = surface_ && surface_->isAsBefore();
  if (!same) forget();
  return same;
}

bool PackingVsShape::refine(const Placed& now, const StepAhead& step) {
  const btScalar separation = btMax(settings->spacing, step.needed + kSearchAgain * settings->spacing);
  PlacedPacking a(packing_, now.a, settings->estimator, separation + settings->inset_a, settings->prefix_a);
  if (settings->on_surfaces) a.addFeelers();
  if (!surface_->updateNearSpheres(a, now.b, near_spheres_)) return false;
  memory.turnTo(now);
  if (settings->on_surfaces)
    leaveByOneSide(a, *surface_, now.b, memory.patches, settings->inset_a, near_spheres_);
  const ShapeProbe probe(a, *surface_, now.b, near_spheres_);
  const bool near = refinePatches(memory.samples, probe, *settings, step, memory.patches);
  const auto cuts = [&](const NearSphere& near_sphere) {
    return !a.isFeeler(near_sphere.sphere) &&
           near_sphere.distance < a.radiusOf(near_sphere.sphere) + a.margin;
  };
  if (!near && std::any_of(near_spheres_.begin(), near_spheres_.end(), cuts)) return false;
  memory.noteDepths(now, settings->separation);
  return true;
}

Overlap PackingVsShape::volumesAt(const ContactOptions& options, const Placed& now) const {
  static thread_local std::vector<NearSphere> near_spheres;
  const PlacedPacking a(packing_, now.a, options.estimator, 0,
                        ContactSettings(options, packing_, other_, 0).prefix_a);
  near_spheres.clear();
  if (surface_) surface_->findNearSpheres(a, now.b, near_spheres);
  return sumOf(a, near_spheres);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
