// Declares the threads of one context.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace innersphere {

/// Holds an arena of its own: while a thread waits here it never takes up foreign tasks, which could use the
/// same context.
class Workers {
 public:
  /// Makes an arena of so many threads; 0: all cores.
  explicit Workers(int threads)
      : arena_(threads > 0 ? threads : static_cast<int>(tbb::task_arena::automatic)),
        serial_(arena_.max_concurrency() == 1) {}

  /// Calls f(begin, end) for ranges that cover [0, n), of about `grain` items. One range is run right here,
  /// others in the same floating-point mode, whatever it was when the arena was first used.
  template <typename F>
  void forRanges(std::size_t n, std::size_t grain, const F& f) {
    if (n == 0) return;
    if (serial_ || n <= grain) return f(std::size_t{0}, n);
    tbb::task_group_context as_here(tbb::task_group_context::bound, tbb::task_group_context::fp_settings);
    arena_.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, n, grain),
          [&](const tbb::blocked_range<std::size_t>& range) { f(range.begin(), range.end()); }, as_here);
    });
  }

 private:
  tbb::task_arena arena_;
  bool serial_;  ///< one thread needs no scheduler
};

}  // namespace innersphere
