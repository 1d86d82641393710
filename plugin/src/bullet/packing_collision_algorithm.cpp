#include "innersphere/packing_collision_algorithm.hpp"

#include <string>

#include <BulletCollision/CollisionDispatch/btCollisionConfiguration.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>
#include <LinearMath/btPoolAllocator.h>

#include "bullet/packing_pair_algorithm.hpp"
#include "innersphere/contact_statistics.hpp"
#include "innersphere/error.hpp"
#include "innersphere/pair_overlaps.hpp"
#include "shape/option_rules.hpp"
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

PairTable& tableOf(const btDispatcher* dispatcher, const std::string& asked) {
  const auto registration = Registration::find(dynamic_cast<const btCollisionDispatcher*>(dispatcher));
  if (!registration) {
    throw Error(ErrorCode::bad_argument,
                asked + " needs a dispatcher that PackingCollisionAlgorithm is registered with.");
  }
  return registration->table();
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
  PairTable& table = Registration::of(&dispatcher).table();
  table.setOptions(options);
  table.setWorld(nullptr);
  noticeRegistration();
}

void PackingCollisionAlgorithm::registerAlgorithm(btDynamicsWorld& world, const ContactOptions& options) {
  registerAlgorithm(world.getDispatcher(), options);
  Registration::find(collisionDispatcher(world.getDispatcher()))->table().setWorld(&world);
}

void PackingCollisionAlgorithm::prepareWorld(btDynamicsWorld& world, const ContactOptions& options) {
  registerAlgorithm(world, options);
  world.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
}

void PackingCollisionAlgorithm::unregisterAlgorithm(btDispatcher* dispatcher) {
  if (btCollisionDispatcher* collision = collisionDispatcher(dispatcher)) Registration::remove(collision);
}

void PackingCollisionAlgorithm::forget(const btDispatcher* gone) noexcept {
  Registration::forget(gone);
}

bool PackingCollisionAlgorithm::isRegistered(const btDispatcher* dispatcher) {
  return Registration::find(dynamic_cast<const btCollisionDispatcher*>(dispatcher)) != nullptr;
}

ContactOptions PackingCollisionAlgorithm::options(const btDispatcher* dispatcher) {
  return tableOf(dispatcher, "options").options();
}

ContactStatistics contactStatistics(const btDispatcher* dispatcher) {
  return tableOf(dispatcher, "contactStatistics").statistics();
}

std::vector<PairOverlap> pairOverlaps(btDispatcher* dispatcher) {
  return tableOf(dispatcher, "pairOverlaps").overlaps();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
