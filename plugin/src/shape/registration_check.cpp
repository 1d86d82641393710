#include "shape/registration_check.hpp"

#include <cstdint>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include "common/log.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

constexpr int kSteps = 1000;
constexpr int kMostBodies = 1 << 24;
/// Who has gone less than so many sizes may be lying somewhere.
constexpr btScalar kFar = 10;
std::atomic<bool> registered{false};
std::atomic<int> steps{0};

/// One in sixteen: a look at more bodies than that costs time in each step.
bool chance() {
  static thread_local std::uint32_t state = 0;
  state = state * 1664525u + 1013904223u;
  return state >> 28 == 0;
}

}  // namespace

void noticeRegistration() {
  registered.store(true, std::memory_order_relaxed);
}

void StepWatch::notice(const btTransform& place, btScalar size) {
  if (done_.load(std::memory_order_relaxed)) return;
  if (registered.load(std::memory_order_relaxed)) {
    if (&place == followed_.load(std::memory_order_relaxed) || chance()) follow(place, size);
  } else if (steps.load(std::memory_order_relaxed) < kSteps && ++steps == kSteps) {
    log("No dispatcher was registered: packings fall through each other and through meshes and planes. Call "
        "PackingCollisionAlgorithm::registerAlgorithm with the world's dispatcher.");
  }
}

void StepWatch::meet(const btCollisionObject* body) {
  if (body == nullptr) done_ = true;
  if (done_) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  // Bullet asks for the box at either.
  for (const btTransform* place : {&body->getWorldTransform(), &body->getInterpolationWorldTransform()}) {
    settled_.insert(place);
    if (followed_ == place) followed_ = nullptr;
  }
}

void StepWatch::follow(const btTransform& place, btScalar size) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (followed_ != &place) {
    if (settled_.count(&place) > 0 || (followed_ != nullptr && ++others_ <= patience_)) return;
    // It has gone, or more bodies share the shape than was thought.
    if (followed_ != nullptr && patience_ < kMostBodies) patience_ *= 2;
    followed_ = &place;
    start_ = place.getOrigin();
    steps_ = 0;
  }
  others_ = 0;
  if (++steps_ < kSteps) return;
  followed_ = nullptr;  // another body's turn
  settled_.insert(&place);
  if (!(place.getOrigin().distance(start_) > kFar * size)) return;
  done_ = true;
  log("A packing has gone far in 1,000 steps and met nothing that a registered dispatcher knows of. If it "
      "has fallen through something, call PackingCollisionAlgorithm::registerAlgorithm with the dispatcher "
      "of its world, too.");
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
