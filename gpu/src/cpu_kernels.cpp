#include "cpu_kernels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

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

/// Tests a walker against the spheres in all cells where it looks.
inline bool walkCells(const core::GridView& grid, const core::Lookup& lookup, std::uint32_t self,
                      Candidates& candidates, CandidateSink& sink) {
  const core::Cells cells = core::cellsOf(grid, lookup);
  if (cells.all) {
    const auto always = [](const Sphere&) { return true; };
    return testPartners(grid, lookup, self, nullptr, grid.count, always, candidates, sink);
  }
  for (std::uint32_t number = 0; number < cells.count; ++number) {
    std::uint32_t at[3];
    cells.coordinates(number, at);
    const core::Cell cell = core::findCell(grid, core::cellKey(cells.tier, at[0], at[1], at[2]));
    const auto here = [&](const Sphere& s) { return core::countsIn(grid, cells, at, s); };
    if (!testPartners(grid, lookup, self, grid.listed + cell.first, cell.count, here, candidates, sink))
      return false;
  }
  return true;
}

/// The walkers of a cluster, all of them side by side: what core::makeLookup and core::cellsOf do for one
/// that looks into one cell.
struct Lookups {
  static constexpr std::size_t kSize = core::kClusterSize;
  enum State : std::int32_t { none, one_cell, several };
  alignas(64) float x[kSize], y[kSize], z[kSize], reach[kSize], smallest[kSize];
  alignas(64) std::int32_t tier[kSize], cell_x[kSize], cell_y[kSize], cell_z[kSize], state[kSize];

  core::Lookup lookup(std::uint32_t k) const { return {{x[k], y[k], z[k]}, reach[k], smallest[k]}; }
  std::uint64_t key(std::uint32_t k) const {
    return core::cellKey(tier[k], static_cast<std::uint32_t>(cell_x[k]),
                         static_cast<std::uint32_t>(cell_y[k]), static_cast<std::uint32_t>(cell_z[k]));
  }
};

inline void makeLookups(const core::Walker& walker, const core::Cluster& cluster, Lookups& to) {
  const core::Search search = walker.search;
  const Sphere* spheres = walker.own.spheres + cluster.first;
  const std::uint32_t count = cluster.count;
  for (std::uint32_t k = 0; k < count; ++k) {
    const core::Probe probe = core::makeProbe(search, spheres[k]);
    to.x[k] = probe.p.x;
    to.y[k] = probe.p.y;
    to.z[k] = probe.p.z;
    to.reach[k] = probe.radius + search.grid_margin + search.tolerance;
    to.smallest[k] = core::smallestPartner(search, probe.radius);
  }
  const core::GridView grid = walker.grid;
  for (std::uint32_t k = 0; k < count; ++k) {
    constexpr float kEnd = 1 << core::kAxisBits;
    const core::Vec3f p{to.x[k], to.y[k], to.z[k]};
    const int tier = core::tierOf(grid, core::levelOf(to.smallest[k]));
    const float inverse = core::powerOfTwo(-(grid.finest + tier));
    const float x = std::floor((p.x + grid.half.x) * inverse) + 1;
    const float y = std::floor((p.y + grid.half.y) * inverse) + 1;
    const float z = std::floor((p.z + grid.half.z) * inverse) + 1;
    const float lowest = std::min(std::min(x, y), z), highest = std::max(std::max(x, y), z);
    const float clear = core::reachOf(grid, tier) - to.reach[k];
    std::int32_t state = clear >= 0 ? Lookups::one_cell : Lookups::several;
    state = lowest >= 0 ? state : Lookups::several;
    state = highest < kEnd ? state : Lookups::several;
    state = core::meetsBounds(grid, p, to.reach[k]) ? state : Lookups::none;
    to.state[k] = to.smallest[k] > grid.largest ? Lookups::none : state;
    to.tier[k] = tier;
    to.cell_x[k] = static_cast<std::int32_t>(std::min(std::max(x, 0.0f), kEnd));
    to.cell_y[k] = static_cast<std::int32_t>(std::min(std::max(y, 0.0f), kEnd));
    to.cell_z[k] = static_cast<std::int32_t>(std::min(std::max(z, 0.0f), kEnd));
  }
}

inline bool walkImpl(const core::Walker& walker, const core::Cluster& cluster, Candidates& candidates,
                     CandidateSink& sink) {
  if (!core::clusterMeets(walker, cluster)) return true;
  const core::GridView& grid = walker.grid;
  Lookups lookups;
  makeLookups(walker, cluster, lookups);
  core::Cell cells[Lookups::kSize];
  for (std::uint32_t k = 0; k < cluster.count; ++k) {
    if (lookups.state[k] == Lookups::one_cell)
      __builtin_prefetch(grid.cells + core::hashCell(grid, lookups.key(k)));
  }
  for (std::uint32_t k = 0; k < cluster.count; ++k) {
    if (lookups.state[k] != Lookups::one_cell) continue;
    cells[k] = core::findCell(grid, lookups.key(k));
    __builtin_prefetch(grid.listed + cells[k].first);
  }
  const auto always = [](const Sphere&) { return true; };
  for (std::uint32_t k = 0; k < cluster.count; ++k) {
    const std::uint32_t self = cluster.first + k;
    if (lookups.state[k] == Lookups::one_cell) {
      if (!testPartners(grid, lookups.lookup(k), self, grid.listed + cells[k].first, cells[k].count, always,
                        candidates, sink))
        return false;
    } else if (lookups.state[k] == Lookups::several) {
      if (!walkCells(grid, lookups.lookup(k), self, candidates, sink)) return false;
    }
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
