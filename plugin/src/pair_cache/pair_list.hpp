// Lists pairs that come and go.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/parallel.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Lists things that have a list_index, in the order in which they came. One that goes leaves a gap, and gaps
/// are closed when they are more than half of the list: so each costs the same, however many there are and
/// whichever goes first.
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

  /// Returns a number of places, no fewer than there are things.
  std::size_t size() const { return pairs_.size(); }
  /// Returns what it has room for; this grows by multiples.
  std::size_t capacity() const { return pairs_.capacity(); }

  /// Returns what is at a place; null where one has gone.
  Pair* at(std::size_t index) const { return pairs_[index]; }

  template <typename Visit>
  void forEach(const Visit& visit) const {
    for (Pair* pair : pairs_) {
      if (pair != nullptr) visit(*pair);
    }
  }
  /// Visits all of them with all threads.
  template <typename Visit>
  void forEachInParallel(const Visit& visit) const {
    inParallel(pairs_.size(), [&](std::size_t i) {
      // They lie scattered in memory, and most of them are only looked at.
      if (i + kAhead < pairs_.size()) __builtin_prefetch(pairs_[i + kAhead]);
      if (pairs_[i] != nullptr) visit(*pairs_[i]);
    });
  }

 private:
  static constexpr std::size_t kAhead = 8;

  void closeGaps() {
    pairs_.erase(std::remove(pairs_.begin(), pairs_.end(), nullptr), pairs_.end());
    for (std::size_t i = 0; i < pairs_.size(); ++i) pairs_[i]->list_index = i;
    gaps_ = 0;
  }
  std::vector<Pair*> pairs_;  ///< null: a gap
  std::size_t gaps_ = 0;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
