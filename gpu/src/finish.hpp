// From what a backend found to what a caller gets: sums in floating point and, of the CPU, pairs sorted,
// contacts of each sphere.
#pragma once

#include <cstdint>
#include <vector>

#include "backend.hpp"
#include "hits.hpp"
#include "innersphere/query.hpp"
#include "workers.hpp"

namespace innersphere {

core::Totals toTotals(const core::Sums& sums, const core::Units& units);

Overlap toOverlap(const core::Totals& totals);

/// Sorting makes the lists independent of the order in which hits were found; each sphere's contact is then
/// summed in the order of its partners. Keeps its memory for the next batch.
class HitSorter {
 public:
  void run(const std::vector<PreparedQuery>& queries, const std::vector<core::Sums>& sums, const Hits& hits,
           Want want, Workers& workers, QueryResult& result);

 private:
  /// What one pair adds to the contacts of both of its spheres.
  struct Values {
    double volume;
    core::Vec3r moment, area;
  };

  void groupByQuery(const std::vector<core::Sums>& sums, const Hits& hits);
  void sortGroups(const std::vector<PreparedQuery>& queries, Workers& workers);
  void writePairs(QueryResult::Ranges<SpherePair>& pairs) const;
  void evaluate(const std::vector<PreparedQuery>& queries, Workers& workers);
  void regroupByB(const std::vector<PreparedQuery>& queries, Workers& workers);
  void writeContacts(bool of_b, Workers& workers, QueryResult::Ranges<SphereContact>& contacts);
  SphereContact sumContact(std::size_t query, std::size_t begin, std::size_t end, bool of_b) const;

  std::vector<std::size_t> first_;  ///< hits of all queries before each
  std::vector<std::size_t> cursor_;
  /// Hits by query, sorted: sphere of A above that of B; once regrouped, sphere of B above the hit's number
  /// in its query.
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint64_t> spare_;
  std::vector<Values> values_;      ///< of the hits as they were sorted first
  std::vector<std::size_t> heads_;  ///< where a new sphere begins in keys_
};

}  // namespace innersphere
