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
  automatic,  ///< by the amount of work, CUDA if it is compiled in and a device is there; the same results within 1e-5
  cpu,
  cuda  ///< Error no_device if there is none: never a silent fallback
};

/// What is computed. Each value includes those before it, except that contacts and pairs are independent of each other;
/// asking for less costs less.
enum class Want {
  touch,     ///< pair_count is 0 or not 0
  volume,    ///< volume, centroid, pair_count
  wrench,    ///< all of Overlap
  contacts,  ///< also the contacts of each sphere, of both bodies
  pairs      ///< also the overlapping pairs, sorted by (a, b)
};

/// Two bodies to collide.
struct PairQuery {
  const CollisionModel* a = nullptr;
  const CollisionModel* b = nullptr;
  Placement placement_a;
  Placement placement_b;
  std::uint32_t prefix_a = 0;  ///< use only so many spheres of A, the largest ones; 0: all
  std::uint32_t prefix_b = 0;
  double margin = 0;           ///< [m], >= 0: pairs count as overlapping up to this distance; every sphere of A grows by it
};

struct QueryOptions {
  Want want = Want::wrench;
  Estimator estimator = Estimator::volume_true;
};

/// Results of a batch. Keep the object and pass it again: after warm-up nothing is allocated.
struct QueryResult {
  std::vector<Overlap> overlaps;  ///< one for each query, in order

  /// Items of query i are items[first[i]] to items[first[i + 1]], i < overlaps.size().
  template <typename T>
  struct Ranges {
    std::vector<T> items;
    std::vector<std::size_t> first;
  };
  Ranges<SpherePair> pairs;          ///< Want::pairs
  Ranges<SphereContact> contacts_a;  ///< Want::contacts: spheres of A that touch, by rising index
  Ranges<SphereContact> contacts_b;  ///< the same for B
};

struct QueryContextOptions {
  Backend backend = Backend::automatic;
  int threads = 0;  ///< of the CPU backend; 0: all cores. The result does not depend on it.
};

/// True if CUDA is compiled in and a device answers. Creates no CUDA context.
bool cudaAvailable();

/// Runs queries. Holds scratch memory and, after the first query that goes there, a stream of the device: use one
/// context for each thread. Sums are the same bits on every run, for any number of threads and any place in a batch.
class QueryContext {
 public:
  /// Throws Error no_device if CUDA was asked for by name and there is none.
  explicit QueryContext(const QueryContextOptions& options = {});
  ~QueryContext();
  QueryContext(QueryContext&&) noexcept;
  QueryContext& operator=(QueryContext&&) noexcept;

  /// Collides `count` pairs. Throws Error: bad_argument (null or non-rigid or non-positive scale), not_finite,
  /// device_error, device_out_of_memory; the context stays usable.
  void run(const PairQuery* queries, std::size_t count, const QueryOptions& options, QueryResult& result);

  /// One pair, only its sums.
  Overlap overlap(const PairQuery& query, const QueryOptions& options = {});

  /// The backend that the last run used: cpu or cuda.
  Backend lastBackend() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace innersphere
