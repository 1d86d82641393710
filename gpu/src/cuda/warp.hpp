// Declares what several kernels call.
#pragma once

#include "cuda/batch.hpp"

namespace innersphere::device {

/// Names some of kTaskClusters neighbouring clusters of one body of a query.
struct ClusterTask {
  unsigned query;
  unsigned side;   ///< 0: A
  unsigned first;  ///< cluster
  unsigned mask;   ///< a bit for each that is active
};
inline __device__ unsigned long long packTask(const ClusterTask& task) {
  return static_cast<unsigned long long>(task.query) << 40 |
         static_cast<unsigned long long>(task.side) << 39 |
         static_cast<unsigned long long>(task.first / kTaskClusters) << kTaskClusters | task.mask;
}

inline __device__ ClusterTask unpackTask(unsigned long long bits) {
  return {static_cast<unsigned>(bits >> 40), static_cast<unsigned>(bits >> 39 & 1),
          static_cast<unsigned>(bits >> kTaskClusters & 0x7fffffffu) * kTaskClusters,
          static_cast<unsigned>(bits & ((1u << kTaskClusters) - 1))};
}

inline __device__ Sphere load(const Sphere* sphere) {
  const float4 s = __ldg(reinterpret_cast<const float4*>(sphere));
  return {s.x, s.y, s.z, s.w};
}

/// Loads what the same launch has written.
inline __device__ Sphere loadNew(const Sphere* sphere) {
  const float4 s = *reinterpret_cast<const float4*>(sphere);
  return {s.x, s.y, s.z, s.w};
}

/// Loads a pair of entries, and stays where it stands: to save registers the compiler would have each of
/// several loads wait for the one before.
inline __device__ EntryPair load(const EntryPair* pair) {
  EntryPair p;
  asm volatile("ld.global.v4.u32 {%0, %1, %2, %3}, [%4];"
               : "=r"(p.x), "=r"(p.y), "=r"(p.z), "=r"(p.radius)
               : "l"(pair)
               : "memory");
  return p;
}

/// Stores 16 bytes at once; the compiler would do it word by word.
template <typename T>
inline __device__ void storeWords(T& to, const T& from) {
  static_assert(sizeof(T) == sizeof(uint4) && alignof(T) == sizeof(uint4));
  uint4 words;
  memcpy(&words, &from, sizeof words);
  reinterpret_cast<uint4&>(to) = words;
}
template <typename T>
inline __device__ T loadWords(const T& from) {
  static_assert(sizeof(T) == sizeof(uint4) && alignof(T) == sizeof(uint4));
  const uint4 words = reinterpret_cast<const uint4&>(from);
  T to;
  memcpy(&to, &words, sizeof words);
  return to;
}

/// Returns false if nothing in the ball, which is in the query sphere's frame, can meet the grid.
inline __device__ bool ballMeets(const core::GridView& grid, const core::Search& search, const Sphere& ball) {
  return core::ballMeets(search, grid, ball);
}

/// Returns the maximum over all lanes.
template <typename T>
inline __device__ T maximum(T x) {
  for (unsigned step = 1; step < kWarp; step *= 2) x = max(x, __shfl_xor_sync(kAll, x, step));
  return x;
}

inline __device__ int maximum(int x) {
#if __CUDA_ARCH__ >= 800
  return __reduce_max_sync(kAll, x);
#else
  return maximum<int>(x);
#endif
}

/// Returns the maximum over all lanes, by the order of their bits: of zeros, the one without a sign.
inline __device__ float maximum(float x) {
  const auto swapped = [](int bits) { return bits < 0 ? bits ^ 0x7fffffff : bits; };
  return __int_as_float(swapped(maximum(swapped(__float_as_int(x)))));
}

/// Returns the sum over this lane and all before it. A shuffle says by itself whether there is a lane so far
/// before, so no lane is compared.
inline __device__ unsigned scan(unsigned x) {
#pragma unroll
  for (unsigned step = 1; step < kWarp; step *= 2) {
    asm volatile(
        "{ .reg .pred there; .reg .u32 before;"
        "  shfl.sync.up.b32 before|there, %0, %1, 0, 0xffffffff;"
        "  @there add.u32 %0, %0, before; }"
        : "+r"(x)
        : "r"(step));
  }
  return x;
}

}  // namespace innersphere::device
