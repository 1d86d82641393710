// From the overlapping pairs that the CPU found to sorted pairs and the contacts of each sphere.
#pragma once

#include <cstdint>
#include <vector>

#include "batch/backend.hpp"
#include "batch/hits.hpp"
#include "common/workers.hpp"
#include "innersphere/query.hpp"

namespace innersphere {

/// Sorting makes the lists independent of the order in which hits were found; each sphere's contact is then
/// summed in the order of its partners. Keeps its memory for the next batch.
class HitSorter {
 public:
  void run(const std::vector<PreparedQuery>& queries, const std::vector<core::Sums>& sums, const Hits& hits,
           Want want, Workers& workers, QueryResult& result);

 private:
  /// Whose number a sphere is, in a hit.
  using Sphere = std::uint32_t Hit::*;

  void groupByQuery(const std::vector<core::Sums>& sums, const Hits& hits);
  /// By the first of these spheres and, of equal ones, by the second or else by what they come in.
  void sortGroups(const std::vector<PreparedQuery>& queries, const Hits& hits, Sphere first, Sphere second,
                  Workers& workers);
  void writePairs(const Hits& hits, QueryResult::Ranges<SpherePair>& pairs) const;
  void writeContacts(const Hits& hits, Sphere sphere, Workers& workers,
                     QueryResult::Ranges<SphereContact>& contacts);

  std::vector<std::size_t> first_;  ///< hits of all queries before each
  std::vector<std::size_t> cursor_;
  std::vector<std::uint32_t> order_, spare_;  ///< numbers of the hits, by query, then sorted
  std::vector<std::size_t> heads_;            ///< where a new sphere begins in order_
};

}  // namespace innersphere
