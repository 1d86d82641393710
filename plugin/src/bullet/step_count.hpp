// Tells the steps of a world apart.
#pragma once

#include <cstdint>
#include <mutex>

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Pairs can be dispatched several times in a step: by character controllers, or by a user who asks for
/// collisions between steps. What must happen once a step counts them.
class StepCount {
 public:
  /// Of the step that a dispatch belongs to, from 1; rises by 1 from step to step.
  std::uint64_t of(const btDispatcherInfo& dispatch) {
    const std::lock_guard<std::mutex> lock(mutex_);
    // A world sets its step count to 0 at the start of each step, and nobody in Bullet writes to it after
    // that. The object is the world's own and not constant.
    int& mark = const_cast<btDispatcherInfo&>(dispatch).m_stepCount;
    if (mark == 0) {
      mark = 1;
      ++count_;
    }
    return count_;
  }

 private:
  std::mutex mutex_;
  std::uint64_t count_ = 0;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
