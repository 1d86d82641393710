// Decides candidates, a lane for each, and sums the terms of those that overlap.
#pragma once

#include "cuda/find_candidates.hpp"

namespace innersphere::device {

constexpr int kPass = 4;                                ///< terms that the lanes exchange at once
constexpr unsigned kColumnLanes = kWarp / (2 * kPass);  ///< lanes that sum one column

/// Holds coarse and fine parts of some terms, a row for each lane. Lanes that sum columns use different
/// banks.
struct Columns {
  static constexpr unsigned kTwos = kWarp / kColumnLanes / 2;  ///< pairs of rows that a lane sums
  static constexpr unsigned kGap = 2 * kColumnLanes;
  alignas(16) double of[2 * kPass][kWarp + kGap];

  /// Returns the sum of the bits in the rows of one lane; see core::Parts.
  __device__ unsigned long long sum(unsigned lane) const {
    const auto* rows = reinterpret_cast<const ulonglong2*>(of[lane / kColumnLanes]) + lane % kColumnLanes;
    unsigned long long sum = 0;
#pragma unroll
    for (unsigned k = 0; k < kTwos; ++k) sum += rows[k * kColumnLanes].x + rows[k * kColumnLanes].y;
    return sum;
  }
};

/// Holds the sums of a warp: those of each lane, for every pass, with the bits of the units in them.
struct Sums {
  static constexpr int kPasses = (core::kTerms + kPass - 1) / kPass;
  unsigned long long of[kPasses][kWarp];
  unsigned pairs, additions;
};

constexpr unsigned kMostWarps = 8;  ///< in a block

template <Goal goal>
constexpr int kTermCount = goal == Goal::wrench   ? core::kTerms
                           : goal == Goal::volume ? core::kVolumeTerms
                                                  : 0;

/// Adds what a warp summed of one column, in quanta or, coarse, in units of 2^bits quanta. Both parts come
/// together, so that the fine one's carry is known.
inline __device__ void addTerm(Limbs& limbs, int bits, bool coarse, unsigned long long sum,
                               unsigned long long other) {
  if (!coarse) {
    atomicAdd(&limbs.fine, sum & ((1ull << bits) - 1));
    return;
  }
  const long long whole = static_cast<long long>(sum) + (static_cast<long long>(other) >> bits);
  atomicAdd(&limbs.coarse_low, static_cast<unsigned long long>(whole) & 0xffffffffu);
  atomicAdd(&limbs.coarse_high, static_cast<unsigned long long>(whole >> 32));
}

/// Sums for a warp over one query. The lanes exchange the terms of their pairs, and each keeps its part of
/// one column of every pass: that takes far fewer registers than sums of all terms in every lane.
template <Goal goal>
class Summer {
 public:
  __device__ Summer(unsigned lane, Sums& sums) { clear(lane, sums); }

  /// Adds a candidate of each lane; all lanes call it. Returns true if anything overlaps.
  __device__ bool add(const Batch& batch, const Scene& scene, unsigned query, const Candidate& candidate,
                      bool valid, unsigned lane, Columns& columns, Sums& sums) {
    const bool from_a = candidate.x & kFromA;
    const std::uint32_t own = candidate.x & kPlace;
    const core::GridView& grid = scene.grids[from_a ? 1 : 0].view;
    const bool listed = candidate.y < grid.listed_count;  // see Grid::entries
    const std::uint32_t partner = listed ? __ldg(grid.listed + candidate.y) : candidate.y - grid.listed_count;
    const std::uint32_t place_a = from_a ? own : partner, place_b = from_a ? partner : own;
    core::Pair pair = core::makePair(scene.query.frame, load(scene.grids[0].view.spheres + place_a),
                                     load(scene.grids[1].view.spheres + place_b));
    const bool found = valid && core::isReported(pair, from_a);
    const unsigned found_pairs = __ballot_sync(kAll, found);
    pairs_ += __popc(found_pairs);
    if constexpr (goal != Goal::touch) {
      if (found_pairs == 0) return false;
      if (batch.found_pairs) write(batch, scene, query, place_a, place_b, found_pairs, lane);
      const double sum = pair.ra + pair.rb;
      if (!found) pair.distance2 = sum * sum;  // two balls that touch from outside add nothing
      exchange(pair, scene.query.units, lane, columns, sums);
      ++additions_;
    }
    return found_pairs != 0;
  }

  /// Returns true if the next pairs could overflow the sums, also those of some such warps.
  __device__ bool full() const { return additions_ + 1 > (1u << core::kShortSumBits) / (kWarp * kMostWarps); }

  /// Moves the sums to those of the query.
  __device__ void flush(DeviceSums& total, const core::Units& units, unsigned lane, Sums& sums) {
    if (pairs_ == 0) return;
    if (lane == 0) atomicAdd(&total.pairs, static_cast<unsigned long long>(pairs_));
#pragma unroll
    for (int pass = 0; pass < kPasses; ++pass)
      addPass(total, units, pass, sums.of[pass][lane], additions_, lane);
    clear(lane, sums);
  }

  /// Moves the sums of all warps of a block to those of the query. The first warps take a pass each. All
  /// threads call it.
  template <typename SumsOf>
  __device__ void flushBlock(DeviceSums& total, const core::Units& units, unsigned warps, unsigned lane,
                             const SumsOf& sumsOf) {
    const unsigned warp = threadIdx.x / kWarp;
    if (lane == 0) {
      sumsOf(warp).pairs = pairs_;
      sumsOf(warp).additions = additions_;
    }
    __syncthreads();
    unsigned pairs = 0, additions = 0;
    for (unsigned w = 0; w < warps; ++w) {
      pairs += sumsOf(w).pairs;
      additions += sumsOf(w).additions;
    }
    if (pairs == 0) return;
    if (threadIdx.x == 0) atomicAdd(&total.pairs, static_cast<unsigned long long>(pairs));
    for (int pass = static_cast<int>(warp); pass < kPasses; pass += static_cast<int>(warps)) {
      unsigned long long sum = 0;
      for (unsigned w = 0; w < warps; ++w) sum += sumsOf(w).of[pass][lane];
      addPass(total, units, pass, sum, additions, lane);
    }
  }

 private:
  static constexpr int kTerms = kTermCount<goal>;
  static constexpr int kPasses = (kTerms + kPass - 1) / kPass;

  __device__ void clear(unsigned lane, Sums& sums) {
    for (int pass = 0; pass < kPasses; ++pass) sums.of[pass][lane] = 0;
    pairs_ = additions_ = 0;
  }

  /// Adds all lanes' sums of one pass.
  static __device__ void addPass(DeviceSums& total, const core::Units& units, int pass,
                                 unsigned long long sum, unsigned additions, unsigned lane) {
    for (unsigned step = 1; step < kColumnLanes; step *= 2) sum += __shfl_xor_sync(kAll, sum, step);
    const unsigned column = lane / kColumnLanes;
    const int term = min(pass * kPass + static_cast<int>(column / 2), kTerms - 1);
    const core::Unit& unit = unitOf(units, term);
    sum -= std::uint64_t{additions} * kWarp * core::bitsOf(column % 2 == 0 ? unit.coarse : unit.fine);
    const unsigned long long other = __shfl_xor_sync(kAll, sum, kColumnLanes);
    if (lane % kColumnLanes == 0 && pass * kPass + static_cast<int>(column / 2) < kTerms)
      addTerm(total.terms[term], unit.fine_bits, column % 2 == 0, sum, other);
  }

  __device__ void exchange(const core::Pair& pair, const core::Units& units, unsigned lane, Columns& columns,
                           Sums& sums) {
    core::Contact contact = core::makeContact(pair);
    core::Terms terms;
    core::setTerms<goal == Goal::wrench>(pair, contact, terms);
#pragma unroll
    for (int pass = 0; pass < kPasses; ++pass) {
      if (goal == Goal::wrench && pass == kPasses - 1) {
        asm volatile("" : "+d"(contact.balls.s));  // not computed sooner: there are too few registers
        terms.terms[core::kEnergy] = core::lensEnergy(contact.balls);
      }
#pragma unroll
      for (int i = 0; i < kPass && pass * kPass + i < kTerms; ++i) {
        const int term = pass * kPass + i;
        const core::Parts parts = core::split(terms.terms[term], unitOf(units, term));
        columns.of[2 * i][lane] = parts.coarse;
        columns.of[2 * i + 1][lane] = parts.fine;
      }
      __syncwarp();
      sums.of[pass][lane] += columns.sum(lane);
      __syncwarp();
    }
  }

  __device__ void write(const Batch& batch, const Scene& scene, unsigned query, std::uint32_t place_a,
                        std::uint32_t place_b, unsigned found_pairs, unsigned lane) {
    unsigned long long at = 0;
    if (lane == 0)
      at = atomicAdd(&batch.counters->found, static_cast<unsigned long long>(__popc(found_pairs)));
    at = __shfl_sync(kAll, at, 0) + __popc(found_pairs & ((1u << lane) - 1));
    if ((found_pairs >> lane & 1) == 0 || at >= batch.capacity) return;
    const unsigned long long a = scene.grids[0].view.ids[place_a], b = scene.grids[1].view.ids[place_b];
    batch.found_pairs[at] = (static_cast<unsigned long long>(query) << batch.bits_a | a) << batch.bits_b | b;
  }

  unsigned pairs_, additions_;
};

/// Returns one term of a query's sums, in floating point.
inline __device__ double totalOf(const DeviceSums& sums, const core::Units& units, int term) {
  const Limbs& limbs = sums.terms[term];
  const core::Unit& unit = unitOf(units, term);
  const auto part = [](unsigned long long x, int shift) {
    const core::FixedSum low = core::shifted(static_cast<std::int64_t>(x), shift % 64);
    return shift < 64 ? low : core::FixedSum{0, low.lo};
  };
  const int bits = unit.fine_bits;
  return core::toDouble(
      part(limbs.fine, 0) + part(limbs.coarse_low, bits) + part(limbs.coarse_high, bits + 32), unit);
}

/// Returns what a query gives back: word `word` of core::Totals.
template <Goal goal>
inline __device__ unsigned long long resultOf(const DeviceSums& sums, const core::Units& units,
                                              unsigned word) {
  if (word >= core::kTerms) {
    return goal == Goal::touch ? sums.pairs != 0 : sums.pairs;
  }
  const int term = static_cast<int>(word);
  return static_cast<unsigned long long>(
      __double_as_longlong(term < kTermCount<goal> ? totalOf(sums, units, term) : 0));
}

}  // namespace innersphere::device
