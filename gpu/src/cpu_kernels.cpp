#include "cpu_kernels.hpp"

#include <algorithm>
#include <bit>

namespace innersphere {

namespace {

constexpr std::size_t kLanes = 8;

/// Tests a walker against some spheres of the grid: places[0 .. count), or if there are none the first ones.
/// `counts` has the last word on those that meet it.
template <typename Counts>
inline bool testPartners(const core::GridView& grid, const core::Lookup& lookup, std::uint32_t self,
                         const std::uint32_t* places, std::uint32_t count, const Counts& counts,
                         Candidates& candidates, CandidateSink& sink) {
  constexpr std::uint32_t kSize = 32;
  alignas(64) float x[kSize], y[kSize], z[kSize], radius[kSize];
  alignas(64) std::uint32_t bits[kSize];
  for (std::uint32_t begin = 0; begin < count; begin += kSize) {
    const std::uint32_t n = std::min(kSize, count - begin), whole = (n + kLanes - 1) / kLanes * kLanes;
    if (candidates.count + kSize > Candidates::kSize && !sink.take(candidates)) return false;
    const auto placeOf = [&](std::uint32_t k) { return places ? places[begin + k] : begin + k; };
    for (std::uint32_t k = 0; k < whole; ++k) {
      const Sphere& s = grid.centred[k < n ? placeOf(k) : grid.count];
      x[k] = s.x;
      y[k] = s.y;
      z[k] = s.z;
      radius[k] = s.radius;
    }
    for (std::uint32_t k = 0; k < whole; ++k) {
      const float dx = x[k] - lookup.p.x, dy = y[k] - lookup.p.y, dz = z[k] - lookup.p.z;
      const float sum = lookup.reach + radius[k];
      const std::uint32_t large = radius[k] < lookup.smallest ? 0 : 1u << k;
      bits[k] = dx * dx + dy * dy + dz * dz > sum * sum ? 0 : large;
    }
    std::uint32_t met = 0;
    for (std::uint32_t k = 0; k < whole; ++k) met |= bits[k];
    std::size_t c = candidates.count;
    for (; met != 0; met &= met - 1) {
      const std::uint32_t place = placeOf(static_cast<std::uint32_t>(std::countr_zero(met)));
      candidates.walker[c] = self;
      candidates.partner[c] = place;
      c += counts(grid.centred[place]) ? 1 : 0;
    }
    candidates.count = c;
  }
  return true;
}

inline bool walkSphere(const core::Walker& walker, std::uint32_t self, Candidates& candidates,
                       CandidateSink& sink) {
  core::Lookup lookup;
  if (!core::makeLookup(walker, walker.own.spheres[self], lookup)) return true;
  const core::GridView& grid = walker.grid;
  const core::Cells cells = core::cellsOf(grid, lookup);
  const auto always = [](const Sphere&) { return true; };
  if (cells.all) return testPartners(grid, lookup, self, nullptr, grid.count, always, candidates, sink);
  for (std::uint32_t number = 0; number < cells.count; ++number) {
    std::uint32_t at[3];
    cells.coordinates(number, at);
    const core::Cell cell = core::findCell(grid, core::cellKey(cells.tier, at[0], at[1], at[2]));
    const std::uint32_t* places = grid.listed + cell.first;
    const auto here = [&](const Sphere& s) { return core::countsIn(grid, cells, at, s); };
    if (!(cells.count > 1 ? testPartners(grid, lookup, self, places, cell.count, here, candidates, sink)
                          : testPartners(grid, lookup, self, places, cell.count, always, candidates, sink)))
      return false;
  }
  return true;
}

inline bool walkImpl(const core::Walker& walker, const core::Cluster& cluster, Candidates& candidates,
                     CandidateSink& sink) {
  if (!core::clusterMeets(walker, cluster)) return true;
  for (std::uint32_t k = cluster.first; k < cluster.first + cluster.count; ++k) {
    if (!walkSphere(walker, k, candidates, sink)) return false;
  }
  return true;
}

/// The spheres of some pairs, an array for each coordinate.
template <std::size_t kSize>
struct SpherePairs {
  alignas(64) float columns[8][kSize];

  /// Pairs from `count` on repeat the last one, up to whole lanes. Returns how many there are then.
  template <typename Places>
  std::size_t load(const core::Setup& setup, const Places& places_a, const Places& places_b,
                   std::size_t count) {
    const std::size_t n = (count + kLanes - 1) / kLanes * kLanes;
    const Sphere* as = setup.a.grid.spheres;
    const Sphere* bs = setup.b.grid.spheres;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t c = std::min(k, count - 1);
      const Sphere a = as[places_a[c]], b = bs[places_b[c]];
      columns[0][k] = a.x;
      columns[1][k] = a.y;
      columns[2][k] = a.z;
      columns[3][k] = a.radius;
      columns[4][k] = b.x;
      columns[5][k] = b.y;
      columns[6][k] = b.z;
      columns[7][k] = b.radius;
    }
    return n;
  }

  Sphere a(std::size_t k) const { return {columns[0][k], columns[1][k], columns[2][k], columns[3][k]}; }
  Sphere b(std::size_t k) const { return {columns[4][k], columns[5][k], columns[6][k], columns[7][k]}; }
};

template <bool kWrench>
inline void sumImpl(const core::Setup& setup, bool from_a, const Candidates& candidates, Tally& tally) {
  constexpr std::size_t kSize = Candidates::kSize;
  constexpr int kTerms = kWrench ? core::kTerms : core::kVolumeTerms;
  SpherePairs<kSize> spheres;
  const std::size_t n = spheres.load(setup, from_a ? candidates.walker : candidates.partner,
                                     from_a ? candidates.partner : candidates.walker, candidates.count);
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
    for (std::size_t k = 0; k < n; ++k) core::add(sum, terms[i][k], unit);
    tally.terms[static_cast<std::size_t>(i)] = sum;
  }
}

inline void evaluateImpl(const core::Setup& setup, std::size_t count, PairValues& pairs) {
  SpherePairs<PairValues::kSize> spheres;
  const std::size_t n = spheres.load(setup, pairs.a, pairs.b, count);
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
#define INNERSPHERE_KERNELS(name, attributes)                                                              \
  struct name {                                                                                            \
    attributes static bool walk(const core::Walker& walker, const core::Cluster& cluster,                  \
                                Candidates& candidates, CandidateSink& sink) {                             \
      return walkImpl(walker, cluster, candidates, sink);                                                  \
    }                                                                                                      \
    attributes static void sumAll(const core::Setup& setup, bool from_a, const Candidates& candidates,     \
                                  Tally& tally) {                                                          \
      sumImpl<true>(setup, from_a, candidates, tally);                                                     \
    }                                                                                                      \
    attributes static void sumVolumes(const core::Setup& setup, bool from_a, const Candidates& candidates, \
                                      Tally& tally) {                                                      \
      sumImpl<false>(setup, from_a, candidates, tally);                                                    \
    }                                                                                                      \
    attributes static void evaluate(const core::Setup& setup, std::size_t count, PairValues& pairs) {      \
      evaluateImpl(setup, count, pairs);                                                                   \
    }                                                                                                      \
    static constexpr CpuKernels kKernels{walk, sumAll, sumVolumes, evaluate};                              \
  }

INNERSPHERE_KERNELS(Baseline, __attribute__((flatten)));
#if defined(__x86_64__) && defined(__GNUC__)
INNERSPHERE_KERNELS(Avx2, __attribute__((target("avx2"), flatten)));
INNERSPHERE_KERNELS(Avx512, __attribute__((target("avx512f,avx512dq,avx512vl"), flatten)));
#endif
#undef INNERSPHERE_KERNELS

}  // namespace

const std::vector<const CpuKernels*>& supportedKernels() {
  static const std::vector<const CpuKernels*> kernels = [] {
    std::vector<const CpuKernels*> all;
#if defined(__x86_64__) && defined(__GNUC__)
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
