// Makes the threads of a packer.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace innersphere {

/// Returns how many threads an arena asks oneTBB for; 0: all cores. No more than it gives: asked for more it
/// says so on stderr.
inline int arenaThreads(int threads) {
  if (threads <= 0) return tbb::task_arena::automatic;
  const auto most = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return static_cast<int>(std::min(static_cast<std::size_t>(threads), most));
}

}  // namespace innersphere
