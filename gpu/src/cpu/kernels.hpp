// Declares the loops of the CPU backend that run on several numbers at once, compiled for several generations
// of x86-64 processors; the best that this one knows is chosen at run time. All give the same bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "batch/overlapping_pairs.hpp"
#include "core/sums.hpp"
#include "core/traversal.hpp"
#include "grid/hash_grid.hpp"
#include "innersphere/overlap.hpp"

namespace innersphere {

/// Holds pairs to decide, as places in the grids.
struct Candidates {
  static constexpr std::size_t kSize = 256;
  std::array<std::uint32_t, kSize> query_sphere;  ///< in the grid of the body that searches
  std::array<std::uint32_t, kSize> partner;       ///< in the grid it traverses
  std::size_t count = 0;
};
static_assert(Candidates::kSize <= std::size_t{1} << core::kShortSumBits);

/// Takes candidates whenever there is no room for more. Returns false to stop the traversal.
class CandidateSink {
 public:
  virtual ~CandidateSink() = default;
  virtual bool take(Candidates& candidates) = 0;
};

/// Holds what some candidates add up to.
struct Tally {
  std::array<core::ShortSum, core::kTerms> sums{};
  std::size_t pairs = 0;
  std::array<std::uint8_t, Candidates::kSize> found;          ///< for each candidate: does it count?
  alignas(64) double terms[core::kTerms][Candidates::kSize];  ///< of each; zeros of those that do not count
};

struct CpuKernels {
  /// Returns a bit for each of up to 32 balls of the searching body that can meet the grid.
  std::uint32_t (*ballsMeeting)(const core::Traversal& traversal, const Occupancy& occupancy,
                                const Sphere* balls, std::uint32_t count);
  /// Finds the candidates of some clusters, and hands them on where the room ends; the last of them stay in
  /// `candidates`. `listed` is of the grid that is traversed. Returns false if it was stopped.
  bool (*traverse)(const core::Traversal& traversal, const SphereColumns& listed,
                   const std::uint32_t* clusters, std::size_t count, Candidates& candidates,
                   CandidateSink& sink);
  /// Decides candidates and sums those that count: all terms, or only volumes.
  void (*sumAll)(const core::Setup& setup, bool from_a, const Candidates& candidates, Tally& tally);
  void (*sumVolumes)(const core::Setup& setup, bool from_a, const Candidates& candidates, Tally& tally);
  /// Decides candidates for writeValues() alone, which finds the same as after sumAll(). Leaves sums as they
  /// are.
  void (*decide)(const core::Setup& setup, bool from_a, const Candidates& candidates, Tally& tally);
  /// Writes the values of those of the first `count` candidates that count, after sumAll().
  void (*writeValues)(const Tally& tally, std::size_t count, ContactValues* values);
  /// Sums overlapping pairs order[heads[c]] to order[heads[c + 1]] into the contact number c, from `begin` to
  /// `end`.
  void (*sumContacts)(const ContactValues* values, const std::uint32_t* order, const std::size_t* heads,
                      std::size_t begin, std::size_t end, SphereContact* contacts);
  /// Finds the first of some directions that is nearest to each unit vector. All are read, and all groups
  /// written, up to whole kLanes.
  void (*nearestDirections)(const float* x, const float* y, const float* z, std::size_t count,
                            const Vec3f* directions, std::size_t direction_count, std::uint32_t* nearest);
};

/// Returns the kernels that this processor can run, the best ones first.
const std::vector<const CpuKernels*>& supportedKernels();

inline const CpuKernels& cpuKernels() {
  return *supportedKernels().front();
}

}  // namespace innersphere
