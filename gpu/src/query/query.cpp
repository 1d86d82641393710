#include "innersphere/query.hpp"

#include <algorithm>
#include <exception>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "batch/prepare.hpp"
#include "cpu/cpu_backend.hpp"
#include "cuda/cuda_backend.hpp"
#include "innersphere/error.hpp"
#include "query/surface_query.hpp"

namespace innersphere {

namespace {

/// Clusters of spheres in a batch from which on a launch on the device pays: the host waits 15 us for one, in
/// which one core searches those of two packings of 400 spheres that overlap by a half, or of 3,200 that
/// touch.
constexpr std::size_t kDeviceClusters = 60;
/// The same where pairs or contacts are wanted, which a device sorts and sends home in 100 us and more: 16
/// cores find those of 32 pairs of 500 spheres in as long, if they overlap lightly, and of half as many if
/// deeply.
constexpr std::size_t kDeviceClustersOfLists = 1000;

constexpr std::size_t kGrain = 64;  ///< queries of a batch that one thread prepares

constexpr std::size_t kSurfaceBatch = 1024;  ///< poses of a sweep over surfaces: bounds the memory

bool anyOnDevice(const Poses& poses, const Overlap* overlaps) {
  const void* const arrays[] = {poses.matrices, poses.positions, poses.quaternions, overlaps};
  return std::any_of(std::begin(arrays), std::end(arrays),
                     [](const void* p) { return p && isOnCudaDevice(p); });
}

}  // namespace

struct QueryContext::Impl {
  explicit Impl(const QueryContextOptions& o) : options(o), workers(o.threads), cpu(workers) {
    if (options.backend != Backend::cuda) return;
    makeCuda();
    last = Backend::cuda;
  }

  /// Looks for a device only once there is work for it: that alone can take a tenth of a second.
  bool paysOnDevice(Want want) {
    std::size_t clusters = 0;
    for (const PreparedQuery& query : prepared) clusters += query.clusters();
    if (clusters < (wantsPairs(want) ? kDeviceClustersOfLists : kDeviceClusters)) return false;
    return findDevice();
  }

  bool findDevice() {
    if (!cuda && !looked_for_device && cudaDeviceAnswers()) makeCuda();
    looked_for_device = true;
    return cuda != nullptr;
  }

  void makeCuda() { cuda = makeCudaBackend(workers, options); }

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

  void checkIdle() const {
    if (under_way || sweeping)
      throw Error(ErrorCode::bad_argument, "a query is under way in this context; wait for it first");
  }

  QueryBackend& choose(Want want) {
    const bool on_device =
        options.backend == Backend::cuda || (options.backend == Backend::automatic && paysOnDevice(want));
    last = on_device ? Backend::cuda : Backend::cpu;
    if (on_device) return *cuda;
    workers.forRanges(prepared.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) bringToCpu(prepared[i]);
    });
    return cpu;
  }

  void start(const PairQuery* queries, std::size_t count, const QueryOptions& query_options) {
    checkIdle();
    if (count > 0 && !queries) throw Error(ErrorCode::bad_argument, "the queries are a null pointer");
    if (count >> 32) throw Error(ErrorCode::bad_argument, "a batch has at most 2^32 - 1 queries; split it");
    prepare(queries, count, estimatorOfSpheres(query_options));
    for_surfaces.keep(queries, count, query_options);
    if (needsNoSpheres(query_options)) prepared.clear();  // they have been checked
    QueryBackend& backend = choose(query_options.want);
    without_sums = wantsContacts(query_options.want) && !query_options.sums;
    cpu.leaveOutSums(without_sums);
    backend.start(prepared, query_options.want);
    under_way = &backend;
  }

  static void checkArrays(const Poses& poses, const Overlap* overlaps) {
    if (!overlaps || (!poses.matrices && !(poses.positions && poses.quaternions)))
      throw Error(ErrorCode::bad_argument, "an array of poses or overlaps is a null pointer");
  }

  static Sweep prepareSweep(const PairQuery& pair, const Poses& poses, const QueryOptions& query_options) {
    PairQuery at_origin = pair;
    at_origin.placement_b.rotation = Placement().rotation;
    at_origin.placement_b.translation = pair.placement_a.translation;
    KnownGrids grids;
    const PreparedQuery first = innersphere::prepare(at_origin, 0, query_options.estimator, grids);
    const core::Setup& setup = first.setup;
    return {{{setup.a, setup.frame.matrix_a, setup.frame.scale_a, setup.frame.margin_a},
             {setup.b, setup.frame.matrix_b, setup.frame.scale_b, setup.frame.margin_b},
             pair.placement_a.translation},
            first.grid_a,
            first.grid_b,
            poses,
            wantsPairs(query_options.want) ? Want::wrench : query_options.want};
  }

  void sweep(const PairQuery& pair, const Poses& poses, const QueryOptions& query_options,
             Overlap* overlaps) {
    checkIdle();
    if (poses.count == 0) return;
    checkArrays(poses, overlaps);
    if (query_options.estimator == Estimator::surface)
      return sweepSurfaces(pair, poses, query_options, overlaps);
    const Sweep sweep = prepareSweep(pair, poses, query_options);
    const bool pays = sweep.clusters() * poses.count >= kDeviceClusters;
    chooseFor(sweep, overlaps, pays).sweep(sweep, overlaps);
  }

  void startSweep(const PairQuery& pair, const Poses& poses, const QueryOptions& query_options,
                  Overlap* overlaps, void* stream) {
    if (!sweeping) checkIdle();
    if (poses.count == 0) return;
    checkArrays(poses, overlaps);
    if (query_options.estimator == Estimator::surface) {
      if (stream)
        throw Error(ErrorCode::bad_argument, "a stream was given, and Estimator::surface works on the CPU");
      return sweepSurfaces(pair, poses, query_options, overlaps);
    }
    const Sweep sweep = prepareSweep(pair, poses, query_options);
    QueryBackend& backend = chooseFor(sweep, overlaps, stream != nullptr);
    if (sweeping && sweeping != &backend)
      throw Error(ErrorCode::bad_argument, "sweeps are under way elsewhere; wait for them first");
    sweeping = &backend;
    backend.startSweep(sweep, overlaps, stream);
  }

  void waitSweep() {
    QueryBackend* const backend = std::exchange(sweeping, nullptr);
    std::exception_ptr first = std::exchange(failed, nullptr);
    try {
      if (backend) backend->finishSweeps();  // also where a later one could not be started
    } catch (...) {
      first = std::current_exception();
    }
    if (first) std::rethrow_exception(first);
  }

  /// Makes a batch of each of a few poses.
  void sweepSurfaces(const PairQuery& pair, const Poses& poses, const QueryOptions& query_options,
                     Overlap* overlaps) {
    if (anyOnDevice(poses, overlaps))
      throw Error(ErrorCode::bad_argument,
                  "an array is in the memory of a device, and Estimator::surface works on the CPU");
    QueryOptions sums_only = query_options;
    if (wantsPairs(sums_only.want)) sums_only.want = Want::wrench;
    std::vector<PairQuery> queries;
    QueryResult result;
    for (std::size_t first = 0; first < poses.count; first += kSurfaceBatch) {
      queries.assign(std::min(kSurfaceBatch, poses.count - first), pair);
      for (std::size_t i = 0; i < queries.size(); ++i) {
        core::Mat3<double> rotation;
        const core::Fault fault =
            core::readPose(poses, first + i, rotation, queries[i].placement_b.translation);
        if (fault != core::Fault::none) failFor(fault, first + i, "B");
        // As it was given: the query makes it orthonormal, once.
        core::loadPose(poses, first + i, rotation, queries[i].placement_b.translation);
        std::copy(std::begin(rotation.m), std::end(rotation.m), queries[i].placement_b.rotation.begin());
      }
      start(queries.data(), queries.size(), sums_only);
      finish(result);
      std::copy(result.overlaps.begin(), result.overlaps.end(), overlaps + first);
    }
  }

  /// `pays`: on a device, where the choice is free.
  QueryBackend& chooseFor(const Sweep& sweep, const Overlap* overlaps, bool pays) {
    const bool given_on_device = anyOnDevice(sweep.poses, overlaps);
    if (given_on_device && options.backend == Backend::cpu)
      throw Error(ErrorCode::bad_argument,
                  "an array is in the memory of a device, and the CPU was asked for");
    const bool on_device = options.backend == Backend::cuda || (options.backend == Backend::automatic &&
                                                                (given_on_device || pays) && findDevice());
    last = on_device ? Backend::cuda : Backend::cpu;
    return on_device ? *cuda : static_cast<QueryBackend&>(cpu);
  }

  void finish(QueryResult& result) {
    QueryBackend& backend = *under_way;
    under_way = nullptr;
    backend.finish(result);
    if (!without_sums) return for_surfaces.refine(workers, result.overlaps);
    for (Overlap& overlap : result.overlaps) {
      const std::uint64_t pairs = overlap.pair_count;
      overlap = Overlap();
      overlap.pair_count = pairs;
    }
  }

  QueryContextOptions options;
  Workers workers;
  CpuBackend cpu;
  std::unique_ptr<QueryBackend> cuda;
  bool looked_for_device = false;
  Backend last = Backend::cpu;
  bool without_sums = false;  ///< in the batch that is under way
  QueryBackend* under_way = nullptr;
  QueryBackend* sweeping = nullptr;  ///< what has sweeps under way, in a stream of the user's
  std::exception_ptr failed;         ///< what start() met, for wait()

  // Scratch, kept from run to run.
  std::vector<PreparedQuery> prepared;
  SurfaceQueries for_surfaces;
  QueryResult single;
};

std::optional<Placement> placementAt(const Poses& poses, std::size_t number) {
  core::Mat3<double> rotation;
  Placement place;
  if (core::loadPose(poses, number, rotation, place.translation) != core::Fault::none) return std::nullopt;
  std::copy(std::begin(rotation.m), std::end(rotation.m), place.rotation.begin());
  return place;
}

int cudaDeviceCount() {
  return cudaDevices();
}

bool cudaAvailable() {
  return cudaDeviceAnswers();
}

QueryContext::QueryContext(const QueryContextOptions& options) {
  if (options.threads < 0 || options.threads > kMostThreads) {
    throw Error(ErrorCode::bad_argument, "threads is " + std::to_string(options.threads) +
                                             "; it must be from 0 (all cores) to " +
                                             std::to_string(kMostThreads));
  }
  if (options.device < kAllDevices)
    throw Error(ErrorCode::bad_argument, "there is no CUDA device " + std::to_string(options.device));
  if (!(options.resident_seconds >= 0 && options.resident_seconds <= kMostResidentSeconds))
    throw Error(ErrorCode::bad_argument, "resident_seconds is " + std::to_string(options.resident_seconds) +
                                             "; it must be from 0 to " +
                                             std::to_string(kMostResidentSeconds));
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

void QueryContext::sweep(const PairQuery& pair, const Poses& poses, const QueryOptions& options,
                         Overlap* overlaps) {
  if (impl_->failed) std::rethrow_exception(std::exchange(impl_->failed, nullptr));
  impl_->sweep(pair, poses, options, overlaps);
}

void QueryContext::startSweep(const PairQuery& pair, const Poses& poses, const QueryOptions& options,
                              Overlap* overlaps, void* stream) {
  if (impl_->failed) return;  // the first error is the one to report
  try {
    impl_->startSweep(pair, poses, options, overlaps, stream);
  } catch (...) {
    impl_->failed = std::current_exception();
  }
}

void QueryContext::waitSweep() {
  impl_->waitSweep();
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
