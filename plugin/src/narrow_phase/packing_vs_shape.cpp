#include "narrow_phase/packing_vs_shape.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "narrow_phase/contact_patches.hpp"
#include "narrow_phase/contact_settings.hpp"

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
    if (!(near_sphere.distance < r)) continue;
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

SurfaceContact::SurfaceContact(const PackingShape& packing, const btCollisionShape& other)
    : packing_(packing), other_(other), surface_(makeShapeSurface(other)) {}

void SurfaceContact::update(const ContactOptions& options, const btTransform& packing,
                            const btTransform& other, btScalar separation) {
  static thread_local std::vector<SphereContact> contacts;
  std::vector<ContactPatch>& patches = memory_.patches;
  overlap_.reset();
  leeway_ = -1;
  if (!surface_) return;
  const Placed now{packing, other};
  const ContactSettings measure(options, packing_, other_, separation);
  const PlacedPacking a(packing_, packing, measure.estimator, measure.search_margin_a, measure.prefix_a);
  if (remember(a, measure, now, separation)) return;
  near_spheres_.clear();
  surface_->findNearSpheres(a, other, near_spheres_);
  const auto caps = [&](btScalar search_margin) {
    contacts.clear();
    for (const NearSphere& near_sphere : near_spheres_) {
      const btScalar reach = a.radiusOf(near_sphere.sphere) + a.margin + search_margin;
      if (near_sphere.distance < reach)
        contacts.push_back(cap(near_sphere, a.centreOf(near_sphere.sphere) + near_sphere.aside, reach));
    }
  };
  if (measure.on_surfaces) {
    caps(a.search_margin);
    assert(contacts.size() == near_spheres_.size());  // the probe counts on it
    const ShapeProbe probe(a, *surface_, other, near_spheres_);
    selectSamples(contacts, probe, measure.spacing, packing.getBasis(), patches, memory_.samples);
    const bool near = refinePatches(memory_.samples, probe, measure, patches);
    if (!near) caps(0);
    if (near || contacts.empty()) {
      memory_.searchedAt(now);
      memory_.measuredAt(now, measure.separation);
      measured_ = measure;
      margin_ = a.margin;
      scale_ = a.scale();
      return;
    }
  } else {
    caps(0);
    if (options.response == Response::penalty) overlap_ = sumOf(a, near_spheres_);
  }
  volumePatches(contacts, measure.spacing, packing.getBasis(), patches);
}

bool SurfaceContact::remember(const PlacedPacking& a, const ContactSettings& measure, const Placed& now,
                              btScalar separation) {
  // Asked in every step: it remembers what it was asked last.
  const bool same = surface_->isAsBefore() && measured_ && measure.on_surfaces &&
                    measure.prefix_a == measured_->prefix_a && measure.spacing == measured_->spacing &&
                    margin_ == a.margin && scale_ == a.scale();
  const std::optional<ContactSettings> before = measured_;
  measured_.reset();
  if (!same) return false;
  const btScalar size_b = other_.isInfinite() ? BT_LARGE_FLOAT : other_.getAngularMotionDisc();
  const ContactTransport::Age age = memory_.ageAt(now, packing_.getAngularMotionDisc(), size_b, separation,
                                                  before->separation, measure.spacing, near_spheres_.empty());
  if (age == ContactTransport::Age::stale) return false;
  if (age == ContactTransport::Age::current) {
    memory_.carryTo(now, packing_, measure.spacing);
    if (near_spheres_.empty())
      leeway_ = memory_.leeway(now, packing_.getAngularMotionDisc(), size_b, measure.spacing);
    reach_ = before->separation - ContactTransport::reserve(measure.spacing);
  } else {
    if (!surface_->updateNearSpheres(a, now.b, near_spheres_)) return false;
    memory_.turnTo(now);
    const ShapeProbe probe(a, *surface_, now.b, near_spheres_);
    const bool near = refinePatches(memory_.samples, probe, *before, memory_.patches);
    const auto cuts = [&](const NearSphere& near_sphere) {
      return near_sphere.distance < a.radiusOf(near_sphere.sphere) + a.margin;
    };
    if (!near && std::any_of(near_spheres_.begin(), near_spheres_.end(), cuts)) return false;
    memory_.measuredAt(now, before->separation);
  }
  measured_ = before;
  return true;
}

bool SurfaceContact::isAsBefore() {
  const bool same = surface_->isAsBefore();
  if (!same) measured_.reset();
  return same;
}

const Overlap& SurfaceContact::volumesOf(const ContactOptions& options, const btTransform& packing,
                                         const btTransform& other) {
  static thread_local std::vector<NearSphere> near_spheres;
  if (overlap_) return *overlap_;
  const PlacedPacking a(packing_, packing, options.estimator, 0,
                        ContactSettings(options, packing_, other_, 0).prefix_a);
  near_spheres.clear();
  if (surface_) surface_->findNearSpheres(a, other, near_spheres);
  return overlap_.emplace(sumOf(a, near_spheres));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
