#include "innersphere/query.hpp"

#include <string>

#include "cpu_backend.hpp"
#include "cuda_backend.hpp"
#include "finish.hpp"
#include "innersphere/error.hpp"
#include "prepare.hpp"

namespace innersphere {

namespace {

/// Clusters of spheres in a batch from which on a launch on the device pays: it takes some 30 us, in which
/// one core walks the 50 clusters of two packings of 500 spheres that overlap by a half, or 200 that hardly
/// touch.
constexpr std::size_t kDeviceClusters = 100;

}  // namespace

struct QueryContext::Impl {
  explicit Impl(const QueryContextOptions& o) : options(o), workers(o.threads), cpu(workers) {
    if (options.backend != Backend::cuda) return;
    cuda = makeCudaBackend();
    last = Backend::cuda;
  }

  /// Looks for a device only once there is work for it: that alone can take a tenth of a second.
  bool paysOnDevice() {
    std::size_t clusters = 0;
    for (const PreparedQuery& query : prepared) clusters += query.clusters();
    if (clusters < kDeviceClusters) return false;
    if (!cuda && !looked_for_device && cudaDeviceAnswers()) cuda = makeCudaBackend();
    looked_for_device = true;
    return cuda != nullptr;
  }

  WalkBackend& choose() {
    const bool on_device =
        options.backend == Backend::cuda || (options.backend == Backend::automatic && paysOnDevice());
    last = on_device ? Backend::cuda : Backend::cpu;
    return on_device ? *cuda : cpu;
  }

  QueryContextOptions options;
  Workers workers;
  CpuBackend cpu;
  std::unique_ptr<WalkBackend> cuda;
  bool looked_for_device = false;
  Backend last = Backend::cpu;

  // Scratch, kept from run to run.
  std::vector<PreparedQuery> prepared;
  std::vector<core::Sums> sums;
  Hits hits;
  HitSorter sorter;
  QueryResult single;
};

bool cudaAvailable() {
  return cudaDeviceAnswers();
}

QueryContext::QueryContext(const QueryContextOptions& options) {
  if (options.threads < 0) {
    throw Error(ErrorCode::bad_argument,
                "threads is " + std::to_string(options.threads) + "; it must be 0 (all cores) or more");
  }
  impl_ = std::make_unique<Impl>(options);
}
QueryContext::~QueryContext() = default;
QueryContext::QueryContext(QueryContext&&) noexcept = default;
QueryContext& QueryContext::operator=(QueryContext&&) noexcept = default;

void QueryContext::run(const PairQuery* queries, std::size_t count, const QueryOptions& options,
                       QueryResult& result) {
  Impl& impl = *impl_;
  if (count > 0 && !queries) throw Error(ErrorCode::bad_argument, "the queries are a null pointer");
  if (count >> 32) throw Error(ErrorCode::bad_argument, "a batch has at most 2^32 - 1 queries; split it");
  impl.prepared.clear();
  for (std::size_t i = 0; i < count; ++i) impl.prepared.push_back(prepare(queries[i], i, options.estimator));
  impl.choose().run(impl.prepared, options.want, impl.sums, impl.hits);
  impl.sorter.run(impl.prepared, impl.sums, impl.hits, options.want, impl.workers, result);
  result.overlaps.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    result.overlaps[i] = toOverlap(impl.sums[i], impl.prepared[i].setup);
}

Overlap QueryContext::overlap(const PairQuery& query, const QueryOptions& options) {
  QueryOptions sums_only = options;
  if (wantsHits(options.want)) sums_only.want = Want::wrench;
  run(&query, 1, sums_only, impl_->single);
  return impl_->single.overlaps[0];
}

Backend QueryContext::lastBackend() const {
  return impl_->last;
}

}  // namespace innersphere
