// Counts how much of the work on contacts was saved from step to step.
#pragma once

#include <cstddef>

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Counts what was done for pairs with a packing since their dispatcher was registered; registering it again
/// does not reset the counts. A pair that Bullet asks for counts once a step. With ContactOptions::reuse =
/// Reuse::search all are searched.
struct ContactStatistics {
  /// The number of pairs that were left alone, because their bodies stay apart.
  std::size_t idle = 0;
  /// The number of pairs whose contacts were moved along with the bodies.
  std::size_t transported = 0;
  /// The number of pairs whose depth was to be evaluated again where contact was found before.
  std::size_t refined = 0;
  /// The number of pairs for which contact was searched.
  std::size_t searched = 0;
  /// The number of shared searches of packings: at best one a step.
  std::size_t queries = 0;
};

/// Returns the counts of a dispatcher. Throws Error bad_argument if PackingCollisionAlgorithm is not
/// registered with it.
ContactStatistics contactStatistics(const btDispatcher* dispatcher);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
