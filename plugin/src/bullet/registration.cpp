#include "bullet/registration.hpp"

#include <map>
#include <new>

#include <BulletCollision/CollisionDispatch/btCollisionConfiguration.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include "bullet/packing_pair_algorithm.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

btCollisionAlgorithm* CreateFunc::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                           const btCollisionObjectWrapper* body0,
                                                           const btCollisionObjectWrapper* body1) {
  const bool ours = PackingShape::from(body0->getCollisionShape()) != nullptr ||
                    PackingShape::from(body1->getCollisionShape()) != nullptr;
  if (!ours) return previous_->CreateCollisionAlgorithm(info, body0, body1);
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(PairAlgorithm));
  return new (memory) PairAlgorithm(info, registration_.shared_from_this(), closest_);
}

namespace {

struct Registrations {
  std::mutex mutex;
  std::map<btCollisionDispatcher*, std::shared_ptr<Registration>> of;
};

Registrations& registrations() {
  // Never destroyed: worlds in static storage may outlive it otherwise.
  static Registrations& all = *new Registrations;
  return all;
}

/// Of the dispatcher's tables that lead to us.
template <typename Visit>
void forEachRow(const Visit& visit) {
  for (int type = 0; type < MAX_BROADPHASE_COLLISION_TYPES; ++type) {
    if (type == COMPOUND_SHAPE_PROXYTYPE || type == SOFTBODY_SHAPE_PROXYTYPE) continue;
    visit(type, kPackingShapeType);
    if (type != kPackingShapeType) visit(kPackingShapeType, type);
  }
}

/// The table can be written from outside, but only be read by dispatchers.
struct Reader : btCollisionDispatcher {
  static const btCollisionAlgorithmCreateFunc* read(const btCollisionDispatcher& dispatcher) {
    return (dispatcher.*(&Reader::m_doubleDispatchContactPoints))[kPackingShapeType][kPackingShapeType];
  }
};

}  // namespace

std::shared_ptr<Registration> Registration::of(btCollisionDispatcher* dispatcher) {
  Registrations& all = registrations();
  const std::lock_guard<std::mutex> lock(all.mutex);
  std::shared_ptr<Registration>& registration = all.of[dispatcher];
  if (!registration) registration = std::make_shared<Registration>();
  return registration;
}

std::shared_ptr<Registration> Registration::find(btCollisionDispatcher* dispatcher) {
  Registrations& all = registrations();
  const std::lock_guard<std::mutex> lock(all.mutex);
  const auto found = all.of.find(dispatcher);
  return found == all.of.end() ? nullptr : found->second;
}

void Registration::setOptions(const ContactOptions& options) {
  batch_.setOptions(options);
  surfaces_.setOptions(options);
  const std::lock_guard<std::mutex> lock(mutex_);
  options_ = options;
}

ContactOptions Registration::options() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return options_;
}

std::shared_ptr<Registration> Registration::take(btCollisionDispatcher* dispatcher) {
  std::shared_ptr<Registration> taken = find(dispatcher);
  Registrations& all = registrations();
  const std::lock_guard<std::mutex> lock(all.mutex);
  all.of.erase(dispatcher);
  return taken;
}

void Registration::fillTables(btCollisionDispatcher* dispatcher) {
  // Not the dispatcher's own table, which may hold our functions already, but what the configuration started
  // it with.
  btCollisionConfiguration* defaults = dispatcher->getCollisionConfiguration();
  const std::lock_guard<std::mutex> lock(mutex_);
  create_funcs_.clear();
  forEachRow([&](int type0, int type1) {
    create_funcs_.emplace_back(*this, defaults->getCollisionAlgorithmCreateFunc(type0, type1), false);
    dispatcher->registerCollisionCreateFunc(type0, type1, &create_funcs_.back());
    create_funcs_.emplace_back(*this, defaults->getClosestPointsAlgorithmCreateFunc(type0, type1), true);
    dispatcher->registerClosestPointsCreateFunc(type0, type1, &create_funcs_.back());
  });
}

void Registration::clearTables(btCollisionDispatcher* dispatcher) {
  btCollisionConfiguration* defaults = dispatcher->getCollisionConfiguration();
  forEachRow([&](int type0, int type1) {
    dispatcher->registerCollisionCreateFunc(type0, type1,
                                            defaults->getCollisionAlgorithmCreateFunc(type0, type1));
    dispatcher->registerClosestPointsCreateFunc(type0, type1,
                                                defaults->getClosestPointsAlgorithmCreateFunc(type0, type1));
  });
}

bool Registration::hasTables(const btCollisionDispatcher& dispatcher) {
  return dynamic_cast<const CreateFunc*>(Reader::read(dispatcher)) != nullptr;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
