// All threads for one job of many parts.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Asks for the memory of `count` objects, which will be read soon.
template <typename T>
void fetch(const T* first, std::size_t count = 1) {
  constexpr std::uintptr_t kLine = 64;
  const auto begin = reinterpret_cast<std::uintptr_t>(first);
  for (std::uintptr_t at = begin & ~(kLine - 1); at < begin + count * sizeof(T); at += kLine)
    __builtin_prefetch(reinterpret_cast<const void*>(at));
}

namespace in_parallel {

template <typename Job>
void forEachPart(std::size_t count, const Job& job) {
  tbb::parallel_for(std::size_t(0), count, job);
}

template <typename Job, typename... Fetches>
void forEachPart(std::size_t count, const Job& job, const Fetches&... fetches) {
  constexpr std::size_t kGrain = 16;
  constexpr std::size_t kAhead = 3;  // parts: memory takes about as long as the jobs of two or three
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain), [&](const auto& range) {
    for (std::size_t i = 0; i < range.size() + sizeof...(fetches) * kAhead; ++i) {
      std::size_t part = i;  // before the first one it is larger than all of them
      ((part < range.size() ? fetches(range.begin() + part) : void(), part -= kAhead), ...);
      if (part < range.size()) job(range.begin() + part);
    }
  });
}

}  // namespace in_parallel

/// Calls job(i) for each i below `count`. The caller may hold a lock: while it waits it takes on no work but
/// this, which might want the same lock.
///
/// Parts are often far from each other in memory. Each of `fetches` is called for a part, too, by the thread
/// that does its job a little later, the first one first, so that it can ask for what the next one, or the
/// job, is about to read: see fetch().
template <typename Job, typename... Fetches>
void inParallel(std::size_t count, const Job& job, const Fetches&... fetches) {
  tbb::this_task_arena::isolate([&] { in_parallel::forEachPart(count, job, fetches...); });
}

/// The same, while this thread first does something else: here(working), where `working` turns false when all
/// jobs are done. It must not wait for that: there may be no other thread for them.
template <typename Here, typename Job, typename... Fetches>
void inParallelBeside(const Here& here, std::size_t count, const Job& job, const Fetches&... fetches) {
  tbb::this_task_arena::isolate([&] {
    std::atomic<bool> working{true};
    tbb::task_group group;
    group.run([&] {
      in_parallel::forEachPart(count, job, fetches...);
      working = false;
    });
    here(working);
    group.wait();
  });
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
