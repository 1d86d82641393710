#include "bullet/packing_pair_algorithm.hpp"

#include <utility>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

PairAlgorithm::PairAlgorithm(const btCollisionAlgorithmConstructionInfo& info,
                             std::shared_ptr<Registration> registration, bool closest)
    : btCollisionAlgorithm(info),
      registration_(std::move(registration)),
      closest_(closest ? std::make_unique<ContactPair>(m_dispatcher) : nullptr),
      pair_(closest ? closest_.get() : &registration_->table().add()) {}

PairAlgorithm::~PairAlgorithm() {
  if (!closest_) registration_->table().remove(*pair_);
}

void PairAlgorithm::processCollision(const btCollisionObjectWrapper* body0,
                                     const btCollisionObjectWrapper* body1, const btDispatcherInfo& dispatch,
                                     btManifoldResult* result) {
  const bool swapped = PackingShape::from(body0->getCollisionShape()) == nullptr;
  if (swapped) std::swap(body0, body1);
  if (swapped && PackingShape::from(body0->getCollisionShape()) == nullptr)
    return;  // the user has given both bodies another shape
  if (closest_) {
    registration_->table().report(*pair_, *body0, *body1, result);
  } else {
    registration_->table().process(*pair_, *body0, *body1, swapped, dispatch, result);
    registration_->table().logSolver();
  }
}

btScalar PairAlgorithm::calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                              btManifoldResult*) {
  return 1;
}

void PairAlgorithm::getAllContactManifolds(btManifoldArray& manifolds) {
  pair_->manifolds.append(manifolds);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
