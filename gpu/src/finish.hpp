// From what a backend found to what a caller gets: sums in floating point, pairs sorted, contacts of each
// sphere.
#pragma once

#include <cstdint>
#include <vector>

#include "backend.hpp"
#include "innersphere/query.hpp"
#include "workers.hpp"

namespace innersphere {

Overlap toOverlap(const core::Sums& sums, const core::Setup& setup);

/// Sorting makes the lists independent of the order in which hits were found; each sphere's contact is then
/// summed in the order of its partners. Keeps its memory for the next batch.
class HitSorter {
 public:
  void run(const std::vector<PreparedQuery>& queries, const std::vector<core::Sums>& sums, const Hits& hits,
           Want want, Workers& workers, QueryResult& result);

 private:
  void groupByQuery(const std::vector<core::Sums>& sums, const Hits& hits, bool by_b);
  void sortGroups(const std::vector<PreparedQuery>& queries, bool by_b, Workers& workers);
  void writePairs(QueryResult::Ranges<SpherePair>& pairs) const;
  void writeContacts(const std::vector<PreparedQuery>& queries, bool of_b, Workers& workers,
                     QueryResult::Ranges<SphereContact>& contacts);

  std::vector<std::size_t> first_;  ///< hits of all queries before each
  std::vector<std::size_t> cursor_;
  std::vector<std::uint64_t> keys_;  ///< hits by query: sphere of the one body above that of the other
  std::vector<std::uint64_t> spare_;
  std::vector<std::size_t> heads_;  ///< where a new sphere begins in keys_
};

}  // namespace innersphere
