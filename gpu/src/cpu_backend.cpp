#include "cpu_backend.hpp"

#include <algorithm>

#include "core/walk.hpp"

namespace innersphere {

/// Collects hits and hands them on in blocks, so that threads seldom meet at the cursor. What does not fit is
/// counted.
class CpuBackend::HitWriter {
 public:
  HitWriter(Hits& hits, std::atomic<std::size_t>& cursor) : hits_(hits), cursor_(cursor) {}
  ~HitWriter() { flush(); }

  void add(const Hit& hit) {
    if (size_ == block_.size()) flush();
    block_[size_++] = hit;
  }

 private:
  void flush() {
    const std::size_t at = cursor_.fetch_add(size_, std::memory_order_relaxed);
    if (at + size_ <= hits_.items.size())
      std::copy_n(block_.begin(), size_, hits_.items.begin() + static_cast<std::ptrdiff_t>(at));
    size_ = 0;
  }

  Hits& hits_;
  std::atomic<std::size_t>& cursor_;
  std::size_t size_ = 0;
  std::array<Hit, 128> block_;
};

void CpuBackend::run(const std::vector<PreparedQuery>& queries, Want want, std::vector<core::Sums>& sums,
                     Hits& hits) {
  constexpr std::size_t kGrain = 16;  // clusters: some 512 spheres
  first_.resize(queries.size() + 1);
  first_[0] = 0;
  for (std::size_t q = 0; q < queries.size(); ++q) first_[q + 1] = first_[q] + queries[q].clusters();
  while (true) {
    sums.resize(queries.size());
    for (core::Sums& sum : sums) sum.clear();
    cursor_ = 0;
    workers_.forRanges(first_.back(), kGrain, [&](std::size_t begin, std::size_t end) {
      walkRange(queries, begin, end, want, sums, hits);
    });
    hits.count = cursor_;
    if (hits.count <= hits.items.size()) return;
    hits.items.resize(hits.count);  // now the room that is needed is known: walk again
  }
}

void CpuBackend::walkRange(const std::vector<PreparedQuery>& queries, std::size_t begin, std::size_t end,
                           Want want, std::vector<core::Sums>& sums, Hits& hits) {
  HitWriter writer(hits, cursor_);
  auto next = std::upper_bound(first_.begin(), first_.end(), begin);
  while (begin < end) {
    const std::size_t q = static_cast<std::size_t>(next - first_.begin()) - 1;
    const std::size_t stop = std::min(end, *next);
    if (begin < stop)
      walkQuery(queries[q], static_cast<std::uint32_t>(q), begin - first_[q], stop - first_[q], want, sums[q],
                writer);
    begin = stop;
    ++next;
  }
}

void CpuBackend::walkQuery(const PreparedQuery& query, std::uint32_t index, std::size_t begin,
                           std::size_t end, Want want, core::Sums& total, HitWriter& writer) {
  const core::Setup& setup = query.setup;
  const auto forHits = [&](std::size_t cluster, const auto& visit) {
    const auto number = static_cast<std::uint32_t>(cluster);
    const bool from_a = core::isFromA(setup, number);
    core::walkCandidates(setup, number, 0, 1, [&](std::uint32_t a, std::uint32_t b) {
      core::Pair pair;
      return !core::isHit(setup, from_a, a, b, pair) || visit(a, b, pair);
    });
  };
  if (want == Want::touch) {
    const std::atomic_ref<unsigned long long> touched(total.pairs);
    for (std::size_t cluster = begin; cluster < end && touched.load(std::memory_order_relaxed) == 0;
         ++cluster) {
      forHits(cluster, [&](std::uint32_t, std::uint32_t, const core::Pair&) {
        touched.store(1, std::memory_order_relaxed);
        return false;
      });
    }
    return;
  }
  core::Sums sums;
  sums.clear();
  const bool wrench = want != Want::volume, collect = wantsHits(want);
  for (std::size_t cluster = begin; cluster < end; ++cluster) {
    forHits(cluster, [&](std::uint32_t a, std::uint32_t b, const core::Pair& pair) {
      sums.add(pair, setup.shifts, wrench);
      if (collect) writer.add({index, setup.a.grid.ids[a], setup.b.grid.ids[b]});
      return true;
    });
  }
  if (sums.pairs == 0) return;
  const tbb::spin_mutex::scoped_lock lock(locks_[index % locks_.size()]);
  total.add(sums);
}

}  // namespace innersphere
