// Turns the overlapping pairs that the CPU found into sorted pairs and the contacts of each sphere.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "batch/backend.hpp"
#include "batch/overlapping_pairs.hpp"
#include "common/workers.hpp"
#include "innersphere/query.hpp"

namespace innersphere {

/// Sorting makes the lists independent of the order in which overlapping pairs were found; each sphere's
/// contact is then summed in the order of its partners. Keeps its memory for the next batch.
class PairSorter {
 public:
  /// Empties the lists of a batch.
  static void clear(std::size_t queries, QueryResult& result);
  /// Appends the lists of queries begin..end, whose pairs were found. Those before them are in the result.
  void append(std::span<const PreparedQuery> queries, const std::vector<core::Sums>& sums,
              std::size_t begin, std::size_t end, const OverlappingPairs& found_pairs, Want want,
              Workers& workers, QueryResult& result);
  /// Gives its memory back.
  void release();

 private:
  /// Says whose number a sphere is, in an overlapping pair.
  using Sphere = std::uint32_t OverlappingPair::*;

  void groupByQuery(const std::vector<core::Sums>& sums, const OverlappingPairs& found_pairs);
  std::size_t queryCount() const { return first_.size() - 1; }
  /// Sorts each query's pairs by the first of these spheres and, where that is equal, by the second one.
  /// Without a second one equal pairs keep their order.
  void sortGroups(std::span<const PreparedQuery> queries, const OverlappingPairs& found_pairs,
                  Sphere first, Sphere second, Workers& workers);
  void writePairs(const OverlappingPairs& found_pairs, QueryResult::Ranges<SpherePair>& pairs) const;
  void writeContacts(const OverlappingPairs& found_pairs, Sphere sphere, Workers& workers,
                     QueryResult::Ranges<SphereContact>& contacts);

  std::size_t begin_ = 0;           ///< the first of the queries
  std::vector<std::size_t> first_;  ///< overlapping pairs of the queries before each of them
  std::vector<std::size_t> cursor_;
  std::vector<std::uint32_t> order_, spare_;  ///< numbers of the overlapping pairs, by query, then sorted
  std::vector<std::size_t> heads_;            ///< where a new sphere begins in order_
};

}  // namespace innersphere
