#include "innersphere/packing_collision_algorithm.hpp"

#include <cmath>
#include <string>

#include <BulletCollision/CollisionDispatch/btCollisionConfiguration.h>
#include <LinearMath/btPoolAllocator.h>

#include "bullet/packing_pair_algorithm.hpp"
#include "innersphere/contact_statistics.hpp"
#include "innersphere/error.hpp"
#include "shape/registration_check.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

void check(const btCollisionDispatcher* dispatcher, const ContactOptions& options) {
  if (dispatcher == nullptr || dispatcher->getCollisionConfiguration() == nullptr) {
    throw Error(ErrorCode::bad_argument,
                "registerAlgorithm needs a dispatcher with a collision configuration.");
  }
  if (!(std::isfinite(options.stiffness) && options.stiffness >= 0)) {
    throw Error(ErrorCode::bad_argument, "ContactOptions::stiffness is " + std::to_string(options.stiffness) +
                                             "; it must be 0 (default) or a positive number of N/m^3.");
  }
  if (!(std::isfinite(options.damping) && options.damping >= 0)) {
    throw Error(ErrorCode::bad_argument, "ContactOptions::damping is " + std::to_string(options.damping) +
                                             "; it must be a fraction of critical damping, 0 or more.");
  }
  if (!(std::isfinite(options.accuracy) && options.accuracy >= 0)) {
    throw Error(ErrorCode::bad_argument, "ContactOptions::accuracy is " + std::to_string(options.accuracy) +
                                             "; it must be 0 (all spheres) or a positive number of metres.");
  }
  if (options.backend == Backend::cuda && !cudaAvailable()) {
    throw Error(ErrorCode::no_device,
                "ContactOptions::backend is cuda, but there is no CUDA device; use automatic or cpu.");
  }
}

}  // namespace

void PackingCollisionAlgorithm::registerAlgorithm(btCollisionDispatcher* dispatcher,
                                                  const ContactOptions& options) {
  check(dispatcher, options);
  const btPoolAllocator* pool = dispatcher->getCollisionConfiguration()->getCollisionAlgorithmPool();
  if (pool != nullptr && pool->getElementSize() < static_cast<int>(sizeof(PairAlgorithm))) {
    throw Error(ErrorCode::bad_argument, "The collision algorithm pool has elements of " +
                                             std::to_string(pool->getElementSize()) +
                                             " bytes; set m_customCollisionAlgorithmMaxElementSize to " +
                                             std::to_string(sizeof(PairAlgorithm)) +
                                             " or more in btDefaultCollisionConstructionInfo.");
  }
  Registration::of(dispatcher).table().setOptions(options);
  noticeRegistration();
}

void PackingCollisionAlgorithm::unregisterAlgorithm(btCollisionDispatcher* dispatcher) {
  if (dispatcher != nullptr) Registration::remove(dispatcher);
}

bool PackingCollisionAlgorithm::isRegistered(const btCollisionDispatcher* dispatcher) {
  return Registration::find(dispatcher) != nullptr;
}

ContactStatistics contactStatistics(btCollisionDispatcher* dispatcher) {
  const std::shared_ptr<Registration> registration = Registration::find(dispatcher);
  if (!registration) {
    throw Error(ErrorCode::bad_argument,
                "contactStatistics needs a dispatcher that PackingCollisionAlgorithm is registered with.");
  }
  return registration->table().statistics();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
