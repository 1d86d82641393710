#include "pair_cache/contact_pair.hpp"

#include <mutex>
#include <typeinfo>
#include <utility>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include "common/log.hpp"
#include "common/motion_bound.hpp"
#include "innersphere/error.hpp"
#include "response/option_rules.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

btScalar sizeOf(const btCollisionShape& shape) {
  const PackingShape* packing = PackingShape::from(&shape);
  return packing == nullptr ? shape.getAngularMotionDisc() : packing->impl().size;
}

btScalar sizeOf(const btCollisionShape& packing, const btCollisionShape& other) {
  const btScalar size = sizeOf(packing);
  return other.isInfinite() ? size : btMin(size, sizeOf(other));
}

bool hasLawOfItsOwn(const btCollisionObject& object) {
  return (object.getCollisionFlags() & btCollisionObject::CF_HAS_CONTACT_STIFFNESS_DAMPING) != 0;
}

btScalar deepest(const std::vector<ContactPatch>& patches) {
  btScalar depth = -BT_LARGE_FLOAT;
  for (const ContactPatch& patch : patches) {
    for (int i = 0; i < patch.count; ++i) depth = btMax(depth, patch.points[i].depth);
  }
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

bool hasPoints(const btManifoldArray& manifolds) {
  for (int i = 0; i < manifolds.size(); ++i) {
    if (manifolds[i]->getNumContacts() > 0) return true;
  }
  return false;
}

/// On B.
btVector3 impulseOf(const btManifoldPoint& point) {
  return -(point.m_normalWorldOnB * point.m_appliedImpulse +
           point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
           point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2);
}

}  // namespace

PairContact::PairContact(btDispatcher* dispatcher, std::shared_ptr<Registration> registration, bool closest)
    : dispatcher_(dispatcher),
      registration_(std::move(registration)),
      closest_(closest),
      manifolds_(dispatcher) {
  if (!closest_) registration_->pairs().add(this);
}

PairContact::~PairContact() {
  if (!closest_) registration_->pairs().remove(this);
  forget();
}

void PairContact::process(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b, bool swapped,
                          const btDispatcherInfo& dispatch, btManifoldResult* result) {
  std::unique_lock<std::recursive_mutex> lock(registration_->processing(), std::defer_lock);
  if (!closest_) lock.lock();
  if (hasReceived(a, b, *result, dispatch.m_timeStep)) return;
  static const std::vector<ContactPatch> kNone;
  const std::vector<ContactPatch>* patches = &kNone;
  look(a, b, closest_ ? btScalar(0) : dispatch.m_timeStep);
  if (!isFinite(transform_a_) || !isFinite(transform_b_)) {
    report("A body's transform is not finite; its contacts are skipped. Remove it from the world.");
  } else {
    try {
      patches = &update(a, b, result->m_closestPointDistanceThreshold);
    } catch (const Error& error) {
      report(std::string("Contacts of a pair of bodies are skipped: ") + error.what());
    }
  }
  depth_ = deepest(*patches);
  if (closest_) {
    ManifoldSet::report(*object_a_, *object_b_, origin(), *patches, result);
    return;
  }
  swapped_ = swapped;
  plain_ = isPlain(a, b, *result);
  const ContactLaw law = lawOf(options_, dispatch.m_timeStep);
  manifolds_.write(*object_a_, *object_b_, origin(), *patches, law,
                   sweepOf(*object_a_, *object_b_, time_step_), result);
  penalty_ = PenaltyReport();
  if (law.penalty() && patches != &kNone) push(law, dispatch, *result);
}

PairContact::Place PairContact::place() const {
  if (closest_) return {};
  if (packings_) return {&registration_->batch().looks(), packings_->look, swapped_};
  if (surface_) return {&registration_->surfaces().looks(), surface_->look, swapped_};
  return {};
}

/// Bullet asks for the same pair in the same way, and a look at all pairs has done what there was to do.
bool PairContact::hasReceived(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
                              const btManifoldResult& result, btScalar time_step) {
  const btScalar separation = result.m_closestPointDistanceThreshold;
  if (closest_ || typeid(result) != typeid(btManifoldResult) || time_step != time_step_ ||
      a.getCollisionShape() != shape_a_ || b.getCollisionShape() != shape_b_ ||
      !isFinite(a.getWorldTransform()) || !isFinite(b.getWorldTransform()))
    return false;
  if (packings_) return registration_->batch().hasDelivered(*packings_, a, b, separation);
  return surface_ && registration_->surfaces().hasDelivered(*surface_, a, b, separation, time_step);
}

bool PairContact::receive(const std::vector<ContactPatch>& patches, const ContactOptions& world_options,
                          btScalar time_step) {
  const ContactOptions options = optionsOfPair(world_options, *shape_a_, *shape_b_);
  if (time_step != time_step_ || options.response == Response::penalty) return false;
  if (!patches.empty() || manifolds_.size() > 0) {
    // New manifolds are the dispatcher's, which is not asked by several threads at once.
    if (!plain_ || hasCallbacks(*dispatcher_) || patches.size() > manifolds_.size()) return false;
    options_ = options;
    transform_a_ = object_a_->getWorldTransform();
    transform_b_ = object_b_->getWorldTransform();
    const btCollisionObjectWrapper a(nullptr, shape_a_, object_a_, transform_a_, -1, -1);
    const btCollisionObjectWrapper b(nullptr, shape_b_, object_b_, transform_b_, -1, -1);
    btManifoldResult result(swapped_ ? &b : &a, swapped_ ? &a : &b);
    result.setShapeIdentifiersA(-1, -1);
    result.setShapeIdentifiersB(-1, -1);
    manifolds_.write(*object_a_, *object_b_, origin(), patches, lawOf(options, time_step),
                     sweepOf(*object_a_, *object_b_, time_step), &result);
  }
  depth_ = deepest(patches);
  return true;
}

/// Bullet asks for the pair as it does of itself, and for no child of a compound, which it names in the
/// points.
bool PairContact::isPlain(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
                          const btManifoldResult& result) {
  return a.m_parent == nullptr && b.m_parent == nullptr && typeid(result) == typeid(btManifoldResult);
}

PackingContact* PairContact::announce(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
                                      btScalar time_step) {
  const PackingShape* packing_a = PackingShape::from(a.getCollisionShape());
  const PackingShape* packing_b = PackingShape::from(b.getCollisionShape());
  if (packing_a == nullptr || packing_b == nullptr) return nullptr;
  look(a, b, time_step);
  return provide(PackingSide(a, *packing_a), PackingSide(b, *packing_b)) ? &*packings_ : nullptr;
}

void PairContact::look(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
                       btScalar time_step) {
  time_step_ = time_step;
  options_ = optionsOfPair(registration_->options(), *a.getCollisionShape(), *b.getCollisionShape());
  // What was known of the pair holds only as long as it has the same shapes.
  if (a.getCollisionShape() != shape_a_ || b.getCollisionShape() != shape_b_) forget();
  object_a_ = a.getCollisionObject();
  object_b_ = b.getCollisionObject();
  shape_a_ = a.getCollisionShape();
  shape_b_ = b.getCollisionShape();
  transform_a_ = a.getWorldTransform();
  transform_b_ = b.getWorldTransform();
}

/// True if the pair was not known to the batch.
bool PairContact::provide(const PackingSide& a, const PackingSide& b) {
  const bool fresh = !packings_;
  if (fresh) {
    packings_.emplace(a, b, *this);
    if (!closest_) registration_->batch().add(&*packings_);
  }
  packings_->time_step = time_step_;
  return fresh;
}

const std::vector<ContactPatch>& PairContact::update(const btCollisionObjectWrapper& a,
                                                     const btCollisionObjectWrapper& b, btScalar separation) {
  const PackingSide side_a(a, *PackingShape::from(shape_a_));
  if (const PackingShape* other = PackingShape::from(shape_b_)) {
    const PackingSide side_b(b, *other);
    provide(side_a, side_b);
    return registration_->batch().update(*packings_, side_a, side_b, separation);
  }
  const BodySide side_b(b);
  if (!surface_) {
    surface_.emplace(side_a, side_b, *this);
    if (!closest_) registration_->surfaces().add(&*surface_);
  }
  return registration_->surfaces().update(*surface_, side_a, side_b, separation, time_step_);
}

ContactLaw PairContact::lawOf(const ContactOptions& chosen, btScalar time_step) const {
  ContactOptions options = chosen;
  // A law of the user's own on a body takes the place of ours.
  if (hasLawOfItsOwn(*object_a_) || hasLawOfItsOwn(*object_b_)) options.response = Response::rigid;
  if (options.response == Response::penalty && !Penalty::applies(*object_a_, *object_b_))
    options.response = Response::compliant;
  return ContactLaw(options, reducedMass(*object_a_, *object_b_), time_step, sizeOf(*shape_a_, *shape_b_));
}

void PairContact::push(const ContactLaw& law, const btDispatcherInfo& dispatch,
                       const btManifoldResult& result) {
  static thread_local btManifoldArray manifolds;
  manifolds.resize(0);
  manifolds_.append(manifolds);
  // contactTest walks a compound with the algorithms of a step, but its result keeps no point.
  if (typeid(result) != typeid(btManifoldResult) && !hasPoints(manifolds)) return;
  const std::uint64_t step = registration_->steps().of(dispatch);
  if (step == pushed_step_ || !(dispatch.m_timeStep > 0)) return;
  pushed_step_ = step;
  if (!dispatcher_->needsResponse(object_a_, object_b_)) return;
  penalty_ = Penalty(*object_a_, *object_b_, btScalar(options_.damping), dispatch.m_timeStep)
                 .push(overlap(), law.penaltyStiffness(), arm(), manifolds);
}

bool PairContact::read(PairOverlap& pair) {
  static thread_local btManifoldArray manifolds;
  manifolds.resize(0);
  manifolds_.append(manifolds);
  int count = 0;
  btVector3 middle(0, 0, 0);
  pair = PairOverlap();
  pair.depth = depth_;
  const auto forEachPoint = [&](const auto& visit) {
    for (int m = 0; m < manifolds.size(); ++m) {
      for (int i = 0; i < manifolds[m]->getNumContacts(); ++i) visit(manifolds[m]->getContactPoint(i));
    }
  };
  const btScalar rate = time_step_ > 0 ? 1 / time_step_ : btScalar(0);
  forEachPoint([&](const btManifoldPoint& point) {
    ++count;
    middle += point.getPositionWorldOnB();
    pair.force += impulseOf(point) * rate;
  });
  if (count == 0) return false;
  pair.a = object_a_;
  pair.b = object_b_;
  const Overlap shared = overlap();
  pair.volume = shared.volume;
  pair.area = toBullet(shared.area);
  pair.centroid = shared.volume > 0 ? origin() + toBullet(shared.centroid) : middle / btScalar(count);
  forEachPoint([&](const btManifoldPoint& point) {
    pair.torque += (point.getPositionWorldOnB() - pair.centroid).cross(impulseOf(point) * rate);
  });
  pair.penalty_force = penalty_.force;
  pair.penalty_energy = penalty_.energy;
  pair.largest_step = penalty_.largest_step;
  return true;
}

Overlap PairContact::overlap() {
  return packings_ ? registration_->batch().volumesOf(*packings_)
                   : registration_->surfaces().volumesOf(*surface_);
}

btVector3 PairContact::origin() const {
  return PackingShape::from(shape_a_)->impl().toWorld(transform_a_).getOrigin();
}

btVector3 PairContact::arm() const {
  return packings_ ? PackingShape::from(shape_b_)->impl().toWorld(transform_b_).getOrigin() : origin();
}

void PairContact::forget() {
  if (packings_ && !closest_) registration_->batch().remove(&*packings_);
  if (surface_ && !closest_) registration_->surfaces().remove(&*surface_);
  packings_.reset();
  surface_.reset();
}

/// Once for each pair: a body that is lost stays lost.
void PairContact::report(const std::string& message) {
  if (!reported_) log(message);
  reported_ = true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
