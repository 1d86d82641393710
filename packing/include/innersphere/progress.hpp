// Long work reports how far it is and can be cancelled.
#pragma once

#include <functional>

namespace innersphere {

/// This function is called from the thread that started the work, some times a second, with the stage and the
/// finished fraction of it, 0 to 1. Return false to cancel: the work then throws Error with
/// ErrorCode::cancelled and leaves nothing behind.
using Progress = std::function<bool(const char* stage, double fraction)>;

}  // namespace innersphere
