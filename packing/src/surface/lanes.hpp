// Declares what is done with numbers side by side. All results are those of one number at a time.
#pragma once

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <cstdint>
#include <cstring>

namespace innersphere {

using TwoDoubles = double __attribute__((vector_size(2 * sizeof(double))));
using FourFloats = float __attribute__((vector_size(4 * sizeof(float))));
using FourInts = std::int32_t __attribute__((vector_size(4 * sizeof(std::int32_t))));

/// Returns whether the processor can do more than four at once; see kernels.hpp.
inline bool hasAvx512() {
#ifdef __x86_64__
  return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
         __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512vl") != 0;
#else
  return false;
#endif
}

/// Returns the same. Compilers know the place of what a thread owns, and would compute it at each use: in a
/// shared library by a call.
template <typename T>
T& here(T& of_thread) {
  T* place = &of_thread;
  __asm__("" : "+r"(place));
  return *place;
}

inline FourFloats lesser(FourFloats a, FourFloats b) {
#ifdef __SSE2__
  return _mm_min_ps(a, b);  // compilers make three instructions of the other
#else
  return a < b ? a : b;
#endif
}

inline FourFloats larger(FourFloats a, FourFloats b) {
#ifdef __SSE2__
  return _mm_max_ps(a, b);
#else
  return a > b ? a : b;
#endif
}

inline TwoDoubles twoAt(const double* x) {
  TwoDoubles two;
  std::memcpy(&two, x, sizeof two);
  return two;
}

inline FourInts fourAt(const std::uint32_t* x) {
  FourInts four;
  std::memcpy(&four, x, sizeof four);
  return four;
}

inline TwoDoubles exchanged(TwoDoubles x) {
  return TwoDoubles{x[1], x[0]};
}

/// Returns a bit for each number that is larger than the bound.
inline unsigned bitsAbove(TwoDoubles x, double bound) {
#ifdef __SSE2__
  return static_cast<unsigned>(_mm_movemask_pd(_mm_cmpgt_pd(x, _mm_set1_pd(bound))));
#else
  return unsigned{x[0] > bound} | unsigned{x[1] > bound} << 1;
#endif
}

/// Returns a bit for each negative number.
inline unsigned signBits(FourInts x) {
#ifdef __SSE2__
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(x)));
#else
  unsigned bits = 0;
  for (int i = 0; i < 4; ++i) bits |= unsigned{x[i] < 0} << i;
  return bits;
#endif
}

/// Returns the same for sixteen numbers.
inline unsigned signBits(const FourInts (&x)[4]) {
#ifdef __SSE2__
  const auto at = [&](int i) { return reinterpret_cast<__m128i>(x[i]); };
  const __m128i low = _mm_packs_epi32(at(0), at(1)), high = _mm_packs_epi32(at(2), at(3));
  return static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(low, high)));
#else
  return signBits(x[0]) | signBits(x[1]) << 4 | signBits(x[2]) << 8 | signBits(x[3]) << 12;
#endif
}

/// Returns four times one of the numbers.
template <int I>
FourInts spread(FourInts x) {
#ifdef __SSE2__
  return reinterpret_cast<FourInts>(_mm_shuffle_epi32(reinterpret_cast<__m128i>(x), 0x55 * I));
#else
  return FourInts{} + x[I];
#endif
}

}  // namespace innersphere
