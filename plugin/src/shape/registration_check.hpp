// A world that nobody told of packings.
#pragma once

#include <atomic>
#include <mutex>
#include <unordered_set>

#include <LinearMath/btTransform.h>

#include "innersphere/bullet_precision.hpp"

class btCollisionObject;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A dispatcher was registered.
void noticeRegistration();

/// Bullet asks a shape for its box in every step, and nothing else of it in a world whose dispatcher was not
/// registered, where packings fall through each other. Says so in the log, once that has happened so often
/// that it cannot be somebody who measures shapes: if no dispatcher was registered ever, or if a body with
/// this shape has gone far in all these steps and has met nothing that a registered dispatcher knows of.
/// Safe to use from several threads at once.
class StepWatch {
 public:
  /// The box was asked for at `place`, which for a body is always the same object. No point of the shape is
  /// further than `size` [m] from its origin.
  void notice(const btTransform& place, btScalar size);
  /// A body has met another one in a world that is registered; null: the shape is the child of a compound,
  /// and its place is not known.
  void meet(const btCollisionObject* body);

 private:
  void follow(const btTransform& place, btScalar size);

  std::atomic<bool> done_{false};                      ///< it is a child, or it has been said
  std::atomic<const btTransform*> followed_{nullptr};  ///< one of those that have met nobody
  std::mutex mutex_;
  std::unordered_set<const btTransform*> settled_;  ///< have met another body, or lie somewhere
  btVector3 start_;                                 ///< where the followed one was first
  int steps_ = 0;                                   ///< that it was asked for since then
  int others_ = 0;                                  ///< asked for since it was, last
  int patience_ = 16;                               ///< more than as many others mean that it has gone
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
