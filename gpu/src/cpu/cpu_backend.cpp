#include "cpu/cpu_backend.hpp"

#include <algorithm>
#include <utility>

#include "batch/results.hpp"
#include "cpu/kernels.hpp"

namespace innersphere {

namespace {

/// Pairs of one part, at most, unless a single query has more: with what it takes to sort them, 12 MB.
constexpr std::size_t kPartPairs = std::size_t{1} << 17;
/// Memory is given back if this many batches in a row have needed less than a part of it,
constexpr int kBatchesToLookAt = 64;
constexpr std::size_t kUnused = 4;
/// but not the room for so many pairs: 1.5 MB.
constexpr std::size_t kKeptPairs = std::size_t{1} << 14;

}  // namespace

void CpuBackend::start(std::span<const PreparedQuery> queries, Want want) {
  queries_ = queries;
  want_ = want;
  first_.resize(queries.size() + 1);
  first_[0] = 0;
  for (std::size_t q = 0; q < queries.size(); ++q) first_[q + 1] = first_[q] + queries[q].clusters();
  sums_.resize(queries.size());
  in_parts_ = false;
  if (!wantsPairs(want)) return traverse(0, queries.size());
  densest_so_far_ = 0;
  for (std::size_t begin = 0, end = 0; begin < queries.size() || begin == 0; begin = end) {
    end = traversePart(begin);
    if (end == queries.size() && !in_parts_) break;  // finish() makes the lists
    if (!in_parts_) PairSorter::clear(queries.size(), lists_);
    in_parts_ = true;
    sorter_.append(queries, sums_, begin, end, found_pairs_, want, workers_, lists_);
  }
  densest_ = densest_so_far_;
}

void CpuBackend::finish(QueryResult& result) {
  constexpr std::size_t kGrain = 64;
  if (in_parts_) {
    // Copied, so that both keep the memory that they need again in the next batch.
    result.pairs = lists_.pairs;
    result.contacts_a = lists_.contacts_a;
    result.contacts_b = lists_.contacts_b;
  } else {
    PairSorter::clear(queries_.size(), result);
    if (wantsPairs(want_))
      sorter_.append(queries_, sums_, 0, queries_.size(), found_pairs_, want_, workers_, result);
  }
  releaseUnused();
  result.overlaps.resize(queries_.size());
  workers_.forRanges(queries_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      result.overlaps[i] = toOverlap(toTotals(sums_[i], queries_[i].setup.units), queries_[i].setup);
  });
}

void CpuBackend::sweep(const Sweep& sweep, Overlap* overlaps) {
  constexpr std::size_t kAtOnce = 4096, kGrain = 64;  // poses
  const core::GridView* views[2] = {&sweep.grid_a->onCpu().view(), &sweep.grid_b->onCpu().view()};
  std::vector<PreparedQuery> prepared;
  std::vector<core::Fault> faults;
  QueryResult result;
  for (std::size_t first = 0; first < sweep.poses.count; first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, sweep.poses.count - first);
    prepared.resize(count);
    faults.resize(count);
    workers_.forRanges(count, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        PreparedQuery& query = prepared[i];
        query.grid_a = sweep.grid_a;
        query.grid_b = sweep.grid_b;
        query.setup.a = *views[0];
        query.setup.b = *views[1];
        faults[i] = core::prepareAt(sweep.pair, sweep.poses, first + i, query.setup);
      }
    });
    for (std::size_t i = 0; i < count; ++i) {
      if (faults[i] != core::Fault::none) failFor(faults[i], first + i, "B");
    }
    start(prepared, sweep.want);
    finish(result);
    std::copy(result.overlaps.begin(), result.overlaps.end(), overlaps + first);
  }
}

std::size_t CpuBackend::traversePart(std::size_t begin) {
  const bool with_values = wantsContacts(want_);
  std::size_t end = queries_.size();
  const double densest = std::max(densest_, densest_so_far_);
  if (densest * static_cast<double>(clustersOf(begin, end)) > kPartPairs) {
    const auto most = static_cast<std::size_t>(kPartPairs / densest);
    end = static_cast<std::size_t>(std::upper_bound(first_.begin() + static_cast<std::ptrdiff_t>(begin),
                                                    first_.end(), first_[begin] + most) -
                                   first_.begin() - 1);
    end = std::clamp(end, begin + 1, queries_.size());
  }
  while (true) {
    traverse(begin, end);
    const std::size_t clusters = clustersOf(begin, end);
    if (clusters > 0)
      densest_so_far_ =
          std::max(densest_so_far_, static_cast<double>(found_pairs_.count) / static_cast<double>(clusters));
    if (found_pairs_.count <= found_pairs_.room(with_values)) {
      most_pairs_ = std::max(most_pairs_, found_pairs_.count);
      return end;
    }
    // Now the room that is needed is known: once more, with those that may have so much.
    std::size_t count = found_pairs_.count;
    if (count > kPartPairs) {
      const std::size_t all = std::exchange(end, begin + 1);
      for (count = sums_[begin].pairs; end < all && count + sums_[end].pairs <= kPartPairs; ++end)
        count += sums_[end].pairs;
      count = std::max(count, kPartPairs);
    }
    found_pairs_.reserve(count, with_values);
  }
}

void CpuBackend::traverse(std::size_t begin, std::size_t end) {
  constexpr std::size_t kGrain = 16;  // clusters: some 512 spheres
  for (std::size_t q = begin; q < end; ++q) sums_[q].clear();
  cursor_ = 0;
  const std::size_t before = first_[begin];
  workers_.forRanges(clustersOf(begin, end), kGrain, [&](std::size_t first, std::size_t last) {
    traverseRange(before + first, before + last);
  });
  found_pairs_.count = cursor_;
}

/// Bodies that were deep in each other for once leave no memory behind.
void CpuBackend::releaseUnused() {
  had_parts_ = had_parts_ || in_parts_;
  if (++batches_ < kBatchesToLookAt) return;
  if (found_pairs_.items.size() > std::max(kKeptPairs, kUnused * most_pairs_)) {
    found_pairs_.release();
    sorter_.release();
  }
  if (!had_parts_) lists_ = QueryResult();
  most_pairs_ = 0;
  had_parts_ = false;
  batches_ = 0;
}

void CpuBackend::traverseRange(std::size_t begin, std::size_t end) {
  auto next = std::upper_bound(first_.begin(), first_.end(), begin);
  while (begin < end) {
    const std::size_t q = static_cast<std::size_t>(next - first_.begin()) - 1;
    const std::size_t stop = std::min(end, *next);
    if (begin < stop) traverseQuery(static_cast<std::uint32_t>(q), begin - first_[q], stop - first_[q]);
    begin = stop;
    ++next;
  }
}

/// Decides the candidates of one query, and sums what counts. Overlapping pairs that find no room are only
/// counted.
class CpuBackend::Summer : public CandidateSink {
 public:
  Summer(const PreparedQuery& query, std::uint32_t index, Want want, bool without_sums,
         OverlappingPairs& found_pairs, std::atomic<std::size_t>& cursor)
      : setup_(query.setup),
        index_(index),
        want_(want),
        terms_(without_sums && wantsContacts(want) ? 0
               : want == Want::volume              ? core::kVolumeTerms
                                                   : core::kTerms),
        found_pairs_(found_pairs),
        cursor_(cursor) {
    sums_.clear();
  }

  void setFromA(bool from_a) { from_a_ = from_a; }

  bool take(Candidates& candidates) override {
    if (candidates.count == 0) return true;
    const CpuKernels& kernels = cpuKernels();
    const auto sum = terms_ == 0                    ? kernels.decide
                     : terms_ == core::kVolumeTerms ? kernels.sumVolumes
                                                    : kernels.sumAll;
    sum(setup_, from_a_, candidates, tally_);
    if (tally_.pairs > 0) {
      addTally();
      if (wantsPairs(want_)) write(candidates);
    }
    candidates.count = 0;
    return true;
  }

  const core::Sums& sums() const { return sums_; }

 private:
  void addTally() {
    sums_.pairs += tally_.pairs;
    for (int i = 0; i < terms_; ++i) {
      const core::FixedSum sum = toFixed(tally_.sums[static_cast<std::size_t>(i)], unitOf(setup_.units, i));
      sums_.terms[i] = sums_.terms[i] + sum;
    }
  }

  void write(const Candidates& candidates) {
    const bool with_values = wantsContacts(want_);
    const std::size_t at = cursor_.fetch_add(tally_.pairs, std::memory_order_relaxed);
    if (at + tally_.pairs > found_pairs_.room(with_values)) return;
    const auto& as = from_a_ ? candidates.query_sphere : candidates.partner;
    const auto& bs = from_a_ ? candidates.partner : candidates.query_sphere;
    OverlappingPair* found = found_pairs_.items.data() + at;
    for (std::size_t k = 0; k < candidates.count; ++k) {
      if (tally_.found[k]) *found++ = {index_, setup_.a.ids[as[k]], setup_.b.ids[bs[k]]};
    }
    if (with_values) cpuKernels().writeValues(tally_, candidates.count, found_pairs_.values.data() + at);
  }

  const core::Setup& setup_;
  std::uint32_t index_;
  Want want_;
  int terms_;  ///< that are summed, the first ones
  OverlappingPairs& found_pairs_;
  std::atomic<std::size_t>& cursor_;
  bool from_a_ = true;
  Tally tally_;
  core::Sums sums_;
};

/// Stops at the first pair that overlaps.
class CpuBackend::Toucher : public CandidateSink {
 public:
  Toucher(const core::Setup& setup, core::Sums& total) : setup_(setup), touched_(total.pairs) {}

  void setFromA(bool from_a) { from_a_ = from_a; }
  bool done() const { return touched_.load(std::memory_order_relaxed) != 0; }

  bool take(Candidates& candidates) override {
    const auto& as = from_a_ ? candidates.query_sphere : candidates.partner;
    const auto& bs = from_a_ ? candidates.partner : candidates.query_sphere;
    for (std::size_t k = 0; k < candidates.count; ++k) {
      const core::Pair pair = core::makePair(setup_.frame, setup_.a.spheres[as[k]], setup_.b.spheres[bs[k]]);
      if (core::isReported(pair, from_a_)) touched_.store(1, std::memory_order_relaxed);
    }
    candidates.count = 0;
    return !done();
  }

 private:
  const core::Setup& setup_;
  std::atomic_ref<std::uint64_t> touched_;
  bool from_a_ = true;
};

namespace {

constexpr std::size_t kTogether = 64;  ///< clusters, at most

/// Traverses those of the clusters begin..end (all of A's, then all of B's) that can meet the other body,
/// `together` at a time, until the sink wants no more.
template <typename Sink>
void traverseClusters(const PreparedQuery& query, std::size_t begin, std::size_t end, std::size_t together,
                      Sink& sink) {
  const core::Setup& setup = query.setup;
  const CpuKernels& kernels = cpuKernels();
  Candidates candidates;
  std::array<std::uint32_t, kTogether> clusters;
  for (const bool from_a : {true, false}) {
    sink.setFromA(from_a);
    const core::Traversal traversal = core::traversalOf(setup, from_a);
    const HashGrid& grid = (from_a ? query.grid_b : query.grid_a)->onCpu();
    const SphereColumns listed = grid.listedSpheres();
    std::size_t count = 0;
    const auto traverse = [&] {
      const std::size_t n = std::exchange(count, 0);
      return kernels.traverse(traversal, listed, clusters.data(), n, candidates, sink) &&
             sink.take(candidates);
    };
    const auto meeting = [&](const Sphere* balls, std::uint32_t n) {
      return kernels.ballsMeeting(traversal, grid.occupancy(), balls, n);
    };
    const std::size_t before = from_a ? 0 : setup.clusters[0];
    const std::size_t all = from_a ? setup.clusters[0] : setup.clusters[1];
    const std::size_t first = std::clamp(begin, before, before + all) - before;
    const std::size_t last = std::clamp(end, before, before + all) - before;
    const ClusterTree& tree = (from_a ? query.grid_a : query.grid_b)->onCpu().clusterTree();
    const bool go_on = tree.forMeeting(first, last, meeting, [&](std::size_t cluster) {
      clusters[count++] = static_cast<std::uint32_t>(cluster);
      return count < together || traverse();
    });
    if (!go_on || !traverse()) return;
  }
}

}  // namespace

void CpuBackend::traverseQuery(std::uint32_t index, std::size_t begin, std::size_t end) {
  const PreparedQuery& query = queries_[index];
  core::Sums& total = sums_[index];
  if (want_ == Want::touch) {
    Toucher toucher(query.setup, total);
    if (!toucher.done()) traverseClusters(query, begin, end, 1, toucher);
    return;
  }
  Summer summer(query, index, want_, without_sums_, found_pairs_, cursor_);
  traverseClusters(query, begin, end, kTogether, summer);
  if (summer.sums().pairs == 0) return;
  const tbb::spin_mutex::scoped_lock lock(locks_[index % locks_.size()]);
  total.add(summer.sums());
}

}  // namespace innersphere
