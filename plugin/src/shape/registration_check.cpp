#include "shape/registration_check.hpp"

#include <typeinfo>

#include <BulletCollision/CollisionDispatch/btConvexConcaveCollisionAlgorithm.h>

#include "common/log.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Five seconds of one body at 60 Hz, and more bodies than most programs add before they register.
constexpr int kManyBoxes = 300;
std::atomic<bool> registered{false};
std::atomic<int> boxes{0};

}  // namespace

void noticeRegistration() {
  registered.store(true, std::memory_order_relaxed);
}

void noticeBox() {
  if (registered.load(std::memory_order_relaxed) || boxes.load(std::memory_order_relaxed) >= kManyBoxes)
    return;
  if (++boxes != kManyBoxes) return;
  log("No dispatcher was registered so far: packings fall through each other and through meshes and planes. "
      "Call "
      "PackingCollisionAlgorithm::registerAlgorithm with the world's dispatcher before bodies are added.");
}

void RegistrationCheck::noticeTriangles(const btTriangleCallback& callback, const std::string& source) {
  if (typeid(callback) != typeid(btConvexTriangleCallback) || said_.exchange(true)) return;
  log("The packing of " + (source.empty() ? "an unknown solid" : "\"" + source + "\"") +
      " is in a world whose dispatcher is not registered: Bullet collides a convex shape with its triangles, "
      "and "
      "packings fall through each other and through meshes and planes. Call "
      "PackingCollisionAlgorithm::registerAlgorithm with that dispatcher.");
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
