// A world that nobody told of packings.
#pragma once

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A dispatcher was registered.
void noticeRegistration();

/// Bullet asks a shape for its box in every step. Once that has happened so often that it cannot be somebody
/// who measures shapes, and no dispatcher was registered ever, says so in the log: packings would fall
/// through each other without a word.
void noticeStep();

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
