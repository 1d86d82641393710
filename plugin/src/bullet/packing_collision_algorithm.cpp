#include "innersphere/packing_collision_algorithm.hpp"

#include <string>

#include <BulletCollision/CollisionDispatch/btCollisionConfiguration.h>
#include <LinearMath/btPoolAllocator.h>

#include "bullet/packing_pair_algorithm.hpp"
#include "innersphere/error.hpp"
#include "response/option_rules.hpp"
#include "shape/registration_check.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Null if it is null or none.
btCollisionDispatcher* collisionDispatcher(btDispatcher* dispatcher) {
  return dynamic_cast<btCollisionDispatcher*>(dispatcher);
}

btCollisionDispatcher& checked(btDispatcher* dispatcher) {
  if (dispatcher == nullptr)
    throw Error(ErrorCode::bad_argument,
                "registerAlgorithm needs a dispatcher; it was given a null pointer.");
  btCollisionDispatcher* collision = collisionDispatcher(dispatcher);
  if (collision == nullptr) {
    throw Error(
        ErrorCode::bad_argument,
        "registerAlgorithm needs a btCollisionDispatcher or a class derived from it: it writes to the "
        "table that Bullet chooses collision algorithms from, which this dispatcher does not have.");
  }
  if (collision->getCollisionConfiguration() == nullptr)
    throw Error(ErrorCode::bad_argument,
                "registerAlgorithm needs a dispatcher with a collision configuration.");
  return *collision;
}

}  // namespace

void PackingCollisionAlgorithm::registerAlgorithm(btDispatcher* of_world, const ContactOptions& options) {
  btCollisionDispatcher& dispatcher = checked(of_world);
  checkOptions(options);
  if (options.backend == Backend::cuda && !cudaAvailable()) {
    throw Error(ErrorCode::no_device,
                "ContactOptions::backend is cuda, but there is no CUDA device; use automatic or cpu.");
  }
  const btPoolAllocator* pool = dispatcher.getCollisionConfiguration()->getCollisionAlgorithmPool();
  if (pool != nullptr && pool->getElementSize() < static_cast<int>(sizeof(PairAlgorithm))) {
    throw Error(ErrorCode::bad_argument, "The collision algorithm pool has elements of " +
                                             std::to_string(pool->getElementSize()) +
                                             " bytes; set m_customCollisionAlgorithmMaxElementSize to " +
                                             std::to_string(sizeof(PairAlgorithm)) +
                                             " or more in btDefaultCollisionConstructionInfo.");
  }
  const std::shared_ptr<Registration> registration = Registration::of(&dispatcher);
  registration->setOptions(options);
  noticeRegistration();
  registration->fillTables(&dispatcher);
}

void PackingCollisionAlgorithm::unregisterAlgorithm(btDispatcher* dispatcher) {
  btCollisionDispatcher* collision = collisionDispatcher(dispatcher);
  if (const std::shared_ptr<Registration> registration = Registration::take(collision)) {
    registration->clearTables(collision);
  }
}

bool PackingCollisionAlgorithm::isRegistered(const btDispatcher* dispatcher) {
  const auto* collision = dynamic_cast<const btCollisionDispatcher*>(dispatcher);
  return collision != nullptr && Registration::hasTables(*collision);
}

ContactOptions PackingCollisionAlgorithm::options(const btDispatcher* dispatcher) {
  const std::shared_ptr<Registration> registration =
      isRegistered(dispatcher)
          ? Registration::find(collisionDispatcher(const_cast<btDispatcher*>(dispatcher)))
          : nullptr;
  if (!registration) {
    throw Error(ErrorCode::bad_argument,
                "options needs a dispatcher that PackingCollisionAlgorithm is registered with.");
  }
  return registration->options();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
