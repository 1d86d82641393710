#include "cpu/kernels.hpp"

#include <algorithm>
#include <cstring>

#include "cpu/traversal.hpp"

namespace innersphere {

namespace {

/// The spheres of some pairs, an array for each coordinate.
template <std::size_t kSize>
struct SpherePairs {
  alignas(64) float columns[8][kSize];

  /// Pairs from `count` on repeat the last one, up to whole lanes. Returns how many there are then.
  template <typename Lanes>
  std::size_t load(const core::Setup& setup, const std::uint32_t* places_a, const std::uint32_t* places_b,
                   std::size_t count) {
    const std::size_t whole = count / kLanes * kLanes;
    for (std::size_t k = 0; k < whole; k += kLanes) loadLanes<Lanes>(setup, places_a + k, places_b + k, k);
    if (whole == count) return whole;
    std::uint32_t a[kLanes], b[kLanes];
    for (std::size_t k = 0; k < kLanes; ++k) {
      a[k] = places_a[std::min(whole + k, count - 1)];
      b[k] = places_b[std::min(whole + k, count - 1)];
    }
    loadLanes<Lanes>(setup, a, b, whole);
    return whole + kLanes;
  }

  template <typename Lanes>
  void loadLanes(const core::Setup& setup, const std::uint32_t* places_a, const std::uint32_t* places_b,
                 std::size_t k) {
    Lanes::load(setup.a.spheres, places_a, {columns[0] + k, columns[1] + k, columns[2] + k, columns[3] + k});
    Lanes::load(setup.b.spheres, places_b, {columns[4] + k, columns[5] + k, columns[6] + k, columns[7] + k});
  }

  Sphere a(std::size_t k) const { return {columns[0][k], columns[1][k], columns[2][k], columns[3][k]}; }
  Sphere b(std::size_t k) const { return {columns[4][k], columns[5][k], columns[6][k], columns[7][k]}; }
};

/// Says which terms of pairs are made. Those of contacts are not summed: that is left to their spheres.
enum class Make { volumes, contacts, all };

constexpr bool isMade(Make make, int term) {
  if (make == Make::all || term < core::kVolumeTerms) return true;
  return make == Make::contacts && term >= core::kArea && term < core::kStiffness;
}

template <Make kMake>
inline core::Terms makeTerms(const core::Pair& pair) {
  if constexpr (kMake != Make::contacts) return core::makeTerms<kMake == Make::all>(pair);
  core::Terms terms;
  core::setTerms<true>(pair, core::makeContact(pair), terms);
  return terms;
}

template <typename Lanes, Make kMake>
inline void sumImpl(const core::Setup& setup, bool from_a, const Candidates& candidates, Tally& tally) {
  constexpr std::size_t kSize = Candidates::kSize;
  SpherePairs<kSize> spheres;
  const std::size_t n = spheres.template load<Lanes>(
      setup, (from_a ? candidates.query_sphere : candidates.partner).data(),
      (from_a ? candidates.partner : candidates.query_sphere).data(), candidates.count);
  double(*const terms)[kSize] = tally.terms;
  alignas(64) std::int64_t found_pairs[kSize];
  const core::Frame frame = setup.frame;
  const std::int64_t last = static_cast<std::int64_t>(candidates.count);
  for (std::size_t k = 0; k < n; ++k) {
    core::Pair pair = core::makePair(frame, spheres.a(k), spheres.b(k));
    const bool found = static_cast<std::int64_t>(k) < last ? core::isReported(pair, from_a) : false;
    found_pairs[k] = found ? 1 : 0;
    const double sum = pair.ra + pair.rb;
    pair.distance2 = found ? pair.distance2 : sum * sum;  // two balls that touch from outside add nothing
    const core::Terms added = makeTerms<kMake>(pair);
    for (int i = 0; i < core::kTerms; ++i) {
      if (isMade(kMake, i)) terms[i][k] = added.terms[i];
    }
  }
  tally.pairs = 0;
  for (std::size_t k = 0; k < n; ++k) tally.pairs += static_cast<std::size_t>(found_pairs[k]);
  for (std::size_t k = 0; k < n; ++k) tally.found[k] = static_cast<std::uint8_t>(found_pairs[k]);
  if constexpr (kMake == Make::contacts) return;
  for (int i = 0; i < core::kTerms && isMade(kMake, i); ++i) {
    const core::Unit unit = core::unitOf(setup.units, i);
    core::ShortSum sum{0, 0};
    for (std::size_t k = 0; k < n; ++k) core::addBits(sum, terms[i][k], unit);
    tally.sums[static_cast<std::size_t>(i)] = core::withoutUnit(sum, n, unit);
  }
}

template <typename Lanes>
inline void writeValuesImpl(const Tally& tally, std::size_t count, ContactValues* values) {
  constexpr std::size_t kRows = Lanes::kRows;
  static_assert(ContactValues::kVolume == 1 && ContactValues::kMoment == 2 && ContactValues::kArea == 5);
  const auto& terms = tally.terms;
  const double* const columns[] = {terms[core::kVolume],     terms[core::kMoment], terms[core::kMoment + 1],
                                   terms[core::kMoment + 2], terms[core::kArea],   terms[core::kArea + 1],
                                   terms[core::kArea + 2]};
  for (std::size_t k = 0; k < count; k += kRows) {
    std::size_t here = 0, found_pairs = 0;
    for (; here < kRows && k + here < count; ++here) found_pairs += tally.found[k + here];
    if (found_pairs == kRows) {
      Lanes::writeRows(columns, k, values);
      values += kRows;
      continue;
    }
    ContactValues rows[kRows];
    Lanes::writeRows(columns, k, rows);
    for (std::size_t row = 0; row < here; ++row) {
      if (tally.found[k + row]) *values++ = rows[row];
    }
  }
}

inline void addValues(const double* values, double (&sums)[ContactValues::kCount]) {
  for (std::size_t i = 0; i < ContactValues::kCount; ++i) sums[i] += values[i];
}

/// Pairs whose values are fetched ahead: sorted by spheres, they are in no order that a processor foresees.
constexpr std::size_t kAhead = 32;

/// The values of a sphere with many partners go to kPartialSums partial sums, every so many of them, then
/// these sums: so a device can sum them side by side, to the same bits.
inline void sumContactsImpl(const ContactValues* values, const std::uint32_t* order, const std::size_t* heads,
                            std::size_t begin, std::size_t end, SphereContact* contacts) {
  constexpr std::size_t kCount = ContactValues::kCount, kMoment = ContactValues::kMoment;
  const std::size_t last = heads[end] - 1;
  for (std::size_t c = begin; c < end; ++c) {
    const std::uint32_t* const found_pairs = order + heads[c];
    const std::size_t count = heads[c + 1] - heads[c];
    double sums[kCount] = {};
    if (count <= kPartialSums) {
      for (std::size_t k = 0; k < count; ++k) {
        __builtin_prefetch(&values[order[std::min(heads[c] + k + kAhead, last)]]);
        addValues(values[found_pairs[k]].of, sums);
      }
    } else {
      for (std::size_t part = 0; part < kPartialSums; ++part) {
        double partial[kCount] = {};
        for (std::size_t k = part; k < count; k += kPartialSums)
          addValues(values[found_pairs[k]].of, partial);
        addValues(partial, sums);
      }
    }
    const double volume = sums[ContactValues::kVolume], inverse = volume > 0 ? 1 / volume : 0;
    for (std::size_t i = 0; i < 3; ++i) sums[kMoment + i] *= inverse;
    float numbers[kCount];
    for (std::size_t i = 0; i < kCount; ++i) numbers[i] = static_cast<float>(sums[i]);
    SphereContact& contact = contacts[c];
    static_assert(sizeof contact == sizeof numbers);
    const std::uint32_t sphere = contact.sphere;
    std::memcpy(&contact, numbers, sizeof contact);
    contact.sphere = sphere;
  }
}

inline void nearestDirectionsImpl(const float* x, const float* y, const float* z, std::size_t count,
                                  const Vec3f* directions, std::size_t direction_count,
                                  std::uint32_t* nearest) {
  for (std::size_t first = 0; first < count; first += kLanes) {
    alignas(64) float best[kLanes];
    alignas(64) std::uint32_t found[kLanes];
    std::fill_n(best, kLanes, -2.0f);
    std::fill_n(found, kLanes, 0u);
    for (std::size_t d = 0; d < direction_count; ++d) {
      const Vec3f n = directions[d];
      for (std::size_t k = 0; k < kLanes; ++k) {
        const float cosine = x[first + k] * n.x + y[first + k] * n.y + z[first + k] * n.z;
        const bool nearer = cosine > best[k];
        best[k] = nearer ? cosine : best[k];
        found[k] = nearer ? static_cast<std::uint32_t>(d) : found[k];
      }
    }
    std::copy_n(found, kLanes, nearest + first);
  }
}

// Each variant is the same code, inlined into a function for its instructions.
#define INNERSPHERE_KERNELS(name, Lanes, attributes)                                                       \
  struct name {                                                                                            \
    attributes static std::uint32_t ballsMeeting(const core::Traversal& traversal,                         \
                                                 const Occupancy& occupancy, const Sphere* balls,          \
                                                 std::uint32_t count) {                                    \
      return innersphere::ballsMeeting(traversal, occupancy, balls, count);                                \
    }                                                                                                      \
    attributes static bool traverse(const core::Traversal& traversal, const SphereColumns& listed,         \
                                    const std::uint32_t* clusters, std::size_t count,                      \
                                    Candidates& candidates, CandidateSink& sink) {                         \
      return traverseClusters<Lanes>(traversal, listed, clusters, count, candidates, sink);                \
    }                                                                                                      \
    attributes static void sumAll(const core::Setup& setup, bool from_a, const Candidates& candidates,     \
                                  Tally& tally) {                                                          \
      sumImpl<Lanes, Make::all>(setup, from_a, candidates, tally);                                         \
    }                                                                                                      \
    attributes static void sumVolumes(const core::Setup& setup, bool from_a, const Candidates& candidates, \
                                      Tally& tally) {                                                      \
      sumImpl<Lanes, Make::volumes>(setup, from_a, candidates, tally);                                     \
    }                                                                                                      \
    attributes static void decide(const core::Setup& setup, bool from_a, const Candidates& candidates,     \
                                  Tally& tally) {                                                          \
      sumImpl<Lanes, Make::contacts>(setup, from_a, candidates, tally);                                    \
    }                                                                                                      \
    attributes static void writeValues(const Tally& tally, std::size_t count, ContactValues* values) {     \
      writeValuesImpl<Lanes>(tally, count, values);                                                        \
    }                                                                                                      \
    attributes static void sumContacts(const ContactValues* values, const std::uint32_t* order,            \
                                       const std::size_t* heads, std::size_t begin, std::size_t end,       \
                                       SphereContact* contacts) {                                          \
      sumContactsImpl(values, order, heads, begin, end, contacts);                                         \
    }                                                                                                      \
    attributes static void nearestDirections(const float* x, const float* y, const float* z,               \
                                             std::size_t count, const Vec3f* directions,                   \
                                             std::size_t direction_count, std::uint32_t* nearest) {        \
      nearestDirectionsImpl(x, y, z, count, directions, direction_count, nearest);                         \
    }                                                                                                      \
    static constexpr CpuKernels kKernels{ballsMeeting, traverse,    sumAll,      sumVolumes,               \
                                         decide,       writeValues, sumContacts, nearestDirections};       \
  }

INNERSPHERE_KERNELS(Baseline, LanesAny, __attribute__((flatten)));
#ifdef INNERSPHERE_X86
INNERSPHERE_KERNELS(Avx2, LanesAvx2, __attribute__((target("avx2"), flatten)));
INNERSPHERE_KERNELS(Avx512, LanesAvx512, __attribute__((target("avx512f,avx512dq,avx512vl"), flatten)));
#endif
#undef INNERSPHERE_KERNELS

}  // namespace

const std::vector<const CpuKernels*>& supportedKernels() {
  static const std::vector<const CpuKernels*> kernels = [] {
    std::vector<const CpuKernels*> all;
#ifdef INNERSPHERE_X86
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
      all.push_back(&Avx512::kKernels);
    if (__builtin_cpu_supports("avx2")) all.push_back(&Avx2::kKernels);
#endif
    all.push_back(&Baseline::kKernels);
    return all;
  }();
  return kernels;
}

}  // namespace innersphere
