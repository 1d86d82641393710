// All threads for one job of many parts.
#pragma once

#include <cstddef>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Calls job(i) for each i below `count`. The caller may hold a lock: while it waits it takes on no work but
/// this, which might want the same lock.
template <typename Job>
void inParallel(std::size_t count, const Job& job) {
  tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t(0), count, job); });
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
