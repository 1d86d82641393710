// Bullet's collision algorithm for a pair with a packing in it.
#pragma once

#include <memory>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>

#include "bullet/registration.hpp"
#include "pair_cache/contact_pair.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

class PairAlgorithm : public btCollisionAlgorithm {
 public:
  /// `closest`: answers one closest-point query, without touching the dispatcher's manifolds.
  PairAlgorithm(const btCollisionAlgorithmConstructionInfo& info, std::shared_ptr<Registration> registration,
                bool closest);
  ~PairAlgorithm() override;

  void processCollision(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                        const btDispatcherInfo& dispatch, btManifoldResult* result) override;
  btScalar calculateTimeOfImpact(btCollisionObject* body0, btCollisionObject* body1,
                                 const btDispatcherInfo& dispatch, btManifoldResult* result) override;
  void getAllContactManifolds(btManifoldArray& manifolds) override;

  /// See PairContact.
  PackingContact* announce(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
                           btScalar time_step);
  /// Nowhere if it has neither been announced nor processed.
  const PairContact::Place& place() const { return place_; }

 private:
  bool isDone(const btCollisionObjectWrapper& body0, const btCollisionObjectWrapper& body1,
              const btDispatcherInfo& dispatch, const btManifoldResult& result) const;

  std::unique_ptr<PairContact> contact_;
  PairContact::Place place_;  ///< kept here, too: this is in the cache when Bullet asks for the pair
};

/// Bullet allocates algorithms from a pool whose elements have a fixed size and does not check in release
/// builds.
static_assert(sizeof(PairAlgorithm) <= 128);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
