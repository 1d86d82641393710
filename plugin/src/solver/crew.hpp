// Threads that go through many short stages together.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A substep has dozens of stages of some microseconds, each of which needs the one before: too short for a
/// task group each. So helpers are called once, and wait for the stages in a loop. A stage has a part for
/// each thread that is there, the same one in each pass, so that what it works on stays in the caches of its
/// core. Nothing depends on helpers: the thread that leads does what they are long in beginning.
class Crew {
 public:
  static constexpr int kMostThreads = 64;

  /// Calls lead(), which may call forEach(), with up to so many helpers. They compute in the caller's
  /// floating-point mode.
  template <typename Lead>
  void work(int helpers, const Lead& lead) {
    helpers = std::min(helpers, kMostThreads - 1);
    if (helpers <= 0) return lead();
    tbb::task_group_context as_here(tbb::task_group_context::bound, tbb::task_group_context::fp_settings);
    tbb::this_task_arena::isolate([&] {
      tbb::task_group group(as_here);
      ended_.store(false, std::memory_order_relaxed);
      const Dismissal dismissal{*this, group};
      for (int i = 0; i < helpers; ++i) group.run([this] { help(); });
      lead();
    });
  }

  /// Calls job(part, parts) for each part of something, which may run at the same time. There are no more
  /// than `most`, and none if that is 0.
  template <typename Job>
  void forEachPart(int most, const Job& job) {
    const int parts = std::min(most, threads_.load(std::memory_order_relaxed));
    if (parts <= 1) {
      if (most > 0) job(0, 1);
      return;
    }
    const auto call = [](const void* context, int part, int of) {
      (*static_cast<const Job*>(context))(part, of);
    };
    publish(call, &job, parts);
  }

  /// Calls job(begin, end) for parts of [0, count), of `grain` at least, which may run at the same time.
  template <typename Job>
  void forEach(int count, int grain, const Job& job) {
    forEachPart((count + grain - 1) / grain, [&](int part, int parts) {
      job(boundOf(count, part, parts), boundOf(count, part + 1, parts));
    });
  }

  /// Returns where a part of [0, count) begins.
  static int boundOf(int count, int part, int parts) {
    return static_cast<int>(std::int64_t(count) * part / parts);
  }

 private:
  using Call = void (*)(const void* job, int part, int parts);
  /// In a line of the caches: who sees a new one has all of it.
  struct alignas(64) Stage {
    /// These are written while no part of a stage is left, and read by those who have begun one.
    Call call = nullptr;
    const void* job = nullptr;
    /// The number of its parts in the lowest byte, its own above.
    std::atomic<std::uint64_t> number{0};
  };
  /// The last stages of which this part has been begun, and finished. Each has a line of the caches.
  struct alignas(64) Part {
    std::atomic<std::uint64_t> begun{0}, finished{0};
  };
  struct Dismissal {
    Crew& crew;
    tbb::task_group& group;
    ~Dismissal() {
      crew.ended_.store(true, std::memory_order_release);
      group.wait();
      crew.threads_.store(1, std::memory_order_relaxed);
    }
  };

  void publish(Call call, const void* job, int parts);
  void take(int part, std::uint64_t stage);
  void help();

  Stage stage_;
  alignas(64) std::atomic<int> threads_{1};  ///< that are there
  std::atomic<bool> ended_{false};
  std::array<Part, kMostThreads> parts_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
