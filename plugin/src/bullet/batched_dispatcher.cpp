#include "innersphere/batched_dispatcher.hpp"

#include <typeinfo>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include "bullet/packing_pair_algorithm.hpp"
#include "bullet/registration.hpp"
#include "common/parallel.hpp"
#include "pair_cache/contact_pair.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

btCollisionObject* objectOf(const btBroadphaseProxy* proxy) {
  return static_cast<btCollisionObject*>(proxy->m_clientObject);
}

btBroadphasePair& pairAt(btBroadphasePairArray& pairs, std::size_t index) {
  return pairs[static_cast<int>(index)];
}

btCollisionObjectWrapper wrapped(const btCollisionObject& object) {
  return {nullptr, object.getCollisionShape(), &object, object.getWorldTransform(), -1, -1};
}

/// Nowhere if the pair is none of ours, or new.
PairContact::Place placeOf(const btBroadphasePair& pair) {
  if (pair.m_algorithm == nullptr || typeid(*pair.m_algorithm) != typeid(PairAlgorithm)) return {};
  return static_cast<PairAlgorithm&>(*pair.m_algorithm).place();
}

/// Null if it is no new pair of packings that may collide.
PackingContact* announce(btCollisionDispatcher& dispatcher, btBroadphasePair& pair, btScalar time_step) {
  const btCollisionObject& a = *objectOf(pair.m_pProxy0);
  const btCollisionObject& b = *objectOf(pair.m_pProxy1);
  if (PackingShape::from(a.getCollisionShape()) == nullptr) return nullptr;
  if (PackingShape::from(b.getCollisionShape()) == nullptr) return nullptr;
  if (!dispatcher.needsCollision(&a, &b)) return nullptr;
  const btCollisionObjectWrapper wrapped_a = wrapped(a), wrapped_b = wrapped(b);
  if (pair.m_algorithm == nullptr) {
    pair.m_algorithm = dispatcher.findAlgorithm(&wrapped_a, &wrapped_b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  }
  auto* algorithm = dynamic_cast<PairAlgorithm*>(pair.m_algorithm);
  return algorithm == nullptr ? nullptr : algorithm->announce(wrapped_a, wrapped_b, time_step);
}

/// What Bullet would do for the pairs, but for those that are done.
void collide(btCollisionDispatcher& dispatcher, Registration& registration, btBroadphasePairArray& pairs,
             const std::vector<PairContact::Place>& places, const btDispatcherInfo& info) {
  static thread_local std::vector<char> kept;
  std::vector<char>& done = kept;  // of this thread, also for the others
  const std::size_t count = places.size();
  // A device works on while Bullet collides bodies that are no packings.
  bool any_others = false;
  for (std::size_t i = 0; i < count; ++i) {
    if (places[i].look != nullptr) continue;
    any_others = true;
    dispatcher.getNearCallback()(pairAt(pairs, i), dispatcher, info);
  }
  registration.batch().finish();
  if (any_others) {  // whose callbacks may have moved bodies
    for (LookBoard* board : {&registration.batch().looks(), &registration.surfaces().looks()}) board->check();
  }
  const auto ask = [&](std::size_t i) {
    const btBroadphasePair& pair = pairAt(pairs, i);
    if (dispatcher.needsCollision(objectOf(pair.m_pProxy0), objectOf(pair.m_pProxy1)))
      places[i].board->ask(*places[i].look);
  };
  // A filter of the user's is asked by one thread, and in turn with what Bullet does for the pairs.
  const bool own_filter = typeid(dispatcher) != typeid(BatchedDispatcher<>);
  done.resize(count);
  inParallel(
      count,
      [&](std::size_t i) {
        done[i] = places[i].look != nullptr && places[i].board->isDone(*places[i].look, info.m_timeStep);
        if (done[i] && !own_filter) ask(i);
      },
      [&](std::size_t i) { fetch(places[i].look); });
  for (std::size_t i = 0; i < count; ++i) {
    if (!done[i] && places[i].look != nullptr)
      dispatcher.getNearCallback()(pairAt(pairs, i), dispatcher, info);
    if (done[i] && own_filter) ask(i);
  }
}

}  // namespace

bool collideBatch(btCollisionDispatcher& dispatcher, btOverlappingPairCache& pairs,
                  const btDispatcherInfo& info, bool as_bullet_does) {
  static thread_local std::vector<PackingContact*> fresh;
  static thread_local std::vector<PairContact::Place> kept;
  std::vector<PairContact::Place>& places = kept;  // of this thread, also for the others
  const std::shared_ptr<Registration> registration = Registration::find(&dispatcher);
  if (!registration) return false;
  btBroadphasePairArray& all = pairs.getOverlappingPairArray();
  places.resize(static_cast<std::size_t>(all.size()));
  inParallel(
      places.size(), [&](std::size_t i) { places[i] = placeOf(pairAt(all, i)); },
      [&](std::size_t i) { fetch(pairAt(all, i).m_algorithm); });
  fresh.clear();
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].look != nullptr) continue;
    btBroadphasePair& pair = pairAt(all, i);
    if (PackingContact* contact = announce(dispatcher, pair, info.m_timeStep)) fresh.push_back(contact);
    places[i] = placeOf(pair);
  }
  registration->batch().launch(fresh, info.m_timeStep);
  registration->surfaces().launch(info.m_timeStep);
  if (!as_bullet_does || info.m_deterministicOverlappingPairs ||
      info.m_dispatchFunc != btDispatcherInfo::DISPATCH_DISCRETE ||
      dispatcher.getNearCallback() != &btCollisionDispatcher::defaultNearCallback)
    return false;
  collide(dispatcher, *registration, all, places, info);
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
