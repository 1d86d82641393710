#include "packer/reporter.hpp"

#include <algorithm>
#include <utility>

#include "innersphere/error.hpp"

namespace innersphere {
namespace {

// Time after which the user is asked again.
constexpr std::chrono::milliseconds kPatience{50};

}  // namespace

Reporter::Reporter(const Progress& progress, std::string work)
    : progress_(progress), work_(std::move(work)), asked_(Clock::now()) {}

void Reporter::operator()(const char* stage, double fraction) const {
  if (!progress_) return;
  stage_ = stage;
  fraction_ = std::clamp(fraction, 0.0, 1.0);
  ask();
}

void Reporter::ask() const {
  bool goes_on = false;
  try {
    goes_on = progress_(stage_, fraction_);
  } catch (...) {
    ended_ = true;
    throw;
  }
  asked_ = Clock::now();
  if (goes_on) return;
  ended_ = true;
  throwCancelled();
}

void Reporter::look() const {
  if (std::this_thread::get_id() == thread_ && Clock::now() - asked_ > kPatience) ask();
}

void Reporter::throwCancelled() const {
  throw Error(ErrorCode::cancelled, work_ + " was cancelled");
}

}  // namespace innersphere
