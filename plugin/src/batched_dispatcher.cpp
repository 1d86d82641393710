#include "innersphere/batched_dispatcher.hpp"

#include <typeinfo>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include "pair_algorithm.hpp"
#include "pair_contact.hpp"
#include "registration.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

btCollisionObject* objectOf(const btBroadphaseProxy* proxy) {
  return static_cast<btCollisionObject*>(proxy->m_clientObject);
}

btCollisionObjectWrapper wrapped(const btCollisionObject& object) {
  return {nullptr, object.getCollisionShape(), &object, object.getWorldTransform(), -1, -1};
}

bool isKnown(const btBroadphasePair& pair) {
  return pair.m_algorithm != nullptr && typeid(*pair.m_algorithm) == typeid(PairAlgorithm) &&
         static_cast<PairAlgorithm&>(*pair.m_algorithm).isKnown();
}

}  // namespace

void launchBatch(btCollisionDispatcher& dispatcher, btOverlappingPairCache& pairs,
                 const btDispatcherInfo& info) {
  const std::shared_ptr<Registration> registration = Registration::find(&dispatcher);
  if (!registration) return;
  static thread_local std::vector<PackingContact*> fresh;
  fresh.clear();
  btBroadphasePairArray& all = pairs.getOverlappingPairArray();
  for (int i = 0; i < all.size(); ++i) {
    btBroadphasePair& pair = all[i];
    if (isKnown(pair)) continue;
    const btCollisionObject& a = *objectOf(pair.m_pProxy0);
    const btCollisionObject& b = *objectOf(pair.m_pProxy1);
    if (PackingShape::from(a.getCollisionShape()) == nullptr) continue;
    if (PackingShape::from(b.getCollisionShape()) == nullptr) continue;
    if (!dispatcher.needsCollision(&a, &b)) continue;
    const btCollisionObjectWrapper wrapped_a = wrapped(a), wrapped_b = wrapped(b);
    if (pair.m_algorithm == nullptr) {
      pair.m_algorithm =
          dispatcher.findAlgorithm(&wrapped_a, &wrapped_b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    }
    auto* algorithm = dynamic_cast<PairAlgorithm*>(pair.m_algorithm);
    if (algorithm == nullptr) continue;
    if (PackingContact* contact = algorithm->announce(wrapped_a, wrapped_b, info.m_timeStep)) {
      fresh.push_back(contact);
    }
  }
  registration->batch().launch(fresh, info.m_timeStep);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
