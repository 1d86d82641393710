// Where the plug-in says what it cannot throw: it runs inside Bullet's callbacks.
#pragma once

#include <functional>
#include <string>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Takes one sentence without a line break.
using LogCallback = std::function<void(const std::string& message)>;

/// Replaces the receiver; null restores the default, which writes to the standard error stream. Messages come
/// from the thread that steps the world, one at a time.
void setLogCallback(LogCallback callback);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
