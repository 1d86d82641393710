// Decides candidates, a lane for each, and sums the terms of those that overlap.
#pragma once

#include "cuda_batch.hpp"

namespace innersphere::device {

constexpr unsigned kSumWarps = 4;  ///< in a block
constexpr unsigned kLargestChunk = 128;
static_assert(kLargestChunk <= 1u << core::kShortSumBits, "a chunk is summed in 64 bits");

template <Goal goal>
constexpr int kTermCount = goal == Goal::wrench ? core::kTerms : core::kVolumeTerms;

constexpr int kPass = 4;                          ///< terms that the lanes exchange at once
constexpr unsigned kShare = kWarp / (2 * kPass);  ///< lanes that sum one column

/// Coarse and fine parts of some terms, a row for each lane; kShare more, so that lanes read different banks.
using Columns = unsigned long long[2 * kPass][kWarp + kShare];

/// Adds the sums of all lanes to those of the query.
template <int kTerms>
inline __device__ void addWarp(DeviceSums& total, const core::Units& units,
                               const core::ShortSum (&sums)[kTerms], unsigned pairs, unsigned lane,
                               Columns& columns) {
  for (unsigned step = kWarp / 2; step > 0; step /= 2) pairs += __shfl_xor_sync(kAll, pairs, step);
  if (pairs == 0) return;
  if (lane == 0) atomicAdd(&total.pairs, static_cast<unsigned long long>(pairs));
#pragma unroll
  for (int pass = 0; pass < (kTerms + kPass - 1) / kPass; ++pass) {
#pragma unroll
    for (int i = 0; i < kPass && pass * kPass + i < kTerms; ++i) {
      columns[2 * i][lane] = sums[pass * kPass + i].coarse;
      columns[2 * i + 1][lane] = sums[pass * kPass + i].fine;
    }
    __syncwarp();
    const unsigned column = lane / kShare;
    const int term = pass * kPass + static_cast<int>(column / 2);
    unsigned long long sum = 0;
    if (term < kTerms) {
#pragma unroll
      for (unsigned row = 0; row < kWarp; row += kShare) sum += columns[column][row + lane % kShare];
    }
    __syncwarp();
    for (unsigned step = 1; step < kShare; step *= 2) sum += __shfl_xor_sync(kAll, sum, step);
    const unsigned long long partner = __shfl_xor_sync(kAll, sum, kShare);
    if (lane % kShare != 0 || term >= kTerms) continue;
    Limbs& limbs = total.terms[term];
    const int bits = unitOf(units, term).fine_bits;
    if (column % 2 == 1) {
      atomicAdd(&limbs.fine, sum & ((1ull << bits) - 1));
      continue;
    }
    const long long coarse = static_cast<long long>(sum) + (static_cast<long long>(partner) >> bits);
    atomicAdd(&limbs.coarse_low, static_cast<unsigned long long>(coarse) & 0xffffffffu);
    atomicAdd(&limbs.coarse_high, static_cast<unsigned long long>(coarse >> 32));
  }
}

/// Of a single query: adds the sums of the block, and the last block brings all of them home. That takes less
/// time than a copy of its own.
inline __device__ void finish(const Batch& batch, const DeviceSums& of_block) {
  __shared__ bool last;
  __syncthreads();
  const auto* from = reinterpret_cast<const unsigned long long*>(&of_block);
  auto* to = reinterpret_cast<unsigned long long*>(batch.sums);
  for (unsigned i = threadIdx.x; i < sizeof(DeviceSums) / sizeof(*from); i += blockDim.x) {
    if (from[i] != 0) atomicAdd(to + i, from[i]);
  }
  __threadfence();
  __syncthreads();
  if (threadIdx.x == 0) last = atomicAdd(batch.ticket, 1u) == gridDim.x - 1;
  __syncthreads();
  if (!last) return;
  __threadfence();
  for (unsigned i = threadIdx.x; i < batch.word_count; i += blockDim.x) {
    batch.host_words[i] = *static_cast<volatile unsigned long long*>(batch.words + i);
    batch.words[i] = 0;
  }
  __threadfence_system();
}

/// Each warp takes every so many chunks, and keeps its sums while they are of one query.
template <Goal goal>
__global__ void __launch_bounds__(kSumWarps* kWarp, 3) sumCandidates(const __grid_constant__ Batch batch) {
  constexpr int kTerms = kTermCount<goal>;
  constexpr unsigned kChunkRounds = kLargestChunk / kWarp + 1;
  constexpr unsigned kMostRounds = (1u << core::kShortSumBits) / kWarp - kChunkRounds;
  __shared__ Columns columns[kSumWarps];
  __shared__ DeviceSums of_block;  // fewer blocks than warps add to the sums of a single query
  const unsigned lane = threadIdx.x % kWarp, warp = threadIdx.x / kWarp;
  if (batch.ticket) {
    for (unsigned i = threadIdx.x; i < sizeof(DeviceSums) / sizeof(unsigned long long); i += blockDim.x)
      reinterpret_cast<unsigned long long*>(&of_block)[i] = 0;
    __syncthreads();
  }
  const unsigned chunks =
      static_cast<unsigned>(min(*batch.taken, static_cast<unsigned long long>(batch.chunk_capacity)));
  core::ShortSum sums[kTerms] = {};
  unsigned pairs = 0, rounds = 0;
  for (unsigned c = blockIdx.x * kSumWarps + warp; c < chunks;) {
    const Chunk chunk = batch.chunks[c];
    const core::Setup& setup = batch.setup(chunk.query);
    const uint2* candidates = batch.candidates + static_cast<std::size_t>(c) * batch.chunk_size;
    for (unsigned k = lane; k < chunk.count; k += kWarp) {
      const uint2 candidate = candidates[k];
      const DevicePair places = pairOf(candidate.x, candidate.y);
      const core::Pair pair = makePair(setup, places);
      if (!core::isHit(pair, places.from_a)) continue;
      ++pairs;
      const core::Terms terms = core::makeTerms<goal == Goal::wrench>(pair);
#pragma unroll
      for (int i = 0; i < kTerms; ++i) core::add(sums[i], terms.terms[i], unitOf(setup.units, i));
      if (goal == Goal::wrench && batch.found) {
        const unsigned long long at = atomicAdd(batch.found, 1ull);
        if (at < batch.capacity)
          batch.hits[at] = {batch.first_query + chunk.query, setup.a.grid.ids[places.a],
                            setup.b.grid.ids[places.b]};
      }
    }
    rounds += chunk.count / kWarp + 1;
    c += gridDim.x * kSumWarps;
    if (c < chunks && batch.chunks[c].query == chunk.query && rounds <= kMostRounds) continue;
    __syncwarp();
    addWarp<kTerms>(batch.ticket ? of_block : batch.sums[chunk.query], setup.units, sums, pairs, lane,
                    columns[warp]);
#pragma unroll
    for (int i = 0; i < kTerms; ++i) sums[i] = {0, 0};
    pairs = rounds = 0;
  }
  if (batch.ticket) finish(batch, of_block);
}

}  // namespace innersphere::device
