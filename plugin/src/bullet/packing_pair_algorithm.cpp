#include "bullet/packing_pair_algorithm.hpp"

#include <typeinfo>
#include <utility>

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
  if (isDone(*body0, *body1, dispatch, *result)) return;
  const bool swapped = PackingShape::from(body0->getCollisionShape()) == nullptr;
  if (swapped) std::swap(body0, body1);
  if (PackingShape::from(body0->getCollisionShape()) == nullptr)
    return;  // the user has given both bodies another shape
  contact_->process(*body0, *body1, swapped, dispatch, result);
  place_ = contact_->place();
}

bool PairAlgorithm::isDone(const btCollisionObjectWrapper& body0, const btCollisionObjectWrapper& body1,
                           const btDispatcherInfo& dispatch, const btManifoldResult& result) const {
  if (place_.board == nullptr || result.m_closestPointDistanceThreshold != 0 ||
      typeid(result) != typeid(btManifoldResult))
    return false;
  const bool swapped = place_.swapped;
  return place_.board->isDone(*place_.look, swapped ? body1 : body0, swapped ? body0 : body1,
                              dispatch.m_timeStep, this);
}

PackingContact* PairAlgorithm::announce(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
                                        btScalar time_step) {
  PackingContact* fresh = contact_->announce(a, b, time_step);
  place_ = contact_->place();
  return fresh;
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
