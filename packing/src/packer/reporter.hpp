// Tells the user how far the work is, and ends it when the user wants that.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

#include "innersphere/progress.hpp"

namespace innersphere {

/// Calls the user back from the thread that made it. A stage may take minutes, so whatever runs long, in any
/// thread, asks again and again whether to go on.
class Reporter {
 public:
  /// `work` is what the message says was cancelled. `progress` may be empty and must outlive the reporter.
  Reporter(const Progress& progress, std::string work);

  /// Tells the user how far the work is; only for the thread that made the reporter. Throws Error cancelled,
  /// and what the user's function throws.
  void operator()(const char* stage, double fraction) const;

  /// Throws Error cancelled if the user wants the work to end. In the thread that made the reporter it asks
  /// the user, every few hundredths of a second. Cheap enough to be called for each point looked at.
  void goOn() const {
    if (!progress_) return;
    if (ended_.load(std::memory_order_relaxed)) throwCancelled();
    thread_local std::uint32_t calls = 0;
    if (++calls % kCallsPerLook == 0) look();
  }

 private:
  using Clock = std::chrono::steady_clock;

  // Calls of goOn() for a look at the clock.
  static constexpr std::uint32_t kCallsPerLook = 32;

  void ask() const;
  void look() const;
  [[noreturn]] void throwCancelled() const;

  const Progress& progress_;
  const std::string work_;
  const std::thread::id thread_ = std::this_thread::get_id();
  // What was told last, and when: only of that thread.
  mutable const char* stage_ = "";
  mutable double fraction_ = 0;
  mutable Clock::time_point asked_;
  mutable std::atomic<bool> ended_ = false;
};

}  // namespace innersphere
