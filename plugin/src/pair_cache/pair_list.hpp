// Pairs that come and go.
#pragma once

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <vector>

#include "common/parallel.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

struct ListedPair {
  std::size_t list_index = 0;  ///< in the PairList that it is in
};

/// In the order in which they came. One that goes leaves a gap, and gaps are closed when they are more than
/// half of the list: so each costs the same, however many there are and whichever goes first.
template <typename Pair>
class PairList {
 public:
  void add(Pair* pair) {
    pair->list_index = pairs_.size();
    pairs_.push_back(pair);
  }
  void remove(Pair* pair) {
    pairs_[pair->list_index] = nullptr;
    if (2 * ++gaps_ > pairs_.size()) closeGaps();
  }

  /// At least how many there are.
  std::size_t size() const { return pairs_.size(); }
  /// What it has room for; grows by multiples.
  std::size_t capacity() const { return pairs_.capacity(); }

  /// Null where one has gone.
  Pair* at(std::size_t index) const { return pairs_[index]; }

  template <typename Visit>
  void forEach(const Visit& visit) const {
    for (Pair* pair : pairs_) {
      if (pair != nullptr) visit(*pair);
    }
  }
  /// With all threads. `fetches` are called before for what a visit reads besides the beginning of the pair,
  /// as in inParallel().
  template <typename Visit, typename... Fetches>
  void forEachInParallel(const Visit& visit, const Fetches&... fetches) const {
    const auto of = [&](const auto& call) {
      return [&](std::size_t i) {
        if (pairs_[i] != nullptr) call(*pairs_[i]);
      };
    };
    inParallel(
        pairs_.size(), of(visit), [&](std::size_t i) { __builtin_prefetch(pairs_[i]); }, of(fetches)...);
  }

 private:
  void closeGaps() {
    pairs_.erase(std::remove(pairs_.begin(), pairs_.end(), nullptr), pairs_.end());
    for (std::size_t i = 0; i < pairs_.size(); ++i) pairs_[i]->list_index = i;
    gaps_ = 0;
  }
  std::vector<Pair*> pairs_;  ///< null: a gap
  std::size_t gaps_ = 0;
};

/// One that several threads may use at once.
template <typename Pair>
class SharedPairList {
 public:
  void add(Pair* pair) {
    const std::lock_guard<std::mutex> lock(mutex_);
    pairs_.add(pair);
  }
  void remove(Pair* pair) {
    const std::lock_guard<std::mutex> lock(mutex_);
    pairs_.remove(pair);
  }
  template <typename Visit>
  void forEach(const Visit& visit) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    pairs_.forEach(visit);
  }

 private:
  mutable std::mutex mutex_;
  PairList<Pair> pairs_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
