// A dispatcher that finds the overlaps of all packings at once, before Bullet asks for them one by one.
#pragma once

#include <type_traits>

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Looks at all pairs with a packing that may collide in this step, those of packings in one launch. Then,
/// if `as_bullet_does`, collides all pairs, as btCollisionDispatcher does, but for those that there is
/// nothing left to do for; true if it did that: not if there is a near-callback of the user's, or pairs are
/// to be collided in a certain order. Does nothing for a dispatcher that is not registered.
bool collideBatch(btCollisionDispatcher& dispatcher, btOverlappingPairCache& pairs,
                  const btDispatcherInfo& info, bool as_bullet_does);

/// In place of a btCollisionDispatcher (or another one derived from it, btCollisionDispatcherMt for example,
/// as Base): exactly one launch a step, on which a device works while Bullet collides bodies that are no
/// packings, up to the first pair of packings. Without it pairs that are new in a step take a launch each, so
/// use it where many bodies meet in a step, above all with CUDA. Pairs of children of compound shapes that
/// are new still do. Pairs that there is nothing left to do for, most of those of a pile, cost it next to
/// nothing; not so with another Base, or a near-callback of the user's. Near-callbacks and filters work as
/// before: a pair that they turn down is looked at once, when it is new. Filters of a class derived from this
/// one (needsCollision()) are asked by one thread, those of bodies (checkCollideWithOverride()) by several.
/// Register PackingCollisionAlgorithm with it as with any other.
template <class Base = btCollisionDispatcher>
class BatchedDispatcher : public Base {
 public:
  using Base::Base;

  /// Bullet calls it in each step.
  void dispatchAllCollisionPairs(btOverlappingPairCache* pairs, const btDispatcherInfo& info,
                                 btDispatcher* dispatcher) override {
    constexpr bool kAsBulletDoes = std::is_same_v<Base, btCollisionDispatcher>;
    if (!collideBatch(*this, *pairs, info, kAsBulletDoes))
      Base::dispatchAllCollisionPairs(pairs, info, dispatcher);
  }
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
