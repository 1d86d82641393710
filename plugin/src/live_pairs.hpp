// The pairs of one dispatcher that Bullet has algorithms for.
#pragma once

#include <algorithm>
#include <mutex>
#include <vector>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

class PairContact;

/// In the order in which they came.
class LivePairs {
 public:
  void add(PairContact* pair) {
    const std::lock_guard<std::mutex> lock(mutex_);
    pairs_.push_back(pair);
  }
  void remove(PairContact* pair) {
    const std::lock_guard<std::mutex> lock(mutex_);
    pairs_.erase(std::remove(pairs_.begin(), pairs_.end(), pair), pairs_.end());
  }
  template <typename Visit>
  void forEach(const Visit& visit) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (PairContact* pair : pairs_) visit(*pair);
  }

 private:
  std::mutex mutex_;
  std::vector<PairContact*> pairs_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
