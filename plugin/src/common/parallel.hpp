// Runs one job of many parts with all threads.
#pragma once

#include <atomic>
#include <cstddef>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Calls job(i) for each i below `count`. The caller may hold a lock: while it waits it takes on no work but
/// this, which might want the same lock. Jobs compute in the caller's floating-point mode. Otherwise it would
/// be the mode of whoever was the first to use the scheduler: Embree, say, takes tiny numbers for 0 at that
/// time, so bodies would move in another way in a program that uses both.
template <typename Job>
void inParallel(std::size_t count, const Job& job) {
  if (count == 1 || tbb::this_task_arena::max_concurrency() == 1) {
    for (std::size_t i = 0; i < count; ++i) job(i);
    return;
  }
  tbb::task_group_context as_here(tbb::task_group_context::bound, tbb::task_group_context::fp_settings);
  tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t(0), count, job, as_here); });
}

/// Does the same, while this thread first calls here(working), where `working` turns false when all jobs are
/// done. It must not wait for that: there may be no other thread for them.
template <typename Here, typename Job>
void inParallelBeside(const Here& here, std::size_t count, const Job& job) {
  tbb::task_group_context as_here(tbb::task_group_context::bound, tbb::task_group_context::fp_settings);
  tbb::this_task_arena::isolate([&] {
    std::atomic<bool> working{true};
    tbb::task_group group(as_here);
    group.run([&] {
      tbb::parallel_for(std::size_t(0), count, job);
      working = false;
    });
    here(working);
    group.wait();
  });
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
