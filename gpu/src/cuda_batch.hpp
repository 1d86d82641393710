// What the kernels of a batch share: its arguments, the candidates between them, and its sums.
#pragma once

#include <cuda_runtime.h>

#include <cstdint>

#include "backend.hpp"
#include "core/sums.hpp"

namespace innersphere::device {

constexpr unsigned kWarp = 32;
constexpr unsigned kAll = 0xffffffffu;
static_assert(core::kClusterSize == kWarp, "a warp walks one cluster");
constexpr unsigned kLargestJob = 8;         ///< clusters
constexpr std::uint32_t kFromA = 1u << 31;  ///< of a candidate's walker

/// The sum of one term as three numbers that any number of warps can add to without a carry between them.
struct Limbs {
  unsigned long long fine;         ///< in units of the quantum
  unsigned long long coarse_low;   ///< in units of 2^fine_bits quanta
  unsigned long long coarse_high;  ///< in units of 2^(fine_bits + 32)
};

struct DeviceSums {
  unsigned long long pairs;
  Limbs terms[core::kTerms];
};

inline void toSums(const DeviceSums& from, const core::Units& units, core::Sums& to) {
  to.pairs = from.pairs;
  for (int i = 0; i < core::kTerms; ++i) {
    const Limbs& limbs = from.terms[i];
    const int bits = unitOf(units, i).fine_bits;
    const auto part = [](unsigned long long x, int shift) {
      const core::FixedSum low = core::shifted(static_cast<std::int64_t>(x), shift % 64);
      return shift < 64 ? low : core::FixedSum{0, low.lo};
    };
    to.terms[i] = part(limbs.fine, 0) + part(limbs.coarse_low, bits) + part(limbs.coarse_high, bits + 32);
  }
}

/// Candidates of one warp and query: chunk k has the items from k chunk_size on.
struct Chunk {
  unsigned query;
  unsigned count;
};

/// Arguments of the launches; pointers to the device.
struct Batch {
  const core::Setup* setups;        ///< null: there is one query, `single`
  const unsigned long long* first;  ///< jobs of all queries before each, from first_job on
  unsigned long long first_job;
  unsigned jobs;
  unsigned count;
  unsigned first_query;  ///< number of the first of these in the whole batch
  unsigned job_size;     ///< clusters
  DeviceSums* sums;
  Hit* hits;
  unsigned long long capacity;  ///< of hits
  unsigned long long* found;    ///< hits, also those beyond the capacity; null if none are wanted
  Chunk* chunks;
  uint2* candidates;  ///< places of walker and partner
  unsigned chunk_size;
  unsigned chunk_capacity;
  unsigned long long* taken;  ///< chunks, also those beyond the capacity
  core::Setup single;
  /// Only with a single query: what the last block copies to the host, and clears for the next run.
  unsigned long long* words;
  unsigned long long* host_words;
  unsigned word_count;
  unsigned* ticket;  ///< blocks that are done; one of the words

  __device__ const core::Setup& setup(unsigned query) const { return setups ? setups[query] : single; }
};

/// What a launch computes.
enum class Goal { volume, wrench };

/// A pair to decide.
struct DevicePair {
  std::uint32_t a, b;  ///< places
  bool from_a;
};

inline __device__ DevicePair pairOf(std::uint32_t walker, std::uint32_t partner) {
  const bool from_a = walker & kFromA;
  const std::uint32_t own = walker & ~kFromA;
  return {from_a ? own : partner, from_a ? partner : own, from_a};
}

inline __device__ Sphere load(const Sphere* sphere) {
  const float4 s = __ldg(reinterpret_cast<const float4*>(sphere));
  return {s.x, s.y, s.z, s.w};
}

inline __device__ core::Pair makePair(const core::Setup& setup, const DevicePair& pair) {
  return core::makePair(setup.frame, load(setup.a.grid.spheres + pair.a),
                        load(setup.b.grid.spheres + pair.b));
}

}  // namespace innersphere::device
