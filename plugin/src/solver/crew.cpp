#include "solver/crew.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

constexpr std::uint64_t kStage = std::uint64_t(1) << 32;

/// Looks this often before it lets other programs have the processor.
constexpr int kPatience = 256;

/// Waits a moment, longer the more often it was asked.
void pause(int& asked) {
  if (++asked < kPatience) return;
  asked = 0;
  std::this_thread::yield();
}

}  // namespace

/// A part that is taken keeps its stage alive, so that what is read after that is of this stage. What was
/// read before may be of another; then the ticket has changed.
bool Crew::takePart() {
  std::uint64_t ticket = ticket_.load(std::memory_order_acquire);
  for (;;) {
    const int count = count_.load(std::memory_order_acquire);
    const int begin = static_cast<int>(ticket % kStage) * grain_.load(std::memory_order_relaxed);
    if (begin >= count) return false;
    if (ticket_.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel)) break;
  }
  const int grain = grain_.load(std::memory_order_relaxed), count = count_.load(std::memory_order_relaxed);
  const int begin = static_cast<int>(ticket % kStage) * grain;
  part_.load(std::memory_order_relaxed)(job_.load(std::memory_order_relaxed), begin,
                                        std::min(begin + grain, count));
  done_.fetch_add(1, std::memory_order_release);
  return true;
}

void Crew::publish(const Stage& stage) {
  const int parts = (stage.count + stage.grain - 1) / stage.grain;
  // Nobody finds a part while the count is that of no stage.
  count_.store(0, std::memory_order_relaxed);
  done_.store(0, std::memory_order_relaxed);
  const std::uint64_t number = ticket_.load(std::memory_order_relaxed) / kStage + 1;
  ticket_.store(number * kStage, std::memory_order_release);
  part_.store(stage.part, std::memory_order_relaxed);
  job_.store(stage.job, std::memory_order_relaxed);
  grain_.store(stage.grain, std::memory_order_relaxed);
  count_.store(stage.count, std::memory_order_release);
  while (takePart()) {
  }
  for (int asked = 0; done_.load(std::memory_order_acquire) != parts;) pause(asked);
}

void Crew::help() {
  for (int asked = 0; !ended_.load(std::memory_order_acquire);) {
    if (takePart())
      asked = 0;
    else
      pause(asked);
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
