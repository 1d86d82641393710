#include "innersphere/query.hpp"

#include <exception>
#include <string>
#include <utility>

#include "batch/prepare.hpp"
#include "cpu/cpu_backend.hpp"
#include "cuda/cuda_backend.hpp"
#include "innersphere/error.hpp"

namespace innersphere {

namespace {

/// Clusters of spheres in a batch from which on a launch on the device pays: the host waits 15 us for one, in
/// which one core searches those of two packings of 400 spheres that overlap by a half, or of 3,200 that
/// touch.
constexpr std::size_t kDeviceClusters = 60;

constexpr std::size_t kGrain = 64;  ///< queries of a batch that one thread prepares

}  // namespace

struct QueryContext::Impl {
  explicit Impl(const QueryContextOptions& o) : options(o), workers(o.threads), cpu(workers) {
    if (options.backend != Backend::cuda) return;
    cuda = makeCudaBackend(workers, options.time_kernels);
    last = Backend::cuda;
  }

  /// Looks for a device only once there is work for it: that alone can take a tenth of a second.
  bool paysOnDevice() {
    std::size_t clusters = 0;
    for (const PreparedQuery& query : prepared) clusters += query.clusters();
    if (clusters < kDeviceClusters) return false;
    if (!cuda && !looked_for_device && cudaDeviceAnswers())
      cuda = makeCudaBackend(workers, options.time_kernels);
    looked_for_device = true;
    return cuda != nullptr;
  }

  void prepare(const PairQuery* queries, std::size_t count, Estimator estimator) {
    prepared.resize(count);
    const auto some = [&](std::size_t begin, std::size_t end) {
      KnownGrids grids;
      for (std::size_t i = begin; i < end; ++i)
        prepared[i] = innersphere::prepare(queries[i], i, estimator, grids);
    };
    try {
      workers.forRanges(count, kGrain, some);
    } catch (const Error&) {
      some(0, count);  // throws that of the first bad query, whoever came first
      throw;
    }
  }

  QueryBackend& choose() {
    const bool on_device =
        options.backend == Backend::cuda || (options.backend == Backend::automatic && paysOnDevice());
    last = on_device ? Backend::cuda : Backend::cpu;
    if (on_device) return *cuda;
    workers.forRanges(prepared.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) bringToCpu(prepared[i]);
    });
    return cpu;
  }

  void start(const PairQuery* queries, std::size_t count, const QueryOptions& query_options) {
    if (under_way)
      throw Error(ErrorCode::bad_argument, "a query is under way in this context; wait for it first");
    if (count > 0 && !queries) throw Error(ErrorCode::bad_argument, "the queries are a null pointer");
    if (count >> 32) throw Error(ErrorCode::bad_argument, "a batch has at most 2^32 - 1 queries; split it");
    prepare(queries, count, query_options.estimator);
    QueryBackend& backend = choose();
    backend.start(prepared, query_options.want);
    under_way = &backend;
  }

  void finish(QueryResult& result) {
    QueryBackend& backend = *under_way;
    under_way = nullptr;
    backend.finish(result);
  }

  QueryContextOptions options;
  Workers workers;
  CpuBackend cpu;
  std::unique_ptr<QueryBackend> cuda;
  bool looked_for_device = false;
  Backend last = Backend::cpu;
  QueryBackend* under_way = nullptr;
  std::exception_ptr failed;  ///< what start() met, for wait()

  // Scratch, kept from run to run.
  std::vector<PreparedQuery> prepared;
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
  if (impl_->failed) wait(result);  // throws
  impl_->start(queries, count, options);
  impl_->finish(result);
}

void QueryContext::start(const PairQuery* queries, std::size_t count, const QueryOptions& options) {
  if (impl_->failed) return;  // the first error is the one to report
  try {
    impl_->start(queries, count, options);
  } catch (...) {
    impl_->failed = std::current_exception();
  }
}

bool QueryContext::ready() {
  if (impl_->failed || !impl_->under_way) return true;
  try {
    return impl_->under_way->ready();
  } catch (...) {
    impl_->failed = std::current_exception();
    impl_->under_way = nullptr;
    return true;
  }
}

void QueryContext::wait(QueryResult& result) {
  if (impl_->failed) std::rethrow_exception(std::exchange(impl_->failed, nullptr));
  if (!impl_->under_way)
    throw Error(ErrorCode::bad_argument, "no query is under way; start one before waiting");
  impl_->finish(result);
}

Overlap QueryContext::overlap(const PairQuery& query, const QueryOptions& options) {
  startOverlap(query, options);
  return waitOverlap();
}

void QueryContext::startOverlap(const PairQuery& query, const QueryOptions& options) {
  QueryOptions sums_only = options;
  if (wantsPairs(options.want)) sums_only.want = Want::wrench;
  start(&query, 1, sums_only);
}

Overlap QueryContext::waitOverlap() {
  wait(impl_->single);
  return impl_->single.overlaps.at(0);
}

double QueryContext::kernelTime() const {
  return impl_->last == Backend::cuda ? impl_->cuda->kernelTime() : 0;
}

Backend QueryContext::lastBackend() const {
  return impl_->last;
}

}  // namespace innersphere
