// Declares Bullet's collision algorithm for a pair with a packing in it.
#pragma once

#include <memory>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>

#include "bullet/registration.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds a pair of the table, and hands on what Bullet asks of it.
class PairAlgorithm : public btCollisionAlgorithm {
 public:
  /// Adds a pair to the table, or, if `closest`, answers closest-point queries without touching the
  /// dispatcher's manifolds.
  PairAlgorithm(const btCollisionAlgorithmConstructionInfo& info, std::shared_ptr<Registration> registration,
                bool closest);
  ~PairAlgorithm() override;

  void processCollision(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                        const btDispatcherInfo& dispatch, btManifoldResult* result) override;
  /// Returns 1, the end of the step: the algorithm looks for no earlier impact.
  btScalar calculateTimeOfImpact(btCollisionObject* body0, btCollisionObject* body1,
                                 const btDispatcherInfo& dispatch, btManifoldResult* result) override;
  void getAllContactManifolds(btManifoldArray& manifolds) override;

  ContactPair& pair() { return *pair_; }

 private:
  const std::shared_ptr<Registration> registration_;
  const std::unique_ptr<ContactPair> closest_;  ///< null for a pair of the table
  ContactPair* const pair_;
};

/// Bullet allocates algorithms from a pool whose elements have a fixed size and does not check in release
/// builds.
static_assert(sizeof(PairAlgorithm) <= 128);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
