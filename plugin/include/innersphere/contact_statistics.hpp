// How much of the work on contacts was saved from step to step.
#pragma once

#include <cstddef>

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Counts of what was done for pairs with a packing, from the registration of their dispatcher on. A pair
/// that Bullet asks for counts once a step. With ContactOptions::reuse = Reuse::search all are searched.
struct ContactStatistics {
  std::size_t idle = 0;         ///< pairs that were left alone, because their bodies stay apart
  std::size_t transported = 0;  ///< pairs whose contacts were moved along with the bodies
  std::size_t refined = 0;      ///< pairs whose depth was evaluated again where contact was found before
  std::size_t searched = 0;     ///< pairs for which contact was searched
  std::size_t queries = 0;      ///< searches of packings that were made together: at best one a step
};

/// The counts of a dispatcher. Throws Error bad_argument if PackingCollisionAlgorithm is not registered with
/// it.
ContactStatistics contactStatistics(const btDispatcher* dispatcher);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
