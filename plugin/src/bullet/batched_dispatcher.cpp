#include "innersphere/batched_dispatcher.hpp"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include "bullet/packing_pair_algorithm.hpp"
#include "bullet/registration.hpp"
#include "common/parallel.hpp"
#include "pair_cache/pair_table.hpp"

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

/// Null if the pair is none of ours, or Bullet has not asked for it yet.
ContactPair* contactPairOf(const btBroadphasePair& pair) {
  auto* algorithm = dynamic_cast<PairAlgorithm*>(pair.m_algorithm);
  return algorithm == nullptr ? nullptr : &algorithm->pair();
}

/// A pair of the table, which reads it: with a thousand bodies that takes all threads.
ContactPair* listedPairOf(const btBroadphasePair& pair) {
  ContactPair* ours = contactPairOf(pair);
  return ours == nullptr || ours->body_a == nullptr ? nullptr : ours;
}

/// A pair of packings that is new in this step takes part in its update.
void announce(btCollisionDispatcher& dispatcher, PairTable& table, btBroadphasePair& pair) {
  const btCollisionObject& a = *objectOf(pair.m_pProxy0);
  const btCollisionObject& b = *objectOf(pair.m_pProxy1);
  if (PackingShape::from(a.getCollisionShape()) == nullptr) return;
  if (PackingShape::from(b.getCollisionShape()) == nullptr) return;
  if (!dispatcher.needsCollision(&a, &b)) return;
  const btCollisionObjectWrapper wrapped_a = wrapped(a), wrapped_b = wrapped(b);
  if (pair.m_algorithm == nullptr)
    pair.m_algorithm = dispatcher.findAlgorithm(&wrapped_a, &wrapped_b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  if (ContactPair* ours = contactPairOf(pair)) table.announce(*ours, wrapped_a, wrapped_b);
}

/// What Bullet would do for the pairs, but for those that are done. `ours`: for each pair, or null.
void collide(btCollisionDispatcher& dispatcher, PairTable& table, btBroadphasePairArray& pairs,
             const std::vector<ContactPair*>& ours, const btDispatcherInfo& info) {
  static thread_local std::vector<char> kept;
  std::vector<char>& done = kept;  // of this thread, also for the others
  // A device works on while Bullet collides bodies that are no packings.
  for (std::size_t i = 0; i < ours.size(); ++i) {
    if (ours[i] == nullptr) dispatcher.getNearCallback()(pairAt(pairs, i), dispatcher, info);
  }
  table.finishUpdate();
  table.logSolver();
  table.compareBodies();
  done.resize(ours.size());
  inParallel(ours.size(), [&](std::size_t i) {
    done[i] = ours[i] != nullptr && table.isDone(*ours[i], info.m_timeStep);
    if (done[i]) ours[i]->asked = true;
  });
  // Filters may be the user's own, which other threads must not call.
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const btBroadphasePair& pair = pairAt(pairs, i);
    if (done[i] && !dispatcher.needsCollision(objectOf(pair.m_pProxy0), objectOf(pair.m_pProxy1)))
      ours[i]->asked = false;
  }
  for (std::size_t i = 0; i < ours.size(); ++i) {
    if (ours[i] != nullptr && !done[i]) dispatcher.getNearCallback()(pairAt(pairs, i), dispatcher, info);
  }
}

}  // namespace

bool collideBatch(btCollisionDispatcher& dispatcher, btOverlappingPairCache& pairs,
                  const btDispatcherInfo& info, bool as_bullet_does) {
  static thread_local std::vector<ContactPair*> kept;
  std::vector<ContactPair*>& ours = kept;  // of this thread, also for the others
  const std::shared_ptr<Registration> registration = Registration::find(&dispatcher);
  if (!registration) return false;
  PairTable& table = registration->table();
  btBroadphasePairArray& all = pairs.getOverlappingPairArray();
  ours.resize(static_cast<std::size_t>(all.size()));
  inParallel(ours.size(), [&](std::size_t i) { ours[i] = listedPairOf(pairAt(all, i)); });
  for (std::size_t i = 0; i < ours.size(); ++i) {
    if (ours[i] != nullptr) continue;
    announce(dispatcher, table, pairAt(all, i));
    ours[i] = contactPairOf(pairAt(all, i));
  }
  table.beginUpdate(info.m_timeStep);
  if (!as_bullet_does || info.m_deterministicOverlappingPairs ||
      info.m_dispatchFunc != btDispatcherInfo::DISPATCH_DISCRETE ||
      dispatcher.getNearCallback() != &btCollisionDispatcher::defaultNearCallback)
    return false;
  collide(dispatcher, table, all, ours, info);
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
