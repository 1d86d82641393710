#include "cpu_kernels.hpp"

#include <algorithm>

#include "cpu_walk.hpp"

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
    Lanes::load(setup.a.grid.spheres, places_a,
                {columns[0] + k, columns[1] + k, columns[2] + k, columns[3] + k});
    Lanes::load(setup.b.grid.spheres, places_b,
                {columns[4] + k, columns[5] + k, columns[6] + k, columns[7] + k});
  }

  Sphere a(std::size_t k) const { return {columns[0][k], columns[1][k], columns[2][k], columns[3][k]}; }
  Sphere b(std::size_t k) const { return {columns[4][k], columns[5][k], columns[6][k], columns[7][k]}; }
};

template <typename Lanes, bool kWrench>
inline void sumImpl(const core::Setup& setup, bool from_a, const Candidates& candidates, Tally& tally) {
  constexpr std::size_t kSize = Candidates::kSize;
  constexpr int kTerms = kWrench ? core::kTerms : core::kVolumeTerms;
  SpherePairs<kSize> spheres;
  const std::size_t n = spheres.template load<Lanes>(
      setup, (from_a ? candidates.walker : candidates.partner).data(),
      (from_a ? candidates.partner : candidates.walker).data(), candidates.count);
  alignas(64) double terms[kTerms][kSize];
  alignas(64) std::int64_t hits[kSize];
  const core::Frame frame = setup.frame;
  const std::int64_t last = static_cast<std::int64_t>(candidates.count);
  for (std::size_t k = 0; k < n; ++k) {
    core::Pair pair = core::makePair(frame, spheres.a(k), spheres.b(k));
    const bool hit = static_cast<std::int64_t>(k) < last ? core::isHit(pair, from_a) : false;
    hits[k] = hit ? 1 : 0;
    const double sum = pair.ra + pair.rb;
    pair.distance2 = hit ? pair.distance2 : sum * sum;  // two balls that touch from outside add nothing
    const core::Terms added = core::makeTerms<kWrench>(pair);
    for (int i = 0; i < kTerms; ++i) terms[i][k] = added.terms[i];
  }
  for (std::size_t k = 0; k < n; ++k) tally.pairs += static_cast<std::size_t>(hits[k]);
  for (std::size_t k = 0; k < n; ++k) tally.hit[k] = static_cast<std::uint8_t>(hits[k]);
  for (int i = 0; i < kTerms; ++i) {
    const core::Unit unit = core::unitOf(setup.units, i);
    core::ShortSum sum{0, 0};
    for (std::size_t k = 0; k < n; ++k) core::addBits(sum, terms[i][k], unit);
    tally.terms[static_cast<std::size_t>(i)] = core::withoutMagic(sum, n);
  }
}

template <typename Lanes>
inline void evaluateImpl(const core::Setup& setup, std::size_t count, PairValues& pairs) {
  SpherePairs<PairValues::kSize> spheres;
  const std::size_t n = spheres.template load<Lanes>(setup, pairs.a.data(), pairs.b.data(), count);
  const core::Frame frame = setup.frame;
  for (std::size_t k = 0; k < n; ++k) {
    const core::Pair pair = core::makePair(frame, spheres.a(k), spheres.b(k));
    const core::Contact contact = core::makeContact(pair);
    const core::Vec3r moment = core::lensMoment(pair, contact);
    const core::Vec3r area = contact.lens.rim_area * contact.n;
    pairs.of[PairValues::volume][k] = contact.lens.volume;
    pairs.of[PairValues::moment][k] = moment.x;
    pairs.of[PairValues::moment + 1][k] = moment.y;
    pairs.of[PairValues::moment + 2][k] = moment.z;
    pairs.of[PairValues::area][k] = area.x;
    pairs.of[PairValues::area + 1][k] = area.y;
    pairs.of[PairValues::area + 2][k] = area.z;
  }
}

// Each variant is the same code, inlined into a function for its instructions.
#define INNERSPHERE_KERNELS(name, Lanes, attributes)                                                       \
  struct name {                                                                                            \
    attributes static std::uint32_t ballsMeeting(const core::Walker& walker, const Occupancy& occupancy,   \
                                                 const Sphere* balls, std::uint32_t count) {               \
      return innersphere::ballsMeeting(walker, occupancy, balls, count);                                   \
    }                                                                                                      \
    attributes static bool walk(const core::Walker& walker, const SphereColumns& listed,                   \
                                const std::uint32_t* clusters, std::size_t count, Candidates& candidates,  \
                                CandidateSink& sink) {                                                     \
      return walkClusters<Lanes>(walker, listed, clusters, count, candidates, sink);                       \
    }                                                                                                      \
    attributes static void sumAll(const core::Setup& setup, bool from_a, const Candidates& candidates,     \
                                  Tally& tally) {                                                          \
      sumImpl<Lanes, true>(setup, from_a, candidates, tally);                                              \
    }                                                                                                      \
    attributes static void sumVolumes(const core::Setup& setup, bool from_a, const Candidates& candidates, \
                                      Tally& tally) {                                                      \
      sumImpl<Lanes, false>(setup, from_a, candidates, tally);                                             \
    }                                                                                                      \
    attributes static void evaluate(const core::Setup& setup, std::size_t count, PairValues& pairs) {      \
      evaluateImpl<Lanes>(setup, count, pairs);                                                            \
    }                                                                                                      \
    static constexpr CpuKernels kKernels{ballsMeeting, walk, sumAll, sumVolumes, evaluate};                \
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
