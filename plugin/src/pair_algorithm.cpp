#include "pair_algorithm.hpp"

#include <utility>

#include "pair_contact.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

PairAlgorithm::PairAlgorithm(const btCollisionAlgorithmConstructionInfo& info,
                             std::shared_ptr<Registration> registration, bool closest)
    : btCollisionAlgorithm(info),
      contact_(std::make_unique<PairContact>(m_dispatcher, std::move(registration), closest)) {}

PairAlgorithm::~PairAlgorithm() = default;

void PairAlgorithm::processCollision(const btCollisionObjectWrapper* body0,
                                     const btCollisionObjectWrapper* body1, const btDispatcherInfo& dispatch,
                                     btManifoldResult* result) {
  if (PackingShape::from(body0->getCollisionShape()) == nullptr) std::swap(body0, body1);
  if (PackingShape::from(body0->getCollisionShape()) == nullptr)
    return;  // the user has given both bodies another shape
  contact_->process(*body0, *body1, dispatch, result);
}

btScalar PairAlgorithm::calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                              btManifoldResult*) {
  return 1;
}

void PairAlgorithm::getAllContactManifolds(btManifoldArray& manifolds) {
  contact_->appendManifolds(manifolds);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
