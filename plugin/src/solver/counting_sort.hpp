// Puts things in order of small numbers.
#pragma once

#include <cstddef>
#include <vector>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Things with the same number keep their order. Its memory is kept from one sort to the next.
class CountingSort {
 public:
  /// Returns the places of `count` things in the order of their numbers, keyOf(place), each from 0 to below
  /// `keys`.
  template <typename KeyOf>
  const std::vector<int>& sort(int count, int keys, const KeyOf& keyOf) {
    starts_.assign(static_cast<std::size_t>(keys) + 1, 0);
    for (int i = 0; i < count; ++i) ++starts_[static_cast<std::size_t>(keyOf(i)) + 1];
    for (std::size_t key = 1; key < starts_.size(); ++key) starts_[key] += starts_[key - 1];
    order_.resize(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
      order_[static_cast<std::size_t>(starts_[static_cast<std::size_t>(keyOf(i))]++)] = i;
    return order_;
  }

 private:
  std::vector<int> starts_, order_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
