// Lets the plug-in say what it cannot throw, because it runs inside Bullet's callbacks.
#pragma once

#include <functional>
#include <string>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Receives one message for people, without a line break.
using LogCallback = std::function<void(const std::string& message)>;

/// Replaces the receiver of messages. Null restores the default, which writes to the standard error stream.
/// Messages come one at a time, from whichever thread has found something wrong. The callback must not call
/// setLogCallback(), which would wait for it to return.
void setLogCallback(LogCallback callback);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
