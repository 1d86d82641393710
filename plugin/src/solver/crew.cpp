#include "solver/crew.hpp"

#include <thread>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

constexpr std::uint64_t kStage = 256;  ///< from one stage to the next; what is left is its parts
static_assert(Crew::kMostThreads < kStage);

int partsOf(std::uint64_t stage) {
  return static_cast<int>(stage % kStage);
}

/// Looks this often before it lets other programs have the processor.
constexpr int kPatience = 64;

/// Waits a moment. Returns true if that was for long.
bool pause(int& asked) {
#if defined(__x86_64__)
  __builtin_ia32_pause();  // lets the other thread of the core go on
#endif
  if (++asked < kPatience) return false;
  asked = 0;
  std::this_thread::yield();
  return true;
}

}  // namespace

/// A stage cannot end while a part of it is begun and not finished: what was begun under its number is of it.
void Crew::take(int index, std::uint64_t stage) {
  Part& part = parts_[static_cast<std::size_t>(index)];
  std::uint64_t begun = part.begun.load(std::memory_order_relaxed);
  if (begun >= stage || !part.begun.compare_exchange_strong(begun, stage, std::memory_order_acq_rel)) return;
  stage_.call(stage_.job, index, partsOf(stage));
  part.finished.store(stage, std::memory_order_release);
}

void Crew::publish(Call call, const void* job, int parts) {
  stage_.call = call;
  stage_.job = job;
  const std::uint64_t before = stage_.number.load(std::memory_order_relaxed) / kStage;
  const std::uint64_t current = (before + 1) * kStage + static_cast<std::uint64_t>(parts);
  stage_.number.store(current, std::memory_order_release);
  take(0, current);
  for (int i = 1; i < parts; ++i) {
    const Part& part = parts_[static_cast<std::size_t>(i)];
    for (int asked = 0; part.finished.load(std::memory_order_acquire) != current;) {
      if (pause(asked)) take(i, current);
    }
  }
}

void Crew::help() {
  const int thread = threads_.fetch_add(1, std::memory_order_relaxed);
  std::uint64_t seen = 0;
  for (int asked = 0; !ended_.load(std::memory_order_acquire);) {
    const std::uint64_t current = stage_.number.load(std::memory_order_acquire);
    if (current == seen) {
      pause(asked);
      continue;
    }
    seen = current;
    asked = 0;
    if (thread < partsOf(current)) take(thread, current);
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
