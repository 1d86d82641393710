#include "surface_contact.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "measure.hpp"
#include "patch_builder.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// The cap that a plane at signed distance `s` from its centre cuts from a ball. The ball is at `centre`, the
/// plane's normal points to the side that is kept out.
SphereContact cap(const Touch& touch, const btVector3& centre, double r) {
  const double s = touch.distance;
  SphereContact contact;
  contact.sphere = touch.sphere;
  if (s <= -r) {
    contact.volume = static_cast<float>(4.0 / 3.0 * M_PI * r * r * r);
    contact.centroid = toFloats(centre);
    return contact;
  }
  const double h = r - s;
  contact.volume = static_cast<float>(M_PI * h * h * (3 * r - h) / 3);
  // The cap's centroid lies 3 (2r - h)^2 / (4 (3r - h)) from the centre of the ball.
  const double offset = 3 * (2 * r - h) * (2 * r - h) / (4 * (3 * r - h));
  contact.centroid = toFloats(centre - touch.normal * btScalar(offset));
  contact.area = toFloats(touch.normal * btScalar(-M_PI * (r * r - s * s)));
  return contact;
}

/// Potential of a cap's volume as a force along its normal: pi (r h^3 / 3 - h^4 / 12), h = r - s; beyond that
/// the volume of the ball is constant.
double capEnergy(double s, double r) {
  const double h = std::min(r - s, 2 * r);
  const double ball = 4.0 / 3.0 * M_PI * r * r * r;
  return M_PI * (r * h * h * h / 3 - h * h * h * h / 12) + ball * std::max(0.0, -s - r);
}

Overlap sumOf(const PackingBody& a, const std::vector<Touch>& touches) {
  Overlap sum;
  btVector3 force(0, 0, 0), torque(0, 0, 0), area(0, 0, 0), moment(0, 0, 0);
  for (const Touch& touch : touches) {
    const btScalar r = a.radiusOf(touch.sphere) + a.margin;
    if (!(touch.distance < r)) continue;
    const btVector3 centre = a.centreOf(touch.sphere);
    const SphereContact contact = cap(touch, centre, r);
    const btVector3 push = touch.normal * btScalar(-contact.volume);
    force += push;
    torque += centre.cross(push);
    area += toBullet(contact.area);
    moment += toBullet(contact.centroid) * btScalar(contact.volume);
    sum.volume += contact.volume;
    sum.stiffness += toBullet(contact.area).length();
    sum.energy += capEnergy(touch.distance, r);
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
    : packing_(packing), other_(other), surface_(makeOtherSurface(other)) {}

const std::vector<ContactPatch>& SurfaceContact::update(const ContactOptions& options,
                                                        const btTransform& packing, const btTransform& other,
                                                        btScalar separation) {
  static thread_local std::vector<Touch> touches;
  static thread_local std::vector<SphereContact> contacts;
  static thread_local Candidates candidates;
  overlap_.reset();
  if (!surface_) return patches_;
  const Measure measure(options, packing_, other_, separation);
  const PackingBody a(packing_, packing, measure.estimator, measure.slack_a, measure.prefix_a);
  touches.clear();
  surface_->touch(a, other, touches);
  const auto caps = [&](btScalar slack) {
    contacts.clear();
    for (const Touch& touch : touches) {
      const btScalar reach = a.radiusOf(touch.sphere) + a.margin + slack;
      if (touch.distance < reach) contacts.push_back(cap(touch, a.centreOf(touch.sphere), reach));
    }
  };
  if (measure.on_surfaces) {
    caps(a.slack);
    assert(contacts.size() == touches.size());  // the gauge counts on it
    const SurfaceGauge gauge(a, touches);
    findCandidates(contacts, gauge, measure.spacing, packing.getBasis(), patches_, candidates);
    if (measurePatches(candidates, gauge, measure, patches_)) return patches_;
    caps(0);
    if (contacts.empty()) return patches_;
  } else {
    caps(0);
    if (options.response == Response::penalty) overlap_ = sumOf(a, touches);
  }
  volumePatches(contacts, measure.spacing, packing.getBasis(), patches_);
  return patches_;
}

const Overlap& SurfaceContact::volumesOf(const ContactOptions& options, const btTransform& packing,
                                         const btTransform& other) {
  static thread_local std::vector<Touch> touches;
  if (overlap_) return *overlap_;
  const PackingBody a(packing_, packing, options.estimator, 0,
                      Measure(options, packing_, other_, 0).prefix_a);
  touches.clear();
  if (surface_) surface_->touch(a, other, touches);
  return overlap_.emplace(sumOf(a, touches));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
