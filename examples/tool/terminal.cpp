#include "terminal.hpp"

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "exit_codes.hpp"
#include "innersphere/error.hpp"

namespace innersphere::tool {
namespace {

volatile std::sig_atomic_t interrupted = 0;
volatile std::sig_atomic_t ends_at_once = 0;
bool quiet_mode = false;
bool bar_shown = false;

void onInterrupt(int signal) {
  if (ends_at_once != 0) {
    constexpr char kLine[] = "innersphere: cancelled while a solid was read [cancelled]\n";
    [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, kLine, sizeof kLine - 1);
    _exit(kCancelled);
  }
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

void drawBar(const char* stage, double fraction) {
  constexpr int kWidth = 30;
  const int full = static_cast<int>(fraction * kWidth + 0.5);
  char bar[kWidth + 1] = {};
  for (int i = 0; i < kWidth; ++i) bar[i] = i < full ? '#' : '.';
  std::fprintf(stderr, "\r%s %3.0f %%  %-32.32s", bar, 100 * fraction, stage);
  std::fflush(stderr);
  bar_shown = true;
}

}  // namespace

void catchInterrupts() {
  std::signal(SIGINT, onInterrupt);
  std::signal(SIGTERM, onInterrupt);
}

EndsAtOnce::EndsAtOnce() {
  ends_at_once = 1;
  if (interrupted == 0) return;
  ends_at_once = 0;
  throw Error(ErrorCode::cancelled, "cancelled before a solid was read");
}

EndsAtOnce::~EndsAtOnce() {
  ends_at_once = 0;
}

void setQuiet(bool quiet) {
  quiet_mode = quiet;
}

bool isQuiet() {
  return quiet_mode;
}

void say(const std::string& line) {
  if (quiet_mode) return;
  clearProgressBar();
  std::fprintf(stderr, "%s\n", line.c_str());
}

Progress progressBar() {
  using Clock = std::chrono::steady_clock;
  const bool visible = !quiet_mode && isatty(STDERR_FILENO) != 0;
  return [visible, last = Clock::time_point(), last_stage = std::string()](const char* stage,
                                                                           double fraction) mutable {
    const auto now = Clock::now();
    const bool new_stage = last_stage != stage;
    if (visible && (new_stage || fraction >= 1 || now - last > std::chrono::milliseconds(100))) {
      drawBar(stage, fraction);
      last = now;
      if (new_stage) last_stage = stage;
    }
    return interrupted == 0;
  };
}

void clearProgressBar() {
  if (bar_shown) std::fprintf(stderr, "\r%*s\r", 72, "");
  bar_shown = false;
}

}  // namespace innersphere::tool
