// A world that nobody told of packings.
#pragma once

#include <atomic>
#include <mutex>

#include <LinearMath/btTransform.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A dispatcher was registered.
void noticeRegistration();

/// Bullet asks a shape for its box in every step, and nothing else of it in a world whose dispatcher was not
/// registered, where packings fall through each other. Says so in the log, once that has happened so often
/// that it cannot be somebody who measures shapes: if no dispatcher was registered ever, or if a body with
/// this shape has gone far in all these steps and no dispatcher that was registered has met the shape.
class StepWatch {
 public:
  /// The box was asked for at `place`; no point of the shape is further than `size` [m] from its origin.
  void notice(const btTransform& place, btScalar size);
  /// Of a dispatcher that is registered.
  void meet() {
    if (!met_.load(std::memory_order_relaxed)) met_.store(true, std::memory_order_relaxed);
  }

 private:
  void follow(const btTransform& place, btScalar size);

  std::atomic<bool> met_{false};
  std::mutex mutex_;
  const btTransform* watched_ = nullptr;  ///< of one of the shape's bodies, as it names it in each step
  btVector3 start_;                       ///< where it was first
  int steps_ = 0;                         ///< of that body since then
  int others_ = 0;                        ///< asked for since it was, last
  int patience_ = 1;                      ///< as many may be, if all of them are asked for in turn
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
