// A dispatcher that finds the overlaps of all packings at once, before Bullet asks for them one by one.
#pragma once

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// One launch for all pairs of packings that may collide in this step. Does nothing for a dispatcher that is
/// not registered.
void launchBatch(btCollisionDispatcher& dispatcher, btOverlappingPairCache& pairs,
                 const btDispatcherInfo& info);

/// In place of a btCollisionDispatcher (or another one derived from it, btCollisionDispatcherMt for example,
/// as Base): exactly one launch a step, on which a device works while Bullet collides bodies that are no
/// packings, up to the first pair of packings. Without it pairs that are new in a step take a launch each, so
/// use it where many bodies meet in a step, above all with CUDA. Pairs of children of compound shapes that
/// are new still do. Near-callbacks and filters work as before: a pair that they turn down is looked at once,
/// when it is new. Register PackingCollisionAlgorithm with it as with any other.
template <class Base = btCollisionDispatcher>
class BatchedDispatcher : public Base {
 public:
  using Base::Base;

  void dispatchAllCollisionPairs(btOverlappingPairCache* pairs, const btDispatcherInfo& info,
                                 btDispatcher* dispatcher) override {
    launchBatch(*this, *pairs, info);
    Base::dispatchAllCollisionPairs(pairs, info, dispatcher);
  }
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
