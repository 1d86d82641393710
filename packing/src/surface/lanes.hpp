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

}  // namespace innersphere
