// The walk on the CPU, spread over threads by clusters of spheres.
#pragma once

#include <tbb/spin_mutex.h>

#include <array>
#include <atomic>

#include "batch/backend.hpp"
#include "batch/hits.hpp"
#include "common/workers.hpp"

namespace innersphere {

class CpuBackend {
 public:
  explicit CpuBackend(Workers& workers) : workers_(workers) {}

  /// Sums over all overlapping pairs of each query, into sums[0 .. queries.size()). Want::touch gives only a
  /// pair count of 0 or 1. With Want::contacts and Want::pairs all pairs also go into `hits`, which grows
  /// where needed.
  void run(const std::vector<PreparedQuery>& queries, Want want, std::vector<core::Sums>& sums, Hits& hits);

 private:
  class Summer;
  class Toucher;
  void walkRange(const std::vector<PreparedQuery>& queries, std::size_t begin, std::size_t end, Want want,
                 std::vector<core::Sums>& sums, Hits& hits);
  void walkQuery(const PreparedQuery& query, std::uint32_t index, std::size_t begin, std::size_t end,
                 Want want, core::Sums& total, Hits& hits);

  Workers& workers_;
  std::vector<std::size_t> first_;         ///< clusters of all queries before each
  std::array<tbb::spin_mutex, 64> locks_;  ///< of the sums, by query modulo their number
  std::atomic<std::size_t> cursor_{0};     ///< where the next hits go
};

}  // namespace innersphere
