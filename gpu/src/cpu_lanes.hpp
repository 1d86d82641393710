// What compilers do not make of loops by themselves: spheres from any places as columns, and a list of those
// that a walker meets. A version for each generation of x86-64 processors and one for all others; the same
// bits.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/walk.hpp"
#include "cpu_kernels.hpp"

#if defined(__x86_64__) && defined(__GNUC__)
#define INNERSPHERE_X86
#include <immintrin.h>
#endif

namespace innersphere {

constexpr std::size_t kLanes = 16;  ///< spheres that are worked on together

/// kLanes spheres: where their coordinates are.
struct Columns {
  float *x, *y, *z, *radius;
};

/// Any processor.
struct LanesAny {
  /// Loads kLanes spheres; those from number `count` on meet nothing.
  static void load(const Sphere* spheres, const std::uint32_t* places, std::uint32_t count,
                   const Columns& to) {
    for (std::uint32_t k = 0; k < kLanes; ++k) {
      const Sphere& s = spheres[places[k]];
      to.x[k] = s.x;
      to.y[k] = s.y;
      to.z[k] = s.z;
      to.radius[k] = k < count ? s.radius : -std::numeric_limits<float>::infinity();
    }
  }

  /// A bit for each sphere that the walker meets.
  static std::uint32_t meeting(const core::Lookup& lookup, const Columns& spheres) {
    std::uint32_t bits[kLanes];
    for (std::uint32_t k = 0; k < kLanes; ++k) {
      const float dx = spheres.x[k] - lookup.p.x, dy = spheres.y[k] - lookup.p.y,
                  dz = spheres.z[k] - lookup.p.z;
      const float sum = lookup.reach + spheres.radius[k];
      const std::uint32_t large = spheres.radius[k] < lookup.smallest ? 0 : 1u << k;
      bits[k] = dx * dx + dy * dy + dz * dz > sum * sum ? 0 : large;
    }
    std::uint32_t met = 0;
    for (std::uint32_t bit : bits) met |= bit;
    return met;
  }

  /// Writes the pairs of a walker with the places of these bits, from number c on, and returns how many there
  /// are then. There must be room for kLanes.
  static std::size_t append(std::uint32_t walker, const std::uint32_t* places, std::uint32_t bits,
                            Candidates& to, std::size_t c) {
    for (; bits != 0; bits &= bits - 1, ++c) {
      to.walker[c] = walker;
      to.partner[c] = places[std::countr_zero(bits)];
    }
    return c;
  }
};

#ifdef INNERSPHERE_X86

#define INNERSPHERE_AVX2 __attribute__((target("avx2")))
#define INNERSPHERE_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl")))

struct LanesAvx2 : LanesAny {
  INNERSPHERE_AVX2 static void load(const Sphere* spheres, const std::uint32_t* places, std::uint32_t count,
                                    const Columns& to) {
    for (std::size_t k = 0; k < kLanes; k += 8) {
      const auto rows = [&](std::size_t i) INNERSPHERE_AVX2 {
        const __m128 low = _mm_loadu_ps(&spheres[places[k + i]].x);
        return _mm256_insertf128_ps(_mm256_castps128_ps256(low), _mm_loadu_ps(&spheres[places[k + i + 4]].x),
                                    1);
      };
      const __m256 r0 = rows(0), r1 = rows(1), r2 = rows(2), r3 = rows(3);
      const __m256 xy01 = _mm256_unpacklo_ps(r0, r1), zr01 = _mm256_unpackhi_ps(r0, r1);
      const __m256 xy23 = _mm256_unpacklo_ps(r2, r3), zr23 = _mm256_unpackhi_ps(r2, r3);
      _mm256_storeu_ps(to.x + k, _mm256_shuffle_ps(xy01, xy23, 0x44));
      _mm256_storeu_ps(to.y + k, _mm256_shuffle_ps(xy01, xy23, 0xee));
      _mm256_storeu_ps(to.z + k, _mm256_shuffle_ps(zr01, zr23, 0x44));
      const __m256i left =
          _mm256_set1_epi32(static_cast<int>(count < kLanes ? count : kLanes) - static_cast<int>(k));
      const __m256i there = _mm256_cmpgt_epi32(left, _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
      const __m256 none = _mm256_set1_ps(-std::numeric_limits<float>::infinity());
      _mm256_storeu_ps(to.radius + k, _mm256_blendv_ps(none, _mm256_shuffle_ps(zr01, zr23, 0xee),
                                                       _mm256_castsi256_ps(there)));
    }
  }

  INNERSPHERE_AVX2 static std::uint32_t meeting(const core::Lookup& lookup, const Columns& spheres) {
    std::uint32_t met = 0;
    for (std::size_t k = 0; k < kLanes; k += 8) {
      const __m256 r = _mm256_loadu_ps(spheres.radius + k);
      const __m256 dx = _mm256_loadu_ps(spheres.x + k) - _mm256_set1_ps(lookup.p.x);
      const __m256 dy = _mm256_loadu_ps(spheres.y + k) - _mm256_set1_ps(lookup.p.y);
      const __m256 dz = _mm256_loadu_ps(spheres.z + k) - _mm256_set1_ps(lookup.p.z);
      const __m256 sum = _mm256_set1_ps(lookup.reach) + r;
      const __m256 near = _mm256_cmp_ps(dx * dx + dy * dy + dz * dz, sum * sum, _CMP_NGT_UQ);
      const __m256 large = _mm256_cmp_ps(r, _mm256_set1_ps(lookup.smallest), _CMP_NLT_UQ);
      met |= static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_and_ps(near, large))) << k;
    }
    return met;
  }
};

struct LanesAvx512 {
  INNERSPHERE_AVX512 static void load(const Sphere* spheres, const std::uint32_t* places, std::uint32_t count,
                                      const Columns& to) {
    constexpr __mmask16 kEvery = 0xffff;  // forms with a mask, because GCC 12 warns of the others
    const auto rows = [&](std::size_t i) INNERSPHERE_AVX512 {
      __m512 v = _mm512_castps128_ps512(_mm_loadu_ps(&spheres[places[i]].x));
      v = _mm512_insertf32x4(v, _mm_loadu_ps(&spheres[places[i + 1]].x), 1);
      v = _mm512_insertf32x4(v, _mm_loadu_ps(&spheres[places[i + 2]].x), 2);
      v = _mm512_insertf32x4(v, _mm_loadu_ps(&spheres[places[i + 3]].x), 3);
      const __m512i by_column = _mm512_setr_epi32(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15);
      return _mm512_maskz_permutexvar_ps(kEvery, by_column, v);
    };
    const __m512 r0 = rows(0), r1 = rows(4), r2 = rows(8), r3 = rows(12);
    const __m512 xy01 = _mm512_maskz_shuffle_f32x4(kEvery, r0, r1, 0x44);
    const __m512 zr01 = _mm512_maskz_shuffle_f32x4(kEvery, r0, r1, 0xee);
    const __m512 xy23 = _mm512_maskz_shuffle_f32x4(kEvery, r2, r3, 0x44);
    const __m512 zr23 = _mm512_maskz_shuffle_f32x4(kEvery, r2, r3, 0xee);
    _mm512_storeu_ps(to.x, _mm512_maskz_shuffle_f32x4(kEvery, xy01, xy23, 0x88));
    _mm512_storeu_ps(to.y, _mm512_maskz_shuffle_f32x4(kEvery, xy01, xy23, 0xdd));
    _mm512_storeu_ps(to.z, _mm512_maskz_shuffle_f32x4(kEvery, zr01, zr23, 0x88));
    const __m512 none = _mm512_set1_ps(-std::numeric_limits<float>::infinity());
    const auto there = static_cast<__mmask16>(count >= kLanes ? kEvery : (1u << count) - 1);
    _mm512_storeu_ps(to.radius, _mm512_mask_shuffle_f32x4(none, there, zr01, zr23, 0xdd));
  }

  INNERSPHERE_AVX512 static std::uint32_t meeting(const core::Lookup& lookup, const Columns& spheres) {
    const __m512 r = _mm512_loadu_ps(spheres.radius);
    const __m512 dx = _mm512_loadu_ps(spheres.x) - _mm512_set1_ps(lookup.p.x);
    const __m512 dy = _mm512_loadu_ps(spheres.y) - _mm512_set1_ps(lookup.p.y);
    const __m512 dz = _mm512_loadu_ps(spheres.z) - _mm512_set1_ps(lookup.p.z);
    const __m512 sum = _mm512_set1_ps(lookup.reach) + r;
    const __mmask16 near = _mm512_cmp_ps_mask(dx * dx + dy * dy + dz * dz, sum * sum, _CMP_NGT_UQ);
    return _mm512_mask_cmp_ps_mask(near, r, _mm512_set1_ps(lookup.smallest), _CMP_NLT_UQ);
  }

  INNERSPHERE_AVX512 static std::size_t append(std::uint32_t walker, const std::uint32_t* places,
                                               std::uint32_t bits, Candidates& to, std::size_t c) {
    const __m512i met = _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), _mm512_loadu_si512(places));
    const __m512i self = _mm512_set1_epi32(static_cast<int>(walker));
    std::uint32_t *walkers = to.walker.data() + c, *partners = to.partner.data() + c;
    const int count = std::popcount(bits);
    // Mostly few: short stores seldom cross a line of the cache.
    std::memcpy(walkers, &self, 16);
    std::memcpy(partners, &met, 16);
    if (count > 4) {
      std::memcpy(walkers, &self, 64);
      std::memcpy(partners, &met, 64);
    }
    return c + static_cast<std::size_t>(count);
  }
};

#endif

}  // namespace innersphere
