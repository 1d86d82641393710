#include "pair_cache/contact_pair.hpp"

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include "common/log.hpp"
#include "pair_cache/reuse.hpp"
#include "shape/option_rules.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

btScalar sizeOf(const PairSide& side) {
  return side.packing == nullptr ? side.shape->getAngularMotionDisc() : side.packing->impl().size;
}

btScalar smallerSize(const PairSide& packing, const PairSide& other) {
  return other.shape->isInfinite() ? sizeOf(packing) : btMin(sizeOf(packing), sizeOf(other));
}

bool hasLawOfItsOwn(const btCollisionObject& object) {
  return (object.getCollisionFlags() & btCollisionObject::CF_HAS_CONTACT_STIFFNESS_DAMPING) != 0;
}

btScalar deepest(const std::vector<ContactPatch>& patches) {
  btScalar depth = -BT_LARGE_FLOAT;
  for (const ContactPatch& patch : patches) depth = btMax(depth, patch.depth());
  return depth;
}

/// Code of the user's that wants to be called by the thread that dispatches, and before the next pair.
bool hasCallbacks(const btDispatcher& dispatcher) {
  return static_cast<const btCollisionDispatcher&>(dispatcher).getNearCallback() !=
             &btCollisionDispatcher::defaultNearCallback ||
         gContactAddedCallback != nullptr || gContactProcessedCallback != nullptr ||
         gContactDestroyedCallback != nullptr || gContactStartedCallback != nullptr ||
         gContactEndedCallback != nullptr ||
         gCalculateCombinedFrictionCallback != &btManifoldResult::calculateCombinedFriction ||
         gCalculateCombinedRestitutionCallback != &btManifoldResult::calculateCombinedRestitution ||
         gCalculateCombinedRollingFrictionCallback != &btManifoldResult::calculateCombinedRollingFriction ||
         gCalculateCombinedSpinningFrictionCallback != &btManifoldResult::calculateCombinedSpinningFriction ||
         gCalculateCombinedContactDampingCallback != &btManifoldResult::calculateCombinedContactDamping ||
         gCalculateCombinedContactStiffnessCallback != &btManifoldResult::calculateCombinedContactStiffness;
}

/// On B.
btVector3 impulseOf(const btManifoldPoint& point) {
  return -(point.m_normalWorldOnB * point.m_appliedImpulse +
           point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
           point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2);
}

PairMotion motionOf(const BodySnapshot& a, const BodySnapshot& b, btScalar time_step) {
  return {a.start().getOrigin(), a.velocity(), b.start().getOrigin(), b.velocity(),
          isSwept(a.motion(), b.motion(), time_step)};
}

/// A link of a chain hands what it bears on from one neighbour to the other.
bool handsOn(const BodySnapshot& body) {
  return !body.object()->isStaticOrKinematicObject() && body.neighbours() == 2;
}

/// A chain ends at a body that is held, or in a link with one neighbour.
bool areOfChain(const BodySnapshot& a, const BodySnapshot& b) {
  const auto isLink = [](const BodySnapshot& body) {
    return body.object()->isStaticOrKinematicObject() || body.neighbours() <= 2;
  };
  return isLink(a) && isLink(b) && (handsOn(a) || handsOn(b));
}

template <typename Visit>
void forEachPoint(const ManifoldWriter& writer, const Visit& visit) {
  static thread_local btManifoldArray manifolds;
  manifolds.resize(0);
  writer.append(manifolds);
  for (int m = 0; m < manifolds.size(); ++m) {
    for (int i = 0; i < manifolds[m]->getNumContacts(); ++i) visit(manifolds[m]->getContactPoint(i));
  }
}

}  // namespace

void ContactPair::set(const btCollisionObjectWrapper& wrapper_a, const btCollisionObjectWrapper& wrapper_b,
                      bool is_swapped) {
  swapped = is_swapped;
  plain = wrapper_a.m_parent == nullptr && wrapper_b.m_parent == nullptr;
  const bool same = found && a.isFor(wrapper_a) && b.isFor(wrapper_b);
  const std::uint64_t version_a = a.version, version_b = b.version;
  a = PairSide(wrapper_a);
  b = PairSide(wrapper_b);
  if (same) {
    a.version = version_a;
    b.version = version_b;
    return;
  }
  of_packings = b.packing != nullptr;
  forgetContact();
  if (of_packings) {
    found = std::make_unique<PackingVsPacking>(*a.packing, *b.packing);
  } else {
    found = std::make_unique<PackingVsShape>(*a.packing, *b.shape);
  }
}

void ContactPair::noteShapes(const ContactOptions& world_options) {
  a.noteShape();
  b.noteShape();
  options = optionsOfPair(world_options, *a.shape, *b.shape);
}

void ContactPair::forgetContact() {
  if (found) found->forget();
  published = false;
  safe = SafeDistance();
}

void ContactPair::clear() {
  forgetContact();
  found.reset();
  manifolds.clear();
  a = b = PairSide();
  asked = busy = announced = logged_ = false;
  step = pushed_step = 0;
  separation = depth = time_step = 0;
  penalty = PenaltyReport();
}

btVector3 ContactPair::origin() const {
  return a.packing->impl().toWorld(a.start).getOrigin();
}

bool ContactPair::canBePublished() const {
  if (separation != 0 || options.response == Response::penalty) return false;
  const std::size_t patches = found->patches().size();
  if (patches == 0 && manifolds.size() == 0) return true;
  return plain && !hasCallbacks(manifolds.dispatcher()) && patches <= manifolds.size();
}

void ContactPair::publish(const StepSettings& settings, const BodySnapshot& body_a,
                          const BodySnapshot& body_b) {
  if (found->patches().empty() && manifolds.size() == 0) {
    depth = deepest(found->patches());
    return;
  }
  const btCollisionObjectWrapper wrapper_a(nullptr, a.shape, a.object, a.transform, -1, -1);
  const btCollisionObjectWrapper wrapper_b(nullptr, b.shape, b.object, b.transform, -1, -1);
  btManifoldResult result(swapped ? &wrapper_b : &wrapper_a, swapped ? &wrapper_a : &wrapper_b);
  result.setShapeIdentifiersA(-1, -1);
  result.setShapeIdentifiersB(-1, -1);
  write(settings, body_a, body_b, &result);
}

void ContactPair::write(const StepSettings& settings, const BodySnapshot& body_a, const BodySnapshot& body_b,
                        btManifoldResult* result) {
  depth = deepest(found->patches());
  manifolds.write(*a.object, *b.object, {body_a.start(), body_b.start()},
                  motionOf(body_a, body_b, settings.time_step), origin(), found->patches(), lawOf(settings),
                  neededSeparation(*this, body_a, body_b, settings.time_step), result);
}

void ContactPair::report(const std::vector<ContactPatch>& patches, btManifoldResult* result) const {
  ManifoldWriter::report(*a.object, *b.object, origin(), patches, result);
}

ContactLaw ContactPair::lawOf(const StepSettings& settings) const {
  ContactOptions chosen = options;
  // A law of the user's own on a body takes the place of ours.
  if (hasLawOfItsOwn(*a.object) || hasLawOfItsOwn(*b.object)) chosen.response = Response::rigid;
  if (chosen.response == Response::penalty && !Penalty::applies(*a.object, *b.object))
    chosen.response = Response::compliant;
  return ContactLaw(chosen, reducedMass(*a.object, *b.object), settings.time_step, smallerSize(a, b),
                    settings.solver, areOfChain(*body_a, *body_b), areSolved(*a.object, *b.object));
}

bool ContactPair::hasPoints() const {
  bool any = false;
  forEachPoint(manifolds, [&](const btManifoldPoint&) { any = true; });
  return any;
}

bool ContactPair::hasFriction() const {
  if (options.response == Response::penalty) return false;
  bool any = false;
  forEachPoint(manifolds, [&](const btManifoldPoint& point) { any = any || point.m_combinedFriction > 0; });
  return any;
}

PairOverlap ContactPair::read(const Overlap& shared) const {
  PairOverlap pair;
  pair.a = a.object;
  pair.b = b.object;
  pair.depth = depth;
  pair.volume = shared.volume;
  pair.area = toBullet(shared.area);
  const btScalar rate = time_step > 0 ? 1 / time_step : btScalar(0);
  int count = 0;
  btVector3 middle(0, 0, 0);
  forEachPoint(manifolds, [&](const btManifoldPoint& point) {
    ++count;
    middle += point.getPositionWorldOnB();
    pair.force += impulseOf(point) * rate;
  });
  pair.centroid = shared.volume > 0 ? origin() + toBullet(shared.centroid) : middle / btScalar(count);
  forEachPoint(manifolds, [&](const btManifoldPoint& point) {
    pair.torque += (point.getPositionWorldOnB() - pair.centroid).cross(impulseOf(point) * rate);
  });
  pair.penalty_force = penalty.force;
  pair.penalty_energy = penalty.energy;
  pair.largest_step = penalty.largest_step;
  return pair;
}

void ContactPair::logOnce(const std::string& message) {
  if (!logged_) log(message);
  logged_ = true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
