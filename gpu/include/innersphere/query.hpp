// The overlap query, on the CPU or in CUDA.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "innersphere/collision_model.hpp"
#include "innersphere/overlap.hpp"
#include "innersphere/placement.hpp"

namespace innersphere {

/// Where a query runs.
enum class Backend {
  automatic,  ///< by the amount of work, CUDA if it is compiled in and a device is there; the same pairs,
              ///< sums within 1e-5
  cpu,
  cuda  ///< Error no_device if there is none: never a silent fallback
};

/// What is computed. Each value includes those before it, except that pairs come without contacts; asking for
/// less costs less.
enum class Want {
  touch,          ///< only whether anything overlaps: pair_count is 0 or 1
  volume,         ///< volume, centroid, pair_count
  wrench,         ///< all of Overlap
  contacts_of_a,  ///< also the contacts of each sphere of A: enough for buildPatches()
  contacts,       ///< also those of B
  pairs           ///< also the overlapping pairs, sorted by (a, b)
};

/// Two bodies to collide.
struct PairQuery {
  const CollisionModel* a = nullptr;  ///< the first body; never null
  const CollisionModel* b = nullptr;  ///< the second body; never null, may be the same model
  Placement placement_a;              ///< where A is
  Placement placement_b;              ///< where B is
  /// Use only so many spheres of A, the largest ones; 0, or more than there are: all. Volume-true radii exist
  /// for some lengths only: with Estimator::volume_true the query uses the longest of them that is not longer
  /// than this (see volumeTrueRadii()), and exactly this many spheres with their raw radii if none is.
  std::uint32_t prefix_a = 0;
  std::uint32_t prefix_b = 0;  ///< the same for B
  /// [m], >= 0: pairs count as overlapping up to this distance. Every sphere of A grows by it, in all
  /// results.
  double margin = 0;
};

/// What a query computes.
struct QueryOptions {
  Want want = Want::wrench;                      ///< what is not wanted is zero or empty in the result
  Estimator estimator = Estimator::volume_true;  ///< of both bodies
};

/// Results of a batch. Keep the object and pass it again: after warm-up nothing is allocated.
struct QueryResult {
  std::vector<Overlap> overlaps;  ///< one for each query, in order

  /// Items of query i are items[first[i]] to items[first[i + 1]], i < overlaps.size().
  template <typename T>
  struct Ranges {
    std::vector<T> items;            ///< of all queries, one after the other
    std::vector<std::size_t> first;  ///< where each query begins, and the end
  };
  Ranges<SpherePair> pairs;          ///< Want::pairs
  Ranges<SphereContact> contacts_a;  ///< Want::contacts_of_a: spheres of A that touch, by rising index
  Ranges<SphereContact> contacts_b;  ///< Want::contacts: the same for B
};

/// How queries run.
struct QueryContextOptions {
  Backend backend = Backend::automatic;  ///< where queries run
  int threads = 0;            ///< of the CPU backend; 0: all cores. The result does not depend on it.
  bool time_kernels = false;  ///< for kernelTime(); a run then takes some microseconds longer
};

/// True if CUDA is compiled in and a device answers. Creates no CUDA context.
bool cudaAvailable();

/// Runs queries. Holds scratch memory and, after the first query that goes there, a stream of the device: use
/// one context for each thread. All results are the same bits on every run, for any number of threads and any
/// place in a batch; without a margin, swapping A and B negates force and area exactly.
class QueryContext {
 public:
  /// Throws Error no_device if CUDA was asked for by name and there is none.
  explicit QueryContext(const QueryContextOptions& options = {});
  ~QueryContext();
  /// Takes what the other context holds, which can then only be destroyed or assigned to.
  QueryContext(QueryContext&&) noexcept;
  /// The same.
  QueryContext& operator=(QueryContext&&) noexcept;

  /// Collides `count` pairs. Throws Error: bad_argument (a null model, a rotation that is not one, a scale or
  /// margin out of range), not_finite, device_error, device_out_of_memory; the message names the query. The
  /// context stays usable and `result` as it was.
  void run(const PairQuery* queries, std::size_t count, const QueryOptions& options, QueryResult& result);

  /// One pair, only its sums: contacts and pairs, where they are wanted, are left out.
  Overlap overlap(const PairQuery& query, const QueryOptions& options = {});

  /// The same two calls in halves, so that the caller can do other things while a device works: start()
  /// copies what it needs of the queries and returns, wait() gives what run() would, to the bit. On the CPU
  /// start() does all the work. A context has one query under way; models must live until wait(). All errors,
  /// also of a second start() or of a wait() without one, are thrown by wait(). Of long batches (some 2,000
  /// pairs of 60,000 spheres, 32,000 of small packings) the device gets what follows while ready() or wait()
  /// is called.
  void start(const PairQuery* queries, std::size_t count, const QueryOptions& options);
  /// The second half of run().
  void wait(QueryResult& result);
  /// The first half of overlap().
  void startOverlap(const PairQuery& query, const QueryOptions& options = {});
  /// The second half of overlap().
  Overlap waitOverlap();

  /// True if wait() will return at once. With contacts or pairs the device works in two steps,
  /// the second of which begins when this is called after the first.
  bool ready();

  /// The backend that the last run used: cpu or cuda.
  Backend lastBackend() const;

  /// How long the device worked on the last run, by its own clock [s]; 0 if that ran on the CPU or
  /// QueryContextOptions::time_kernels is off. Copies of the results, where there are any, are not in it.
  double kernelTime() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace innersphere
