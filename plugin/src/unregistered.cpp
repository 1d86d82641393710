#include "unregistered.hpp"

#include <atomic>

#include "log.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

constexpr int kSteps = 1000;
std::atomic<bool> registered{false};
std::atomic<int> steps{0};

}  // namespace

void noticeRegistration() {
  registered.store(true, std::memory_order_relaxed);
}

void noticeStep() {
  if (registered.load(std::memory_order_relaxed) || steps.load(std::memory_order_relaxed) > kSteps) return;
  if (++steps == kSteps) {
    log("No dispatcher was registered: packings fall through each other and through meshes and planes. Call "
        "PackingCollisionAlgorithm::registerAlgorithm with the world's dispatcher.");
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
