// Runs the overlap query, on the CPU or in CUDA.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "innersphere/collision_model.hpp"
#include "innersphere/overlap.hpp"
#include "innersphere/placement.hpp"
#include "innersphere/poses.hpp"

namespace innersphere {

/// Says where a query runs.
enum class Backend {
  /// The CPU or, if there is enough work and a device, CUDA. Both give the same results, to the bit.
  automatic,
  cpu,   ///< The CPU.
  cuda,  ///< CUDA. Error no_device if there is none: there is no silent fallback.
};

/// Says what is computed. Asking for less costs less.
enum class Want {
  touch,          ///< Whether anything overlaps: pair_count is 0 or 1, all else is zero.
  volume,         ///< The volume, the centroid and pair_count.
  wrench,         ///< All of Overlap.
  contacts_of_a,  ///< All of Overlap and the contacts of the spheres of A, which buildPatches() needs.
  contacts,       ///< All of Overlap and the contacts of the spheres of A and of B.
  pairs           ///< All of Overlap and the overlapping pairs, sorted by (a, b). No contacts.
};

/// Names two bodies to collide, and where they are.
struct PairQuery {
  const CollisionModel* a = nullptr;  ///< The first body. Never null.
  const CollisionModel* b = nullptr;  ///< The second body. Never null; may be the same model.
  Placement placement_a;              ///< Where A is.
  Placement placement_b;              ///< Where B is.
  /// The number of spheres of A to use, the largest ones. 0, or more than there are: all. Volume-true radii
  /// exist for some lengths only: with Estimator::volume_true the query uses the longest of these that is not
  /// longer than this (see volumeTrueRadii()). If there is none, it uses exactly this many spheres with their
  /// raw radii.
  std::uint32_t prefix_a = 0;
  std::uint32_t prefix_b = 0;  ///< The number of spheres of B to use, likewise.
  /// The distance [m], >= 0, up to which pairs count as overlapping. Every sphere of A grows by it, in all
  /// results.
  double margin = 0;
};

/// Says what a query computes.
struct QueryOptions {
  Want want = Want::wrench;                      ///< What is not wanted is zero or empty in the result.
  Estimator estimator = Estimator::volume_true;  ///< What stands for both solids.
  /// Where contacts are wanted: whether all of Overlap is, too. Otherwise all of it but pair_count is zero,
  /// which saves the CPU up to a tenth of the time. Nothing else changes.
  bool sums = true;
};

/// Holds the results of a batch. Keep the object and pass it again: after warm-up nothing is allocated.
struct QueryResult {
  std::vector<Overlap> overlaps;  ///< The overlap of each query, in their order.

  /// Holds the lists of all queries. Those of query i are items[first[i]] to items[first[i + 1]], without the
  /// last.
  template <typename T>
  struct Ranges {
    /// The items of all queries, one after the other.
    std::vector<T> items;
    /// Where the items of each query begin, and at last the end of all: one more than there are queries.
    std::vector<std::size_t> first;
  };
  Ranges<SpherePair> pairs;          ///< The pairs, with Want::pairs.
  Ranges<SphereContact> contacts_a;  ///< Spheres of A that touch, by rising index.
  Ranges<SphereContact> contacts_b;  ///< Spheres of B that touch, with Want::contacts.
};

inline constexpr int kCurrentDevice = -1;  ///< The CUDA device that is current in the calling thread.
inline constexpr int kAllDevices = -2;     ///< All CUDA devices of the machine.

inline constexpr int kMostThreads = 4096;  ///< See QueryContextOptions::threads.

inline constexpr double kMostResidentSeconds = 1;  ///< See QueryContextOptions::resident_seconds.

/// Says how queries run.
struct QueryContextOptions {
  Backend backend = Backend::automatic;  ///< Where queries run.
  /// The threads of the CPU backend, 0 to kMostThreads. 0: all cores. The result does not depend on it.
  int threads = 0;
  bool time_kernels = false;  ///< Whether kernelTime() is measured, which takes some microseconds a run.
  /// The CUDA device: a number from 0 on, kCurrentDevice, or kAllDevices, which share a batch or a sweep.
  /// Results do not depend on it. It need not be there as long as queries run on the CPU. Each device keeps
  /// copies of the models that it has worked on.
  int device = kCurrentDevice;
  /// How long a kernel stays on the device after a single query without pairs or contacts [s], from 0 to
  /// kMostResidentSeconds, waiting for the next one with the same models: then none has to be launched, which
  /// saves some microseconds, as a control loop at 1 kHz may want. 0: none stays. As long as it is there it
  /// fills the device: work of others, also of other contexts, waits until it leaves. Other queries of this
  /// context send it away. Not with time_kernels.
  double resident_seconds = 0;
};

/// Returns the number of CUDA devices that answer; 0 if CUDA is not compiled in. Creates no CUDA context.
int cudaDeviceCount();

/// Returns true if CUDA is compiled in and a device answers. Creates no CUDA context.
bool cudaAvailable();

/// Runs queries. A context holds scratch memory and, after the first query on a device, a stream of that
/// device. Use one context for each thread. Results have the same bits on every run, for any number of
/// threads and any place in a batch. Without a margin, swapping A and B negates force and area exactly.
class QueryContext {
 public:
  /// Makes a context. Throws Error: no_device if CUDA was asked for by name and there is none, or none of
  /// that number; bad_argument for a negative number of threads, or one that names no device.
  explicit QueryContext(const QueryContextOptions& options = {});
  ~QueryContext();
  /// Takes what the other context holds, which can then only be destroyed or assigned to.
  QueryContext(QueryContext&&) noexcept;
  /// Takes what the other context holds, as the constructor does, and frees its own.
  QueryContext& operator=(QueryContext&&) noexcept;

  /// Collides `count` pairs. Throws Error: bad_argument (a null model, a rotation that is not one, a scale or
  /// margin out of range), not_finite, device_error, device_out_of_memory; the message names the query. With
  /// Estimator::surface also empty_input (a packing without triangles), not_a_solid (its triangles are not
  /// closed) and bad_argument (a margin, a model after update()). The context stays usable and `result` as it
  /// was.
  void run(const PairQuery* queries, std::size_t count, const QueryOptions& options, QueryResult& result);

  /// Collides one pair and returns its sums. Contacts and pairs are left out, even if they are wanted.
  Overlap overlap(const PairQuery& query, const QueryOptions& options = {});

  /// Collides one pair with B in many poses: for each of `poses` what overlap() gives with these as rotation
  /// and translation of placement_b, to the bit. Scales, margin, prefixes and placement_a are those of
  /// `pair`. `overlaps` has room for poses.count of them. On a device the poses are prepared there, so that a
  /// sweep costs the host nothing for each pose; both arrays may then be in the memory of a device, or
  /// pinned, and are used in place, after what the default stream of the device had to do when sweep() was
  /// called. Memory of the context stays bounded, however many poses there are.
  /// Contacts and pairs are left out, even if they are wanted. Throws as run() does; the message names the
  /// first pose that is none. Then some overlaps are written, others not. With Estimator::surface the CPU
  /// prepares the poses, and the arrays must be in its memory.
  void sweep(const PairQuery& pair, const Poses& poses, const QueryOptions& options, Overlap* overlaps);

  /// Puts a sweep into a stream of CUDA's and returns, without waiting for a device. What was put into the
  /// stream before, such as kernels that write the poses, is done first, and what comes after it finds the
  /// overlaps. `stream` is a cudaStream_t of the context's device, null for the default one; it must live
  /// until waitSweep(), as must the models. The arrays must be in memory of the device, or pinned, and are
  /// used in place: nothing is copied. More sweeps may follow in the same stream; the context has no other
  /// query under way until waitSweep(), which throws all errors. With Backend::automatic the sweep runs on a
  /// device if a stream is given or an array is in its memory. On the CPU this does all the work. Not for
  /// kAllDevices. A pose that is none gets an overlap of zeros. The host launches each part of up to 16,384
  /// poses, so that some millions of them keep it busy.
  void startSweep(const PairQuery& pair, const Poses& poses, const QueryOptions& options, Overlap* overlaps,
                  void* stream = nullptr);
  /// Waits until the stream has done all sweeps that startSweep() put into it. Throws what sweep() would, for
  /// the first of them that fails; does nothing if there is none.
  void waitSweep();

  /// Starts run(), whose second half is wait(), so that the caller can do other things while a device works.
  /// It copies what it needs of the queries and returns; wait() gives what run() would, to the bit. On the
  /// CPU start() does all the work. A context has one query under way, and models must live until wait(). All
  /// errors are thrown by wait(), also those of a second start() or of a wait() without a start(). Long
  /// batches (some 2,000 pairs of 60,000 spheres or 32,000 of small packings) go to the device in parts, of
  /// which later ones start in ready() or wait().
  void start(const PairQuery* queries, std::size_t count, const QueryOptions& options);
  /// Waits for what start() began and fills in `result` as run() does. Throws what run() would throw, or what
  /// start() met.
  void wait(QueryResult& result);
  /// Starts overlap(), as start() does run().
  void startOverlap(const PairQuery& query, const QueryOptions& options = {});
  /// Waits for what startOverlap() began and returns its sums. Throws as wait() does.
  Overlap waitOverlap();

  /// Returns true if wait() will return at once. With contacts or pairs the device works in two steps, and
  /// the second step begins in the first call of ready() or wait() after the first step.
  bool ready();

  /// Returns the backend that the last run used, cpu or cuda; cpu before the first.
  Backend lastBackend() const;

  /// Returns how long the device worked on the last run, by its own clock [s]. 0 if the run was on the CPU or
  /// QueryContextOptions::time_kernels is off. Copies of results are not included.
  double kernelTime() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace innersphere
