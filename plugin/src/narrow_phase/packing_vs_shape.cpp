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

void SurfaceContact::update(const ContactOptions& options, const btTransform& packing,
                            const btTransform& other, btScalar separation) {
  static thread_local std::vector<SphereContact> contacts;
  std::vector<ContactPatch>& patches = memory_.patches;
  overlap_.reset();
  leeway_ = -1;
  if (!surface_) return;
  const Placed now{packing, other};
  const Measure measure(options, packing_, other_, separation);
  const PackingBody a(packing_, packing, measure.estimator, measure.slack_a, measure.prefix_a);
  if (remember(a, measure, now, separation)) return;
  touches_.clear();
  surface_->touch(a, other, touches_);
  const auto caps = [&](btScalar slack) {
    contacts.clear();
    for (const Touch& touch : touches_) {
      const btScalar reach = a.radiusOf(touch.sphere) + a.margin + slack;
      if (touch.distance < reach)
        contacts.push_back(cap(touch, a.centreOf(touch.sphere) + touch.aside, reach));
    }
  };
  if (measure.on_surfaces) {
    caps(a.slack);
    assert(contacts.size() == touches_.size());  // the gauge counts on it
    const SurfaceGauge gauge(a, *surface_, other, touches_);
    findCandidates(contacts, gauge, measure.spacing, packing.getBasis(), patches, memory_.candidates);
    const bool near = measurePatches(memory_.candidates, gauge, measure, patches);
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
    if (options.response == Response::penalty) overlap_ = sumOf(a, touches_);
  }
  volumePatches(contacts, measure.spacing, packing.getBasis(), patches);
}

bool SurfaceContact::remember(const PackingBody& a, const Measure& measure, const Placed& now,
                              btScalar separation) {
  // Asked in every step: it remembers what it was asked last.
  const bool same = surface_->isAsBefore() && measured_ && measure.on_surfaces &&
                    measure.prefix_a == measured_->prefix_a && measure.spacing == measured_->spacing &&
                    margin_ == a.margin && scale_ == a.scale();
  const std::optional<Measure> before = measured_;
  measured_.reset();
  if (!same) return false;
  const btScalar size_b = other_.isInfinite() ? BT_LARGE_FLOAT : other_.getAngularMotionDisc();
  const ContactMemory::Age age = memory_.ageAt(now, packing_.getAngularMotionDisc(), size_b, separation,
                                               before->separation, measure.spacing, touches_.empty());
  if (age == ContactMemory::Age::stale) return false;
  if (age == ContactMemory::Age::current) {
    memory_.carryTo(now, packing_, measure.spacing);
    if (touches_.empty())
      leeway_ = memory_.leeway(now, packing_.getAngularMotionDisc(), size_b, measure.spacing);
    reach_ = before->separation - ContactMemory::reserve(measure.spacing);
  } else {
    if (!surface_->touchAgain(a, now.b, touches_)) return false;
    memory_.turnTo(now);
    const SurfaceGauge gauge(a, *surface_, now.b, touches_);
    const bool near = measurePatches(memory_.candidates, gauge, *before, memory_.patches);
    const auto cuts = [&](const Touch& touch) {
      return touch.distance < a.radiusOf(touch.sphere) + a.margin;
    };
    if (!near && std::any_of(touches_.begin(), touches_.end(), cuts)) return false;
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
