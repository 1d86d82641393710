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
/// this, which might want the same lock.
template <typename Job>
void inParallel(std::size_t count, const Job& job) {
  tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t(0), count, job); });
}

/// Does the same, while this thread first calls here(working), where `working` turns false when all jobs are
/// done. It must not wait for that: there may be no other thread for them.
template <typename Here, typename Job>
void inParallelBeside(const Here& here, std::size_t count, const Job& job) {
  tbb::this_task_arena::isolate([&] {
    std::atomic<bool> working{true};
    tbb::task_group group;
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
