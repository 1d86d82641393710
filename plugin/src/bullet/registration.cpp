#include "bullet/registration.hpp"

#include <algorithm>
#include <mutex>
#include <new>
#include <vector>

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

/// Keeps registrations for the tables that lead to them.
struct Kept {
  std::mutex mutex;
  std::vector<std::shared_ptr<Registration>> registrations;
};

Kept& kept() {
  // Never destroyed: worlds in static storage may outlive it otherwise.
  static Kept& all = *new Kept;
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

Registration& Registration::of(btCollisionDispatcher* dispatcher) {
  if (const std::shared_ptr<Registration> found = find(dispatcher)) {
    found->fillTables(dispatcher);
    return *found;
  }
  const auto made = std::make_shared<Registration>(dispatcher);
  made->fillTables(dispatcher);
  const std::lock_guard<std::mutex> lock(kept().mutex);
  return *kept().registrations.emplace_back(made);
}

std::shared_ptr<Registration> Registration::find(const btCollisionDispatcher* dispatcher) {
  if (dispatcher == nullptr) return nullptr;
  const auto* row = dynamic_cast<const CreateFunc*>(Reader::read(*dispatcher));
  return row == nullptr ? nullptr : row->registration().shared_from_this();
}

void Registration::remove(btCollisionDispatcher* dispatcher) {
  const std::shared_ptr<Registration> found = find(dispatcher);
  if (!found) return;
  btCollisionConfiguration* defaults = dispatcher->getCollisionConfiguration();
  forEachRow([&](int type0, int type1) {
    dispatcher->registerCollisionCreateFunc(type0, type1,
                                            defaults->getCollisionAlgorithmCreateFunc(type0, type1));
    dispatcher->registerClosestPointsCreateFunc(type0, type1,
                                                defaults->getClosestPointsAlgorithmCreateFunc(type0, type1));
  });
  const std::lock_guard<std::mutex> lock(kept().mutex);
  std::erase(kept().registrations, found);
}

void Registration::forget(const btDispatcher* gone) noexcept {
  const std::lock_guard<std::mutex> lock(kept().mutex);
  std::erase_if(kept().registrations, [&](const auto& one) { return one->dispatcher_ == gone; });
}

void Registration::fillTables(btCollisionDispatcher* dispatcher) {
  // Not the dispatcher's own table, which may hold our functions already, but what the configuration started
  // it with.
  btCollisionConfiguration* defaults = dispatcher->getCollisionConfiguration();
  create_funcs_.clear();
  forEachRow([&](int type0, int type1) {
    create_funcs_.emplace_back(*this, defaults->getCollisionAlgorithmCreateFunc(type0, type1), false);
    dispatcher->registerCollisionCreateFunc(type0, type1, &create_funcs_.back());
    create_funcs_.emplace_back(*this, defaults->getClosestPointsAlgorithmCreateFunc(type0, type1), true);
    dispatcher->registerClosestPointsCreateFunc(type0, type1, &create_funcs_.back());
  });
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
