// Declares a dispatcher that finds the overlaps of all packings at once, before Bullet asks for them one by
// one.
#pragma once

#include <type_traits>

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Updates all pairs with a packing that may collide in this step; the searches of pairs of packings share
/// one query. Then, if `as_bullet_does`, it dispatches all pairs as btCollisionDispatcher does, but for those
/// that need nothing more. Returns true if it has dispatched them. It does not if there is a near-callback of
/// the user's, if pairs are to be dispatched in a certain order, or if the dispatch is not the discrete one.
/// Does nothing and returns false for a dispatcher that is not registered. BatchedDispatcher calls it;
/// programs need not.
bool collideBatch(btCollisionDispatcher& dispatcher, btOverlappingPairCache& pairs,
                  const btDispatcherInfo& info, bool as_bullet_does);

/// Takes the place of btCollisionDispatcher, or of the one that is given as Base, for example
/// btCollisionDispatcherMt. Register PackingCollisionAlgorithm with it as with any other.
///
/// It searches all pairs of packings of a step together, in one shared query. A device works on it while
/// Bullet collides other bodies, up to the first pair of packings. Without this dispatcher each pair that is
/// new in a step takes a query of its own, so use it where many bodies meet in a step, above all with CUDA.
/// New pairs of children of compound shapes still take one each.
///
/// Pairs that need nothing more, most of those of a pile, cost next to nothing. That does not hold with
/// another Base, or with a near-callback of the user's.
///
/// Near-callbacks and filters work as before, and are called by the thread that dispatches. A pair that they
/// refuse is searched once, when it is new.
template <class Base = btCollisionDispatcher>
class BatchedDispatcher : public Base {
 public:
  using Base::Base;

  /// Collides all overlapping pairs. Bullet calls it in each step, so programs need not.
  void dispatchAllCollisionPairs(btOverlappingPairCache* pairs, const btDispatcherInfo& info,
                                 btDispatcher* dispatcher) override {
    constexpr bool kAsBulletDoes = std::is_same_v<Base, btCollisionDispatcher>;
    if (!collideBatch(*this, *pairs, info, kAsBulletDoes))
      Base::dispatchAllCollisionPairs(pairs, info, dispatcher);
  }
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
