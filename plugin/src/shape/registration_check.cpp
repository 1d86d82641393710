#include "shape/registration_check.hpp"

#include <typeinfo>

#include <BulletCollision/CollisionDispatch/btConvexConcaveCollisionAlgorithm.h>

#include "common/log.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

constexpr int kSteps = 60;
std::atomic<bool> registered{false};
std::atomic<bool> none_said{false};

}  // namespace

void noticeRegistration() {
  registered.store(true, std::memory_order_relaxed);
}

void RegistrationCheck::noticeBox(const btTransform& place) {
  if (registered.load(std::memory_order_relaxed) || none_said.load(std::memory_order_relaxed)) return;
  const unsigned count = ++boxes_;
  if ((count & (count - 1)) == 0) {
    // Another body's turn: this one may have gone, or more bodies share the shape than would come round in
    // time.
    followed_ = &place;
    repeats_ = 0;
  } else if (followed_ == &place && ++repeats_ == kSteps && !none_said.exchange(true)) {
    log("No dispatcher was registered: packings fall through each other and through meshes and planes. Call "
        "PackingCollisionAlgorithm::registerAlgorithm with the world's dispatcher.");
  }
}

void RegistrationCheck::noticeTriangles(const btTriangleCallback& callback, const std::string& source) {
  if (typeid(callback) != typeid(btConvexTriangleCallback) || said_.exchange(true)) return;
  none_said = true;
  log("The packing of " + (source.empty() ? "an unknown solid" : "\"" + source + "\"") +
      " is in a world whose dispatcher is not registered: Bullet collides a convex shape with its triangles, "
      "and "
      "packings fall through each other and through meshes and planes. Call "
      "PackingCollisionAlgorithm::registerAlgorithm with that dispatcher.");
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
