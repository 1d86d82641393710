#include "response/contact_law.hpp"

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "common/squeeze.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Default stiffness in units of m / dt^2, and damping as a multiple of critical damping. Stiffer, a hanging
/// chain of 20 never rests, less damped, a stack sways: ten iterations of Bullet's solver do not bring all
/// contacts to rest. Softer, chains sink into each other and give back more energy
/// (tests/benchmarks/results/contact-law.md).
constexpr btScalar kStiffness = 18, kDamping = 4;
/// Depth at which that stiffness has doubled, in sizes of the smaller body: what carries many times its own
/// mass needs more than what lies still.
constexpr btScalar kStiffening = btScalar(0.002);
/// The same in a chain, where what all links do together is changed by ten iterations by a fifth only: a
/// start from the last impulse lags behind the motion and drives it on. A spring that is stiffer by kHeavy
/// bears several links, and the solver starts with what it bears now. Then the law must not be steeper than
/// this for links to come to rest, nor much less, or they sag.
constexpr btScalar kChainStiffness = 31, kChainStiffening = btScalar(0.005), kHeavy = btScalar(1.5);
/// Fastest push, in sizes of the body per second.
constexpr btScalar kFastest = btScalar(0.5);
/// The same in depths per second, for bodies that are deeper in each other than that: they leave at a speed
/// that falls with their depth, and a body that is as deep as it is large is apart after (1 + ln 6) / 3 =
/// 0.93 s. A depth by volume is no way to go, and does not count.
constexpr btScalar kLeaving = 3;

/// How far ahead of bodies that roll their load lies, in sizes of the smaller one: a fiftieth of what it does
/// for steel on steel. Enough to lie still on slopes of a micrometre, which measured surfaces have.
constexpr btScalar kRolling = btScalar(1e-5);
/// Points this near to a line, in lengths of it, are on it.
constexpr btScalar kOnLine = btScalar(0.02);

/// Whether bodies that touch in the points of patches could roll on these: they lie on a line.
bool canRollOn(const ContactPatch* patches, std::size_t patch_count) {
  btVector3 first(0, 0, 0), along(0, 0, 0);
  int count = 0;
  for (const ContactPatch* patch = patches; patch != patches + patch_count; ++patch) {
    for (int i = 0; i < patch->count; ++i) {
      const ContactPoint& point = patch->points[i];
      if (!(point.depth > 0)) continue;
      const btVector3 way = point.on_b - first;
      if (count == 0) first = point.on_b;
      if (count == 1) along = way;
      if (count > 1 && along.cross(way).length() > kOnLine * along.length2()) return false;
      ++count;
    }
  }
  return true;
}

/// Whether bodies touch in one round place.
bool isRound(const std::vector<ContactPatch>& patches) {
  if (patches.size() != 1 || patches[0].count != 1) return false;
  const ContactPoint& point = patches[0].points[0];
  return point.bend_a.mean() != 0 && point.bend_b.mean() != 0;
}

/// Whether a solver may move it. Parts of a multi-body may move though they have no mass themselves.
bool canBeMoved(const btCollisionObject& object) {
  const btMultiBodyLinkCollider* collider = btMultiBodyLinkCollider::upcast(&object);
  if (collider == nullptr) return inverseMass(object) > 0;
  return !object.isStaticOrKinematicObject() &&
         (collider->m_link >= 0 || !collider->m_multiBody->hasFixedBase());
}

/// The share of the push that is left to a patch by those that press against it.
btScalar pushLeft(const ContactPatch& patch, const std::vector<ContactPatch>& patches) {
  btScalar left = 1;
  if (patch.by_volume || !(patch.depth() > 0)) return left;
  for (const ContactPatch& other : patches)
    if (!other.by_volume)
      left = btMin(left, Squeeze::push(patch.depth(), patch.normal, other.depth(), other.normal));
  return left;
}

/// The speed at which bodies leave along `normal`, if they leave along the deepest of their patches [m/s]:
/// those of several directions must not add up.
btScalar leavingAlong(const btVector3& normal, const std::vector<ContactPatch>& patches) {
  btScalar deepest = 0, speed = 0;
  for (const ContactPatch& patch : patches) {
    if (patch.by_volume || !(patch.depth() > deepest)) continue;
    deepest = patch.depth();
    speed = kLeaving * deepest * btMax(btScalar(0), patch.normal.dot(normal));
  }
  return speed;
}

}  // namespace

ContactLaw::ContactLaw(const ContactOptions& options, btScalar reduced_mass, btScalar time_step,
                       btScalar size, const SolverSettings& solver, bool of_links, bool solved)
    : response_(options.response),
      given_stiffness_(btScalar(options.stiffness)),
      damping_ratio_(btScalar(options.damping)),
      mass_(reduced_mass > 0 ? reduced_mass : btScalar(1)),
      time_step_(time_step > 0 ? time_step : btScalar(1) / 60),
      size_(size),
      solver_(solver),
      of_links_(of_links),
      solved_(solved) {
  if (defaultSpring()) damping_ratio_ *= kDamping;
  if (!penalty()) return;
  damping_ratio_ = 1;  // the points' own restitution has a say in it
  if (given_stiffness_ == 0) given_stiffness_ = mass_ / (time_step_ * time_step_ * SIMD_PI * size * size);
}

ContactLaw::OfPatch ContactLaw::of(const std::vector<ContactPatch>& patches, std::size_t index) const {
  const ContactPatch& patch = patches[index];
  btScalar area = 0;
  for (const ContactPatch& other : patches)
    area += other.area * btMax(btScalar(0), patch.normal.dot(other.normal));
  const bool in_chain = of_links_ && isRound(patches);
  const btScalar stiffness =
      defaultSpring() ? (in_chain ? kChainStiffness : kStiffness) * mass_ / (time_step_ * time_step_)
                      : given_stiffness_ * area;
  const btScalar share = area > 0 ? patch.area / (area * btScalar(patch.count)) : btScalar(0);
  OfPatch law;
  law.law_ = this;
  law.in_chain_ = in_chain;
  law.stiffness_ = stiffness * share;
  law.damping_ = damping_ratio_ * 2 * btSqrt(stiffness * mass_) * share;
  law.leaving_ = patch.by_volume ? btScalar(0) : leavingAlong(patch.normal, patches);
  law.rolling_ = canRollOn(&patch, 1) ? kRolling * size_ : btScalar(0);
  law.rocks_ = canRollOn(patches.data(), patches.size());
  law.push_left_ = pushLeft(patch, patches);
  return law;
}

PointLaw ContactLaw::OfPatch::at(btScalar depth) const {
  PointLaw law;
  law.depth = depth;
  law.time_step = law_->time_step_;
  law.solved = law_->solved_;
  if (!law.solved) return law;
  law.rolling = rolling_;
  law.rocks = rocks_;
  const bool given = law_->response_ == Response::compliant && !law_->defaultSpring();
  if (law_->solver_.substeps && !law_->penalty()) {
    law.spring = given;
    law.stiffness = stiffness_;
    law.damping = damping_;
    return law;
  }
  const btScalar unseen = SubstepOptions().depth * law_->size_;
  if (push_left_ < 1 && depth > unseen && !given && !law_->penalty())
    law.friction = Squeeze::friction(depth, unseen);
  const btScalar fastest = push_left_ * btMax(kFastest * law_->size_, btMin(leaving_, kLeaving * depth));
  if (law_->response_ == Response::rigid) {
    if (!(depth > law_->solver_.deepest_push))
      law.depth = btMin(depth, fastest * law.time_step / law_->solver_.erp);
    return law;
  }
  law.stiffness = stiffness_;
  law.damping = damping_;
  law.penalty = law_->penalty();
  if (law.penalty) return law;
  law.spring = true;
  // Fraction of the depth that the solver removes in a second.
  const auto rate = [&] {
    const btScalar spring = law_->time_step_ * law.stiffness;
    return spring > 0 ? spring / (spring + law.damping) / law_->time_step_ : btScalar(0);
  };
  if (law_->defaultSpring()) {
    const auto hold = [&] {
      if (law.depth * rate() > fastest) law.depth = fastest / rate();
    };
    law.depth = btMin(depth, law_->solver_.deepest_spring);
    hold();
    // What is held back must not be softer: under a load that it cannot bear it would sink on and on. That
    // does not go for walls on both sides of what is deep in both: they would be pressed on it.
    const btScalar bearing = btMax(law.depth, btMin(depth, leaving_ / kLeaving));
    const btScalar doubled = (in_chain_ ? kChainStiffening : kStiffening) * law_->size_;
    const btScalar stiffening = 1 + btMax(bearing, btScalar(0)) / doubled;
    law.stiffness *= stiffening;
    law.damping *= btSqrt(stiffening);
    hold();
    const bool heavy = in_chain_ && stiffening > kHeavy;
    law.starts = heavy && law.depth == depth;
    law.tilting = heavy ? law_->size_ : btScalar(0);
  } else if (depth > law_->solver_.deepest_spring) {
    // The same force from a smaller depth.
    law.stiffness *= depth / law_->solver_.deepest_spring;
    law.depth = law_->solver_.deepest_spring;
  }
  law.push = btMax(law.depth, btScalar(0)) * rate();
  law.held_back = law.depth != depth;
  law.bears = law_->time_step_ * law.stiffness * btMax(law.depth, btScalar(0));
  return law;
}

btScalar ContactLaw::OfPatch::slipUndoneBy(btScalar impulse) const {
  const btScalar undone = law_->solver_.friction_erp;
  return undone > 0 ? impulse * law_->time_step_ / (undone * law_->mass_) : btScalar(0);
}

btScalar depthAtRest(const btCollisionObject& object, btScalar time_step) {
  const btRigidBody* body = btRigidBody::upcast(&object);
  const bool falls = body != nullptr && !body->isStaticOrKinematicObject();
  return falls ? body->getGravity().length() * time_step * time_step / kStiffness : btScalar(0);
}

btScalar inverseMass(const btCollisionObject& object) {
  if (object.isStaticOrKinematicObject()) return 0;
  if (const btRigidBody* body = btRigidBody::upcast(&object)) return body->getInvMass();
  if (const btMultiBodyLinkCollider* collider = btMultiBodyLinkCollider::upcast(&object)) {
    const btMultiBody* body = collider->m_multiBody;
    if (collider->m_link < 0 && body->hasFixedBase()) return 0;
    const btScalar mass = collider->m_link < 0 ? body->getBaseMass() : body->getLinkMass(collider->m_link);
    return mass > 0 ? 1 / mass : btScalar(0);
  }
  return 0;
}

btScalar reducedMass(const btCollisionObject& a, const btCollisionObject& b) {
  const btScalar inverse = inverseMass(a) + inverseMass(b);
  return inverse > 0 ? 1 / inverse : btScalar(0);
}

// As btCollisionDispatcher::needsResponse() has it. A user's own must not be asked: this is by any thread.
bool areSolved(const btCollisionObject& a, const btCollisionObject& b) {
  return a.hasContactResponse() && b.hasContactResponse() && (canBeMoved(a) || canBeMoved(b));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
