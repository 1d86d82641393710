// Declares the plug-in's side of the log callback.
#pragma once

#include "innersphere/log.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Hands a message to the user's callback, or writes it to the standard error stream if there is none.
void log(const std::string& message);
/// Does so unless the program has told the same before.
void logOnce(const std::string& message);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
