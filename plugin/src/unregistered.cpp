#include "unregistered.hpp"

#include "log.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

constexpr int kSteps = 1000;
constexpr int kMostBodies = 1 << 24;
/// Who has gone less than so many sizes may be lying somewhere.
constexpr btScalar kFar = 10;
std::atomic<bool> registered{false};
std::atomic<int> steps{0};

}  // namespace

void noticeRegistration() {
  registered.store(true, std::memory_order_relaxed);
}

void StepWatch::notice(const btTransform& place, btScalar size) {
  if (met_.load(std::memory_order_relaxed)) return;
  if (registered.load(std::memory_order_relaxed)) {
    follow(place, size);
  } else if (steps.load(std::memory_order_relaxed) < kSteps && ++steps == kSteps) {
    log("No dispatcher was registered: packings fall through each other and through meshes and planes. Call "
        "PackingCollisionAlgorithm::registerAlgorithm with the world's dispatcher.");
  }
}

void StepWatch::follow(const btTransform& place, btScalar size) {
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock) return;
  if (watched_ != &place) {
    if (watched_ != nullptr && ++others_ <= patience_) return;
    // It has gone, or more bodies share the shape than was thought.
    if (steps_ < kSteps && patience_ < kMostBodies) patience_ *= 2;
    watched_ = &place;
    start_ = place.getOrigin();
    steps_ = 0;
  }
  others_ = 0;
  if (++steps_ < kSteps) return;
  if (place.getOrigin().distance(start_) > kFar * size) {
    met_ = true;
    log("A packing has gone far in 1,000 steps, and no dispatcher that was registered has met it. If it has "
        "fallen through something, call PackingCollisionAlgorithm::registerAlgorithm with the dispatcher of "
        "its world, too.");
  }
  others_ = patience_;  // another body's turn
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
