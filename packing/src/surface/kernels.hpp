// Defines what is done with numbers side by side: for all processors, and for those with AVX-512. All results
// are the same, bit for bit: nothing is fused, nothing is approximated.
#pragma once

#if defined(__x86_64__)
#define INNERSPHERE_AVX512_SURFACE __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl"), flatten))
#include <immintrin.h>
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "surface/grid_surface.hpp"
#include "surface/lanes.hpp"
#include "surface/sides.hpp"
#include "surface/surface_tree.hpp"

namespace innersphere {

/// Returns the numbers with their halves exchanged.
inline FourInts exchangedHalves(FourInts x) {
  return (x << 16) | ((x >> 16) & 0xffff);
}

/// The whole number nearest to x is (x + kWhole) - kWhole. Numbers are less than 2^51.
constexpr double kWhole = 0x1.8p52;

struct AnyKernels {
  /// Returns which boxes of both meet: bit 4 i + j for box i of x and box j of y.
  static std::uint32_t meeting(const LaneBoxes& x, const LaneBoxes& y) {
    using Halves = LaneBoxes::Halves;
    Halves gaps[4]{};
    const auto add = [](FourInts same, FourInts sides, Halves& gap) {
      gap |= reinterpret_cast<Halves>(same) + reinterpret_cast<Halves>(sides);
    };
    for (int k = 0; k < 6; ++k) {
      add(spread<0>(x.sides[k]), y.sides[k], gaps[0]);
      add(spread<1>(x.sides[k]), y.sides[k], gaps[1]);
      add(spread<2>(x.sides[k]), y.sides[k], gaps[2]);
      add(spread<3>(x.sides[k]), y.sides[k], gaps[3]);
    }
    FourInts either[4];
    for (int i = 0; i < 4; ++i) {
      const auto gap = reinterpret_cast<FourInts>(gaps[i]);
      either[i] = gap | (gap << 16);
    }
    return ~signBits(either) & 0xffff;
  }

  /// Writes those of 16 pairs that such bits name, and anything behind them. Returns how many there are.
  static std::size_t append(std::uint32_t bits, FourInts a, FourInts b, std::uint32_t* to_a,
                            std::uint32_t* to_b) {
    std::size_t count = 0;
    for (; bits != 0; bits &= bits - 1, ++count) {
      const int k = std::countr_zero(bits);
      to_a[count] = static_cast<std::uint32_t>(a[k / 4]);
      to_b[count] = static_cast<std::uint32_t>(b[k % 4]);
    }
    return count;
  }

  /// Finds the boxes around a node's children in both coarse grids; `is_first`: its own one comes first.
  static void place(const SurfaceTree::Node& node, const ToCoarseGrid& to, bool is_first, LaneBoxes& boxes) {
    for (int k = 0; k < 3; ++k) {
      const auto turned = [&](const FourFloats(&m)[3][4], const FourFloats* x) {
        return m[0][k] * x[0] + m[1][k] * x[1] + m[2][k] * x[2];
      };
      const FourFloats first = turned(to.matrix, node.extent) + to.translation[k];
      FourFloats low = first, high = first;
      if (node.are_triangles) {
        for (int c = 1; c < node.corners; ++c) {
          const FourFloats at = turned(to.matrix, node.extent + 3 * c) + to.translation[k];
          low = lesser(low, at);
          high = larger(high, at);
        }
      } else {
        const FourFloats half = turned(to.absolute, node.extent + 3);
        low = first - half;
        high = first + half;
      }
      const FourInts there = SurfaceTree::CoarseGrid::sides(high + to.slack, to.slack - low);
      boxes.sides[k] = is_first ? node.sides[k] : exchangedHalves(there);
      boxes.sides[3 + k] = is_first ? there : exchangedHalves(node.sides[k]);
    }
  }

  /// Finds the places of a triangle's corners on the grid.
  static void place(const FourFloats& a, const FourFloats& b, const FourFloats& c, const Similarity& to,
                    CornerPlaces& corners) {
    for (const int k : {0, 1}) {
      const FourFloats p = k == 0 ? a : c, q = k == 0 ? b : a;
      const FourFloats xy = __builtin_shufflevector(p, q, 0, 4, 1, 5);
      const TwoDoubles x = __builtin_convertvector(__builtin_shufflevector(xy, xy, 0, 1), TwoDoubles),
                       y = __builtin_convertvector(__builtin_shufflevector(xy, xy, 2, 3), TwoDoubles),
                       z = __builtin_convertvector(__builtin_shufflevector(p, q, 2, 6), TwoDoubles);
      for (int axis = 0; axis < 3; ++axis) {
        const double* m = to.matrix.m + 3 * axis;
        const TwoDoubles at = m[0] * x + m[1] * y + m[2] * z + to.translation[axis];
        const TwoDoubles whole = (at + kWhole) - kWhole;
        std::memcpy(corners.places[axis] + 2 * k, &whole, sizeof whole);
      }
    }
  }

  /// Returns which corners of a triangle are above a plane, and shifted by 4 which are below it, where
  /// rounding does not hide it; in the last bit of both the first one again.
  static unsigned sides(const GridTriangle& plane, const GridTriangle& triangle) {
    const double rounding = plane.heightRounding();
    unsigned bits = 0;
    for (const int k : {0, 2}) {
      const auto& at = triangle.places;
      const TwoDoubles height = plane.height(twoAt(at[0] + k), twoAt(at[1] + k), twoAt(at[2] + k));
      bits |= bitsAbove(height, rounding) << k | bitsAbove(-height, rounding) << (4 + k);
    }
    return bits;
  }

  /// Returns which of four volumes are above zero, and shifted by 4 which are below: of the way from a place
  /// to `to`, to the two places u, and to those t: t0 u0, t1 u1, t1 u0, t0 u1. `t` and `u` point to three
  /// rows of places.
  static unsigned volumes(const Vec3d& from, const Vec3d& to, const double* t, const double* u,
                          double rounding) {
    constexpr int kRow = GridTriangle::kRow;
    const auto seen = [&](const double* x, int axis) { return twoAt(x + kRow * axis) - from[axis]; };
    const TwoDoubles ux = seen(u, 0), uy = seen(u, 1), uz = seen(u, 2);
    const TwoDoubles area_x = to.y * uz - to.z * uy, area_y = to.z * ux - to.x * uz,
                     area_z = to.x * uy - to.y * ux;
    TwoDoubles tx = seen(t, 0), ty = seen(t, 1), tz = seen(t, 2);
    unsigned bits = 0;
    for (const int first : {0, 2}) {
      const TwoDoubles volume = tx * area_x + ty * area_y + tz * area_z;
      bits |= bitsAbove(volume, rounding) << first | bitsAbove(-volume, rounding) << (4 + first);
      tx = exchanged(tx), ty = exchanged(ty), tz = exchanged(tz);
    }
    return bits;
  }
};

#ifdef INNERSPHERE_AVX512_SURFACE
#define INNERSPHERE_KERNEL INNERSPHERE_AVX512_SURFACE static
/// The same in fewer instructions, and lists without branches, which no processor foresees here.
struct Avx512Kernels {
  INNERSPHERE_KERNEL std::uint32_t meeting(const LaneBoxes& x, const LaneBoxes& y) {
    __m512i gaps = _mm512_setzero_si512();
    for (int k = 0; k < 6; ++k)
      gaps = _mm512_or_si512(gaps, _mm512_add_epi16(eachFourTimes(&x.sides[k]), fourTimes(&y.sides[k])));
    gaps = _mm512_or_si512(gaps, _mm512_maskz_slli_epi32(kAll, gaps, 16));
    return static_cast<std::uint16_t>(~_mm512_movepi32_mask(gaps));
  }

  INNERSPHERE_KERNEL std::size_t append(std::uint32_t bits, FourInts a, FourInts b, std::uint32_t* to_a,
                                        std::uint32_t* to_b) {
    const auto mask = static_cast<__mmask16>(bits);
    _mm512_storeu_si512(to_a, _mm512_maskz_compress_epi32(mask, eachFourTimes(&a)));
    _mm512_storeu_si512(to_b, _mm512_maskz_compress_epi32(mask, fourTimes(&b)));
    return static_cast<std::size_t>(std::popcount(bits));
  }

  INNERSPHERE_KERNEL void place(const SurfaceTree::Node& node, const ToCoarseGrid& to, bool is_first,
                                LaneBoxes& boxes) {
    // Along all axes at once.
    const __m512 translation = _mm512_loadu_ps(to.translation);
    __m512 low = turned(to.matrix, node.extent) + translation, high = low;
    if (node.are_triangles) {
      for (int c = 1; c < node.corners; ++c) {
        const __m512 at = turned(to.matrix, node.extent + 3 * c) + translation;
        low = _mm512_maskz_min_ps(kAll, low, at);
        high = _mm512_maskz_max_ps(kAll, high, at);
      }
    } else {
      const __m512 half = turned(to.absolute, node.extent + 3);
      low = low - half;
      high = high + half;
    }
    const __m512 slack = _mm512_set1_ps(to.slack);
    const __m512i minus_low = _mm512_and_si512(cells(slack - low), _mm512_set1_epi32(0xffff));
    const __m512i both = _mm512_or_si512(_mm512_maskz_slli_epi32(kAll, cells(high + slack), 16), minus_low);
    const __m512i own = _mm512_maskz_loadu_epi32(0xfff, node.sides);
    const __m512i turn = _mm512_set1_epi32(is_first ? 0 : 16);
    store(_mm512_maskz_rolv_epi32(kAll, own, turn), boxes.sides + (is_first ? 0 : 3));
    store(_mm512_maskz_rolv_epi32(kAll, both, turn), boxes.sides + (is_first ? 3 : 0));
  }

  INNERSPHERE_KERNEL void place(const FourFloats& a, const FourFloats& b, const FourFloats& c,
                                const Similarity& to, CornerPlaces& corners) {
    const __m128 xy = _mm_unpacklo_ps(a, b), xy_last = _mm_unpacklo_ps(c, a);
    const __m256d x = _mm256_cvtps_pd(_mm_movelh_ps(xy, xy_last)),
                  y = _mm256_cvtps_pd(_mm_movehl_ps(xy_last, xy)),
                  z = _mm256_cvtps_pd(_mm_movelh_ps(_mm_unpackhi_ps(a, b), _mm_unpackhi_ps(c, a)));
    const __m256d whole = _mm256_set1_pd(kWhole);
    for (int axis = 0; axis < 3; ++axis) {
      const double* m = to.matrix.m + 3 * axis;
      const __m256d at = _mm256_set1_pd(m[0]) * x + _mm256_set1_pd(m[1]) * y + _mm256_set1_pd(m[2]) * z +
                         _mm256_set1_pd(to.translation[axis]);
      _mm256_store_pd(corners.places[axis], (at + whole) - whole);
    }
  }

  INNERSPHERE_KERNEL unsigned sides(const GridTriangle& plane, const GridTriangle& triangle) {
    const auto& at = triangle.places;
    const __m256d x = _mm256_loadu_pd(at[0]), y = _mm256_loadu_pd(at[1]), z = _mm256_loadu_pd(at[2]);
    return outside(_mm256_set1_pd(plane.normal.x) * x + _mm256_set1_pd(plane.normal.y) * y +
                       _mm256_set1_pd(plane.normal.z) * z - _mm256_set1_pd(plane.offset),
                   plane.heightRounding());
  }

  INNERSPHERE_KERNEL unsigned volumes(const Vec3d& from, const Vec3d& to, const double* t, const double* u,
                                      double rounding) {
    const __m256d ux = seen(u, 0, from.x), uy = seen(u, 1, from.y), uz = seen(u, 2, from.z);
    const __m256d x = _mm256_set1_pd(to.x), y = _mm256_set1_pd(to.y), z = _mm256_set1_pd(to.z);
    return outside(exchanged(seen(t, 0, from.x)) * (y * uz - z * uy) +
                       exchanged(seen(t, 1, from.y)) * (z * ux - x * uz) +
                       exchanged(seen(t, 2, from.z)) * (x * uy - y * ux),
                   rounding);
  }

 private:
  /// Functions that are given it do the same as those without a mask, in which some compilers see numbers
  /// that are not set.
  static constexpr __mmask16 kAll = 0xffff;

  INNERSPHERE_KERNEL __m512i fourTimes(const void* four) {
    return _mm512_maskz_broadcast_i32x4(kAll, _mm_loadu_si128(static_cast<const __m128i*>(four)));
  }
  INNERSPHERE_KERNEL __m512i eachFourTimes(const void* four) {
    const __m512i places = _mm512_set_epi32(3, 3, 3, 3, 2, 2, 2, 2, 1, 1, 1, 1, 0, 0, 0, 0);
    return _mm512_maskz_permutexvar_epi32(kAll, places, fourTimes(four));
  }
  INNERSPHERE_KERNEL __m512 turned(const FourFloats (&m)[3][4], const FourFloats* x) {
    return _mm512_loadu_ps(m[0]) * _mm512_castsi512_ps(fourTimes(x)) +
           _mm512_loadu_ps(m[1]) * _mm512_castsi512_ps(fourTimes(x + 1)) +
           _mm512_loadu_ps(m[2]) * _mm512_castsi512_ps(fourTimes(x + 2));
  }
  /// Writes three parts that are read one by one.
  INNERSPHERE_KERNEL void store(__m512i x, FourInts* sides) {
    const auto to = reinterpret_cast<__m128i*>(sides);
    constexpr __mmask8 kFour = 15;
    _mm_store_si128(to, _mm512_maskz_extracti32x4_epi32(kFour, x, 0));
    _mm_store_si128(to + 1, _mm512_maskz_extracti32x4_epi32(kFour, x, 1));
    _mm_store_si128(to + 2, _mm512_maskz_extracti32x4_epi32(kFour, x, 2));
  }
  INNERSPHERE_KERNEL __m512i cells(__m512 x) {
    const __m512 last = _mm512_set1_ps(SurfaceTree::CoarseGrid::kEnd);
    const __m512 bounded =
        _mm512_maskz_max_ps(kAll, _mm512_maskz_min_ps(kAll, x + _mm512_set1_ps(1), last), -last);
    return _mm512_maskz_cvttps_epi32(kAll, bounded);
  }
  INNERSPHERE_KERNEL unsigned outside(__m256d x, double bound) {
    const auto mask = [](__m256d bits) INNERSPHERE_AVX512_SURFACE {
      return static_cast<unsigned>(_mm256_movemask_pd(bits));
    };
    return mask(_mm256_cmp_pd(x, _mm256_set1_pd(bound), _CMP_GT_OQ)) |
           mask(_mm256_cmp_pd(x, _mm256_set1_pd(-bound), _CMP_LT_OQ)) << 4;
  }
  /// Two places of a row, twice.
  INNERSPHERE_KERNEL __m256d seen(const double* x, int axis, double from) {
    const __m128d two = _mm_loadu_pd(x + GridTriangle::kRow * axis);
    return _mm256_set_m128d(two, two) - _mm256_set1_pd(from);
  }
  INNERSPHERE_KERNEL __m256d exchanged(__m256d x) { return _mm256_permute_pd(x, 0b0110); }
};
#undef INNERSPHERE_KERNEL
#endif

}  // namespace innersphere
