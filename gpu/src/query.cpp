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
/// one core walks those of two packings of 600 spheres that overlap by a half.
constexpr std::size_t kDeviceClusters = 60;

constexpr std::size_t kGrain = 64;  ///< queries of a batch that one thread prepares

}  // namespace

struct QueryContext::Impl {
  explicit Impl(const QueryContextOptions& o) : options(o), workers(o.threads), cpu(workers) {
    if (options.backend != Backend::cuda) return;
    cuda = makeCudaBackend(options.time_kernels);
    last = Backend::cuda;
  }

  /// Looks for a device only once there is work for it: that alone can take a tenth of a second.
  bool paysOnDevice() {
    std::size_t clusters = 0;
    for (const PreparedQuery& query : prepared) clusters += query.clusters();
    if (clusters < kDeviceClusters) return false;
    if (!cuda && !looked_for_device && cudaDeviceAnswers()) cuda = makeCudaBackend(options.time_kernels);
    looked_for_device = true;
    return cuda != nullptr;
  }

  void prepare(const PairQuery* queries, std::size_t count, Estimator estimator) {
    prepared.resize(count);
    const auto some = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) prepared[i] = innersphere::prepare(queries[i], i, estimator);
    };
    try {
      workers.forRanges(count, kGrain, some);
    } catch (const Error&) {
      some(0, count);  // throws that of the first bad query, whoever came first
      throw;
    }
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
  impl.prepare(queries, count, options.estimator);
  impl.choose().run(impl.prepared, options.want, impl.sums, impl.hits);
  impl.sorter.run(impl.prepared, impl.sums, impl.hits, options.want, impl.workers, result);
  result.overlaps.resize(count);
  impl.workers.forRanges(count, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      result.overlaps[i] = toOverlap(impl.sums[i], impl.prepared[i].setup);
  });
}

Overlap QueryContext::overlap(const PairQuery& query, const QueryOptions& options) {
  QueryOptions sums_only = options;
  if (wantsHits(options.want)) sums_only.want = Want::wrench;
  run(&query, 1, sums_only, impl_->single);
  return impl_->single.overlaps[0];
}

double QueryContext::kernelTime() const {
  return impl_->last == Backend::cuda ? impl_->cuda->kernelTime() : 0;
}

Backend QueryContext::lastBackend() const {
  return impl_->last;
}

}  // namespace innersphere
