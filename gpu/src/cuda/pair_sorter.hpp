// Sorts the pairs of a batch and sums its contacts, on the device.
#pragma once

#include <cstddef>

#include "cuda/batch.hpp"
#include "cuda/memory.hpp"
#include "innersphere/query.hpp"

namespace innersphere::device {

/// Holds a list in memory of the host. The items of query i are items[first[i]] to items[first[i + 1]].
template <typename T>
struct PinnedList {
  PinnedArray<T> items;
  PinnedArray<unsigned> first;
};

struct PinnedLists {
  PinnedList<SpherePair> pairs;
  PinnedList<SphereContact> contacts[2];
};

/// Holds what one pair adds to the contacts of both of its spheres.
struct PairValues {
  enum Value { volume = 0, moment = 1, area = 4, values = 7 };
  double of[values];
};

/// Sorts and sums. The overlapping pairs are sorted by query, sphere of A and sphere of B, so nothing depends
/// on the order in which they were found; each sphere's contact is summed in the order of its partners.
class CudaPairSorter {
 public:
  unsigned long long* keys() const { return keys_.data(); }
  std::size_t capacity() const { return keys_.capacity(); }
  void reserve(std::size_t found_pairs) { keys_.reserve(found_pairs); }

  /// Launches all that it takes. `batch` is what was traversed, and `single` its query where it has no
  /// others; there are `found_pairs` keys.
  void start(const Batch& batch, const Query& single, std::size_t found_pairs, Want want,
             cudaStream_t stream);

  const PinnedLists& lists() const { return lists_; }

 private:
  /// Sums the contacts of one side. The spheres' bits begin at `shift` of the sorted keys. `order` holds the
  /// overlapping pairs in that order.
  void sumContacts(unsigned queries, unsigned found_pairs, unsigned shift, unsigned sphere_bits,
                   const unsigned* order, PinnedList<SphereContact>& to, cudaStream_t stream);

  DeviceArray<unsigned long long> keys_, sorted_;
  DeviceArray<unsigned> order_, sorted_order_;  ///< of the overlapping pairs, by sphere of B
  DeviceArray<unsigned> heads_, head_count_;    ///< where another sphere begins
  DeviceArray<PairValues> values_;
  DeviceArray<std::byte> scratch_;  ///< of CUB
  PinnedLists lists_;
};

}  // namespace innersphere::device
