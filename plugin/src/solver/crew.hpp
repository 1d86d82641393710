// Threads that go through many short stages together.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A substep has dozens of stages of some microseconds, each of which needs the one before: too short for a
/// task group each. So helpers are called once, and wait for the stages in a loop. Nothing depends on them:
/// the thread that leads takes every part that no helper has begun, and helpers that come late find nothing
/// to do.
class Crew {
 public:
  /// Calls lead(), which may call forEach(), with up to so many helpers.
  template <typename Lead>
  void work(int helpers, const Lead& lead) {
    if (helpers <= 0) return lead();
    tbb::this_task_arena::isolate([&] {
      tbb::task_group group;
      ended_.store(false, std::memory_order_relaxed);
      const Dismissal dismissal{*this, group};
      helped_ = true;
      for (int i = 0; i < helpers; ++i) group.run([this] { help(); });
      lead();
    });
  }

  /// Calls job(begin, end) for parts of [0, count) of up to `grain`, which may run at the same time.
  template <typename Job>
  void forEach(int count, int grain, const Job& job) {
    if (!helped_ || count <= grain) {
      if (count > 0) job(0, count);
      return;
    }
    const auto part = [](const void* context, int begin, int end) {
      (*static_cast<const Job*>(context))(begin, end);
    };
    publish({part, &job, count, grain});
  }

 private:
  using Part = void (*)(const void*, int, int);
  struct Stage {
    Part part;
    const void* job;
    int count, grain;
  };
  struct Dismissal {
    Crew& crew;
    tbb::task_group& group;
    ~Dismissal() {
      crew.ended_.store(true, std::memory_order_release);
      crew.helped_ = false;
      group.wait();
    }
  };

  void publish(const Stage& stage);
  bool takePart();
  void help();

  bool helped_ = false;
  std::atomic<bool> ended_{false};
  /// The number of the stage in the upper half, the next part in the lower one: who raises it has that part.
  std::atomic<std::uint64_t> ticket_{0};
  std::atomic<int> done_{0};
  std::atomic<Part> part_{nullptr};
  std::atomic<const void*> job_{nullptr};
  std::atomic<int> count_{0}, grain_{1};
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
