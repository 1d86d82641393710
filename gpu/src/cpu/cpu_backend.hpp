// Runs batches on the CPU, spread over threads by clusters of spheres.
#pragma once

#include <tbb/spin_mutex.h>

#include <array>
#include <atomic>
#include <span>
#include <vector>

#include "batch/backend.hpp"
#include "batch/overlapping_pairs.hpp"
#include "common/workers.hpp"
#include "cpu/pair_sorter.hpp"

namespace innersphere {

/// Runs on the CPU. A batch is done when start() returns: the calling thread and the workers do it all.
///
/// Where bodies are deep in each other a sphere overlaps dozens of others, and a batch of many such bodies
/// has millions of pairs. So that they do not take memory all at once, a batch goes through in parts. The
/// lists of each query have the same bits in any part.
class CpuBackend : public QueryBackend {
 public:
  explicit CpuBackend(Workers& workers) : workers_(workers) {}

  void start(std::span<const PreparedQuery> queries, Want want) override;
  /// Whether batches that want contacts leave out all other sums but the number of pairs, from now on.
  void leaveOutSums(bool leave_out) { without_sums_ = leave_out; }
  bool ready() override { return true; }
  void finish(QueryResult& result) override;
  void sweep(const Sweep& sweep, Overlap* overlaps) override;

 private:
  class Summer;
  class Toucher;

  /// Traverses the grids of all queries and sums over the overlapping pairs of each. Want::touch gives only a
  /// pair count of 0 or 1. With contacts or pairs wanted all pairs also go into `hits_`, which grows where
  /// needed.
  void traverse(std::size_t begin, std::size_t end);
  /// Traverses queries from `begin` on, as many as their pairs find room for, and at least one. Returns where
  /// it ended.
  std::size_t traversePart(std::size_t begin);
  std::size_t clustersOf(std::size_t begin, std::size_t end) const { return first_[end] - first_[begin]; }
  void releaseUnused();
  void traverseRange(std::size_t begin, std::size_t end);
  void traverseQuery(std::uint32_t index, std::size_t begin, std::size_t end);

  Workers& workers_;
  std::span<const PreparedQuery> queries_;
  Want want_ = Want::wrench;
  bool without_sums_ = false;
  std::vector<core::Sums> sums_;
  OverlappingPairs found_pairs_;  ///< of the last part
  PairSorter sorter_;
  bool in_parts_ = false;
  QueryResult lists_;                      ///< of all parts, where there are several
  double densest_ = 0;                     ///< most pairs for each cluster of a part, in the last batch
  double densest_so_far_ = 0;              ///< the same in this one
  std::size_t most_pairs_ = 0;             ///< of a part since memory was last looked at
  bool had_parts_ = false;                 ///< since then
  int batches_ = 0;                        ///< since then
  std::vector<std::size_t> first_;         ///< clusters of all queries before each
  std::array<tbb::spin_mutex, 64> locks_;  ///< of the sums, by query modulo their number
  std::atomic<std::size_t> cursor_{0};     ///< where the next overlapping pairs go
};

}  // namespace innersphere
