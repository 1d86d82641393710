// Does what compilers do not make of loops by themselves: spheres from any places as columns, and a list of
// those that a query sphere meets. There is a version for each generation of x86-64 processors and one for
// all others; all give the same bits.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/traversal.hpp"
#include "cpu/kernels.hpp"
#include "grid/cell_spheres.hpp"

#if defined(__x86_64__) && defined(__GNUC__)
#define INNERSPHERE_X86
#include <immintrin.h>
#endif

namespace innersphere {

constexpr std::size_t kLanes = 16;         ///< spheres that are worked on together
constexpr std::uint32_t kMostCells = 128;  ///< that are found together

/// Says where the coordinates of kLanes spheres go.
struct Columns {
  float *x, *y, *z, *radius;

  operator SphereColumns() const { return {x, y, z, radius}; }
};

/// This is a run of GridView::listed.
struct ListRange {
  std::uint32_t first, count;
};

/// Answers what core::countsIn() asks of the centre of a partner, in cells from the edge of the grid: is it
/// in this window? `inverse` is one over the cells' size.
struct CellWindow {
  Vec3f half;
  float inverse;
  float lo[3], end[3];

  CellWindow() = default;
  CellWindow(const core::GridView& grid, const core::Cells& cells, const std::uint32_t (&cell)[3])
      : half(grid.half), inverse(core::powerOfTwo(-(grid.finest + cells.grid_level))) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const float number = static_cast<float>(static_cast<std::int32_t>(cell[axis]));
      lo[axis] = cell[axis] == cells.box.lo[axis] ? -kInfinity : number - 1;  // number 0 is before the first
      end[axis] = cell[axis] == cells.box.hi[axis] ? kInfinity : number;
    }
  }
};

/// Works on any processor; the other classes like it need what they are named after.
struct LanesAny {
  /// Loads kLanes spheres.
  static void load(const Sphere* spheres, const std::uint32_t* places, const Columns& to) {
    for (std::uint32_t k = 0; k < kLanes; ++k) {
      const Sphere& s = spheres[places[k]];
      to.x[k] = s.x;
      to.y[k] = s.y;
      to.z[k] = s.z;
      to.radius[k] = s.radius;
    }
  }

  /// Returns a bit for each sphere that the query sphere meets.
  static std::uint32_t meeting(const core::Lookup& lookup, const SphereColumns& spheres) {
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

  /// Returns a bit for each sphere with its centre in a window.
  static std::uint32_t within(const CellWindow& window, const SphereColumns& spheres) {
    const Vec3f half = window.half;
    std::uint32_t bits = 0;
    for (std::uint32_t k = 0; k < kLanes; ++k) {
      const float x = (spheres.x[k] + half.x) * window.inverse, y = (spheres.y[k] + half.y) * window.inverse,
                  z = (spheres.z[k] + half.z) * window.inverse;
      const bool in_x = x >= window.lo[0] && x < window.end[0], in_y = y >= window.lo[1] && y < window.end[1],
                 in_z = z >= window.lo[2] && z < window.end[2];
      bits |= (in_x && in_y && in_z ? 1u : 0u) << k;
    }
    return bits;
  }

  /// Writes the pairs of a query sphere with the places of these bits, from number c on, and returns how many
  /// there are then. There must be room for kLanes.
  static std::size_t append(std::uint32_t query_sphere, const std::uint32_t* places, std::uint32_t bits,
                            Candidates& to, std::size_t c) {
    for (; bits != 0; bits &= bits - 1, ++c) {
      to.query_sphere[c] = query_sphere;
      to.partner[c] = places[std::countr_zero(bits)];
    }
    return c;
  }

  /// Returns a bit for each number that is not zero.
  static std::uint32_t bitsOf(const std::uint32_t* flags) {
    std::uint32_t bits = 0;
    for (std::uint32_t k = 0; k < kLanes; ++k) bits |= (flags[k] != 0 ? 1u : 0u) << k;
    return bits;
  }

  /// Says which of kLanes items are kept.
  struct Kept {
    explicit Kept(std::uint32_t bits) : count(0) {
      for (std::uint32_t k = 0; k < kLanes; ++k) {
        number[count] = k;
        count += bits >> k & 1u;
      }
    }
    template <typename T>
    void copy(const T* from, T* to) const {
      for (std::uint32_t k = 0; k < count; ++k) to[k] = from[number[k]];
    }
    std::uint32_t number[kLanes], count;
  };

  static constexpr std::size_t kRows = 8;

  /// Writes a zero and seven columns, of kRows items from number k on, to rows.
  static void writeRows(const double* const (&columns)[7], std::size_t k, ContactValues* rows) {
    for (std::size_t row = 0; row < kRows; ++row) {
      rows[row].of[0] = 0;
      for (std::size_t i = 0; i < 7; ++i) rows[row].of[i + 1] = columns[i][k + row];
    }
  }

  /// Finds where the lists of some cells are; they are empty where there is no such cell.
  static void findCells(const core::GridView& grid, const std::uint64_t* keys, std::uint32_t count,
                        ListRange* lists) {
    for (std::uint32_t k = 0; k < count; ++k) __builtin_prefetch(grid.cells + core::hashCell(grid, keys[k]));
    for (std::uint32_t k = 0; k < count; ++k) {
      const core::Cell cell = core::findCell(grid, keys[k]);
      lists[k] = {cell.first, cell.count};
    }
  }
};

#ifdef INNERSPHERE_X86

/// Holds the numbers of the items in each set of 8 items, and then any others.
struct KeptNumbers {
  alignas(32) std::uint32_t numbers[256][8] = {};

  constexpr KeptNumbers() {
    for (std::uint32_t bits = 0; bits < 256; ++bits) {
      std::uint32_t count = 0;
      for (std::uint32_t k = 0; k < 8; ++k) {
        if (bits >> k & 1u) numbers[bits][count++] = k;
      }
    }
  }
};
inline constexpr KeptNumbers kKeptNumbers;

#define INNERSPHERE_AVX2 __attribute__((target("avx2")))
#define INNERSPHERE_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl")))

struct LanesAvx2 : LanesAny {
  INNERSPHERE_AVX2 static void load(const Sphere* spheres, const std::uint32_t* places, const Columns& to) {
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
      _mm256_storeu_ps(to.radius + k, _mm256_shuffle_ps(zr01, zr23, 0xee));
    }
  }

  INNERSPHERE_AVX2 static std::uint32_t meeting(const core::Lookup& lookup, const SphereColumns& spheres) {
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

  INNERSPHERE_AVX2 static std::uint32_t within(const CellWindow& window, const SphereColumns& spheres) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < kLanes; k += 8) {
      const auto in = [&](const float* column, float half, int axis) INNERSPHERE_AVX2 {
        const __m256 at =
            (_mm256_loadu_ps(column + k) + _mm256_set1_ps(half)) * _mm256_set1_ps(window.inverse);
        const __m256 low = _mm256_cmp_ps(at, _mm256_set1_ps(window.lo[axis]), _CMP_GE_OQ);
        const __m256 high = _mm256_cmp_ps(at, _mm256_set1_ps(window.end[axis]), _CMP_LT_OQ);
        return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_and_ps(low, high)));
      };
      bits |= (in(spheres.x, window.half.x, 0) & in(spheres.y, window.half.y, 1) &
               in(spheres.z, window.half.z, 2))
              << k;
    }
    return bits;
  }

  INNERSPHERE_AVX2 static std::size_t append(std::uint32_t query_sphere, const std::uint32_t* places,
                                             std::uint32_t bits, Candidates& to, std::size_t c) {
    const __m256i self = _mm256_set1_epi32(static_cast<int>(query_sphere));
    for (std::size_t k = 0; k < kLanes; k += 8) {
      const std::uint32_t here = bits >> k & 255u;
      keep(here, places + k, to.partner.data() + c);
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(to.query_sphere.data() + c), self);
      c += static_cast<std::size_t>(std::popcount(here));
    }
    return c;
  }

  INNERSPHERE_AVX2 static std::uint32_t bitsOf(const std::uint32_t* flags) {
    std::uint32_t none = 0;
    for (std::size_t k = 0; k < kLanes; k += 8) {
      const __m256i here = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(flags + k));
      const __m256 zero = _mm256_castsi256_ps(_mm256_cmpeq_epi32(here, _mm256_setzero_si256()));
      none |= static_cast<std::uint32_t>(_mm256_movemask_ps(zero)) << k;
    }
    return none ^ 0xffffu;
  }

  struct Kept {
    explicit Kept(std::uint32_t kept) : bits(kept) {}
    /// Copies the items that are kept, in their order. There must be room for kLanes.
    template <typename T>
    INNERSPHERE_AVX2 void copy(const T* from, T* to) const {
      keep(bits & 255u, from, to);
      keep(bits >> 8, from + 8, to + std::popcount(bits & 255u));
    }
    std::uint32_t bits;
  };

 private:
  /// Writes those of 8 items, and others after them.
  template <typename T>
  INNERSPHERE_AVX2 static void keep(std::uint32_t bits, const T* from, T* to) {
    const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
    const __m256i numbers = _mm256_load_si256(reinterpret_cast<const __m256i*>(kKeptNumbers.numbers[bits]));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(all, numbers));
  }
};

struct LanesAvx512 : LanesAny {
  INNERSPHERE_AVX512 static void load(const Sphere* spheres, const std::uint32_t* places, const Columns& to) {
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
    _mm512_storeu_ps(to.radius, _mm512_maskz_shuffle_f32x4(kEvery, zr01, zr23, 0xdd));
  }

  INNERSPHERE_AVX512 static std::uint32_t meeting(const core::Lookup& lookup, const SphereColumns& spheres) {
    const __m512 r = _mm512_loadu_ps(spheres.radius);
    const __m512 dx = _mm512_loadu_ps(spheres.x) - _mm512_set1_ps(lookup.p.x);
    const __m512 dy = _mm512_loadu_ps(spheres.y) - _mm512_set1_ps(lookup.p.y);
    const __m512 dz = _mm512_loadu_ps(spheres.z) - _mm512_set1_ps(lookup.p.z);
    const __m512 sum = _mm512_set1_ps(lookup.reach) + r;
    const __mmask16 near = _mm512_cmp_ps_mask(dx * dx + dy * dy + dz * dz, sum * sum, _CMP_NGT_UQ);
    return _mm512_mask_cmp_ps_mask(near, r, _mm512_set1_ps(lookup.smallest), _CMP_NLT_UQ);
  }

  INNERSPHERE_AVX512 static std::uint32_t within(const CellWindow& window, const SphereColumns& spheres) {
    const auto in = [&](const float* column, float half, int axis) INNERSPHERE_AVX512 {
      const __m512 at = (_mm512_loadu_ps(column) + _mm512_set1_ps(half)) * _mm512_set1_ps(window.inverse);
      const __mmask16 low = _mm512_cmp_ps_mask(at, _mm512_set1_ps(window.lo[axis]), _CMP_GE_OQ);
      return std::uint32_t{_mm512_mask_cmp_ps_mask(low, at, _mm512_set1_ps(window.end[axis]), _CMP_LT_OQ)};
    };
    return in(spheres.x, window.half.x, 0) & in(spheres.y, window.half.y, 1) &
           in(spheres.z, window.half.z, 2);
  }

  INNERSPHERE_AVX512 static std::size_t append(std::uint32_t query_sphere, const std::uint32_t* places,
                                               std::uint32_t bits, Candidates& to, std::size_t c) {
    const __m512i met = _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), _mm512_loadu_si512(places));
    const __m512i self = _mm512_set1_epi32(static_cast<int>(query_sphere));
    std::uint32_t *query_spheres = to.query_sphere.data() + c, *partners = to.partner.data() + c;
    const int count = std::popcount(bits);
    // Mostly few: short stores seldom cross a line of the cache.
    std::memcpy(query_spheres, &self, 16);
    std::memcpy(partners, &met, 16);
    if (count > 4) {
      std::memcpy(query_spheres, &self, 64);
      std::memcpy(partners, &met, 64);
    }
    return c + static_cast<std::size_t>(count);
  }

  INNERSPHERE_AVX512 static std::uint32_t bitsOf(const std::uint32_t* flags) {
    const __m512i all = _mm512_loadu_si512(flags);
    return _mm512_test_epi32_mask(all, all);
  }

  struct Kept {
    explicit Kept(std::uint32_t bits) : kept(static_cast<__mmask16>(bits)) {}
    /// Copies the items that are kept, in their order. There must be room for kLanes.
    template <typename T>
    INNERSPHERE_AVX512 void copy(const T* from, T* to) const {
      _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(kept, _mm512_loadu_si512(from)));
    }
    __mmask16 kept;
  };

  INNERSPHERE_AVX512 static void writeRows(const double* const (&columns)[7], std::size_t k,
                                           ContactValues* rows) {
    constexpr __mmask8 kEvery = 0xff;
    __m512d even[4] = {_mm512_setzero_pd()}, odd[4];  // columns of the rows
    for (std::size_t i = 0; i < 4; ++i) odd[i] = _mm512_load_pd(columns[2 * i] + k);
    for (std::size_t i = 1; i < 4; ++i) even[i] = _mm512_load_pd(columns[2 * i - 1] + k);
    for (std::size_t parity = 0; parity < 2; ++parity) {
      __m512d pairs[4];  // of columns; rows 0, 2, 4, 6 or 1, 3, 5, 7
      for (std::size_t i = 0; i < 4; ++i)
        pairs[i] = parity == 0 ? _mm512_maskz_unpacklo_pd(kEvery, even[i], odd[i])
                               : _mm512_maskz_unpackhi_pd(kEvery, even[i], odd[i]);
      const __m512d left04 = _mm512_maskz_shuffle_f64x2(kEvery, pairs[0], pairs[1], 0x88);
      const __m512d left26 = _mm512_maskz_shuffle_f64x2(kEvery, pairs[0], pairs[1], 0xdd);
      const __m512d right04 = _mm512_maskz_shuffle_f64x2(kEvery, pairs[2], pairs[3], 0x88);
      const __m512d right26 = _mm512_maskz_shuffle_f64x2(kEvery, pairs[2], pairs[3], 0xdd);
      ContactValues* const to = rows + parity;
      _mm512_store_pd(to[0].of, _mm512_maskz_shuffle_f64x2(kEvery, left04, right04, 0x88));
      _mm512_store_pd(to[2].of, _mm512_maskz_shuffle_f64x2(kEvery, left26, right26, 0x88));
      _mm512_store_pd(to[4].of, _mm512_maskz_shuffle_f64x2(kEvery, left04, right04, 0xdd));
      _mm512_store_pd(to[6].of, _mm512_maskz_shuffle_f64x2(kEvery, left26, right26, 0xdd));
    }
  }

  INNERSPHERE_AVX512 static void findCells(const core::GridView& grid, const std::uint64_t* keys,
                                           std::uint32_t count, ListRange* lists) {
    constexpr __mmask8 kEvery = 0xff;
    const auto* const words = reinterpret_cast<const long long*>(grid.cells);
    const __m512i none = _mm512_setzero_si512(), one = _mm512_set1_epi64(1);
    const __m512i factor = _mm512_set1_epi64(static_cast<long long>(core::kHashFactor));
    const __m512i last = _mm512_set1_epi64((1ll << (64 - grid.hash_shift)) - 1);
    const __m128i shift = _mm_cvtsi32_si128(grid.hash_shift);
    alignas(64) std::uint64_t slots[kMostCells];
    for (std::uint32_t k = 0; k < count; k += 8) {
      const __m512i hash = _mm512_mullo_epi64(_mm512_loadu_si512(keys + k), factor);
      _mm512_store_si512(slots + k, _mm512_maskz_srl_epi64(kEvery, hash, shift));
    }
    for (std::uint32_t k = 0; k < count; ++k) __builtin_prefetch(grid.cells + slots[k]);
    for (std::uint32_t k = 0; k < count; k += 8) {
      const __m512i key = _mm512_loadu_si512(keys + k);
      __m512i at = _mm512_load_si512(slots + k), lists_here = none;
      for (__mmask8 left = kEvery; left != 0;) {
        const __m512i slot = _mm512_maskz_slli_epi64(kEvery, at, 1);  // of two words: a key, a list
        const __m512i there = _mm512_mask_i64gather_epi64(none, left, slot, words, 8);
        const __m512i list = _mm512_mask_i64gather_epi64(none, left, slot, words + 1, 8);
        const __mmask8 found = _mm512_mask_cmpeq_epi64_mask(left, there, key);
        lists_here = _mm512_mask_mov_epi64(lists_here, found, list);
        left = _mm512_mask_test_epi64_mask(static_cast<__mmask8>(left & ~found), list, list);
        at = _mm512_and_si512(_mm512_add_epi64(at, one), last);
      }
      _mm512_storeu_si512(lists + k, lists_here);
    }
  }
};

#endif

}  // namespace innersphere
