#include "cpu_kernels.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace innersphere {

namespace {

using core::Vec3f;

constexpr std::size_t kLanes = 8;

/// The spheres of a cluster that may meet the other grid at all, as that grid sees them.
struct Walkers {
  alignas(64) std::array<float, core::kClusterSize> x, y, z, reach;
  std::array<std::uint32_t, core::kClusterSize> place;
  std::size_t count = 0;
  Vec3f lo, hi;             ///< around the centres
  float largest_reach = 0;  ///< radius with all margins and tolerances
};

/// Spheres of the grid that are near the walkers.
struct Partners {
  static constexpr std::size_t kSize = 512;
  std::array<std::uint32_t, kSize + kLanes> place;
  std::size_t count = 0;
};

inline void makeWalkers(const core::Walker& walker, const core::Cluster& cluster, Walkers& walkers) {
  constexpr float kMax = std::numeric_limits<float>::max();
  walkers.lo = {kMax, kMax, kMax};
  walkers.hi = {-kMax, -kMax, -kMax};
  const float tolerance = walker.search.tolerance;
  std::size_t n = 0;
  for (std::uint32_t k = cluster.first; k < cluster.first + cluster.count; ++k) {
    const core::Probe probe = core::makeProbe(walker.search, walker.own.spheres[k]);
    const float reach = probe.radius + walker.search.grid_margin + tolerance;
    if (!core::meetsBounds(walker.grid, probe.p, reach)) continue;
    const Vec3f& p = probe.p;
    walkers.x[n] = p.x;
    walkers.y[n] = p.y;
    walkers.z[n] = p.z;
    walkers.reach[n] = reach;
    walkers.place[n] = k;
    walkers.lo = {std::min(walkers.lo.x, p.x), std::min(walkers.lo.y, p.y), std::min(walkers.lo.z, p.z)};
    walkers.hi = {std::max(walkers.hi.x, p.x), std::max(walkers.hi.y, p.y), std::max(walkers.hi.z, p.z)};
    walkers.largest_reach = std::max(walkers.largest_reach, reach);
    ++n;
  }
  walkers.count = n;
}

/// Adds the spheres of a run that may meet the box around the walkers. Reads past the end of the run: the
/// columns are padded. Returns where it stopped for want of room.
inline std::uint32_t addRun(const Columns& columns, const Walkers& walkers, std::uint32_t first,
                            std::uint32_t end, Partners& partners) {
  const Vec3f lo = walkers.lo, hi = walkers.hi;
  const float reach = walkers.largest_reach;
  std::size_t n = partners.count;
  std::uint32_t at = first;
  for (; at < end && n + kLanes <= Partners::kSize; at += kLanes) {
    const float* x = columns.x + at;
    const float* y = columns.y + at;
    const float* z = columns.z + at;
    const float* r = columns.radius + at;
    alignas(32) std::int32_t near[kLanes];
    for (std::size_t k = 0; k < kLanes; ++k) {
      const float dx = std::max(std::max(lo.x - x[k], x[k] - hi.x), 0.0f);
      const float dy = std::max(std::max(lo.y - y[k], y[k] - hi.y), 0.0f);
      const float dz = std::max(std::max(lo.z - z[k], z[k] - hi.z), 0.0f);
      const float sum = r[k] + reach;
      const std::int32_t inside = at + k < end ? 1 : 0;
      near[k] = dx * dx + dy * dy + dz * dz > sum * sum ? 0 : inside;
    }
    for (std::size_t k = 0; k < kLanes; ++k) {  // always written, kept where near: no branch to mispredict
      partners.place[n] = at + static_cast<std::uint32_t>(k);
      n += static_cast<std::size_t>(near[k]);
    }
  }
  partners.count = n;
  return at;
}

/// Tests each partner against all walkers.
inline bool testPartners(const Columns& columns, const Walkers& walkers, Partners& partners,
                         Candidates& candidates, CandidateSink& sink) {
  constexpr std::size_t kSize = Partners::kSize;
  alignas(64) float x[kSize], y[kSize], z[kSize], radius[kSize];
  alignas(64) std::uint32_t near[kSize];  // a bit for each walker
  const std::size_t n = (partners.count + kLanes - 1) / kLanes * kLanes;
  for (std::size_t k = partners.count; k < n; ++k) partners.place[k] = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint32_t place = partners.place[k];
    x[k] = columns.x[place];
    y[k] = columns.y[place];
    z[k] = columns.z[place];
    radius[k] = columns.radius[place];
    near[k] = 0;
  }
  for (std::size_t w = 0; w < walkers.count; ++w) {
    const float wx = walkers.x[w], wy = walkers.y[w], wz = walkers.z[w], reach = walkers.reach[w];
    const std::uint32_t bit = 1u << w;
    for (std::size_t k = 0; k < n; ++k) {
      const float dx = wx - x[k], dy = wy - y[k], dz = wz - z[k], sum = reach + radius[k];
      near[k] |= dx * dx + dy * dy + dz * dz > sum * sum ? 0 : bit;
    }
  }
  for (std::size_t k = 0; k < partners.count; ++k) {
    if (near[k] == 0) continue;
    if (candidates.count + core::kClusterSize > Candidates::kSize && !sink.take(candidates)) return false;
    std::size_t c = candidates.count;
    for (std::uint32_t left = near[k]; left != 0; left &= left - 1) {
      candidates.walker[c] = walkers.place[static_cast<std::size_t>(std::countr_zero(left))];
      candidates.partner[c] = partners.place[k];
      ++c;
    }
    candidates.count = c;
  }
  partners.count = 0;
  return true;
}

inline bool walkImpl(const core::Walker& walker, const Columns& columns, const core::Cluster& cluster,
                     Candidates& candidates, CandidateSink& sink) {
  if (!core::clusterMeets(walker, cluster)) return true;
  Walkers walkers;
  makeWalkers(walker, cluster, walkers);
  if (walkers.count == 0) return true;
  const float r = walkers.largest_reach;
  const Vec3f lo = walkers.lo - Vec3f{r, r, r}, hi = walkers.hi + Vec3f{r, r, r};
  Partners partners;
  const core::GridView& grid = walker.grid;
  const auto visit = [&](std::uint32_t at, std::uint32_t count) {
    const std::uint32_t end = at + count;
    while ((at = addRun(columns, walkers, at, end, partners)) < end) {
      if (!testPartners(columns, walkers, partners, candidates, sink)) return false;
    }
    return true;
  };
  for (int l = core::firstLevel(walker, cluster); l < grid.level_count; ++l) {
    const core::Level& level = grid.levels[l];
    core::CellBox box;
    if (level.count == 0 || !core::blockBox(grid, level, walker.search, lo, hi, box)) continue;
    std::uint64_t blocks = 1;
    for (int axis = 0; axis < 3; ++axis) blocks *= box.hi[axis] - box.lo[axis] + 1;
    if (blocks >= level.blocks) {  // all of them, then
      if (!visit(level.first, level.count)) return false;
      continue;
    }
    for (std::uint32_t z = box.lo[2]; z <= box.hi[2]; ++z) {
      for (std::uint32_t y = box.lo[1]; y <= box.hi[1]; ++y) {
        for (std::uint32_t x = box.lo[0]; x <= box.hi[0]; ++x) {
          const core::Block block = core::findBlock(grid, core::blockKey(l, x, y, z));
          if (block.count != 0 && !visit(block.first, block.count)) return false;
        }
      }
    }
  }
  return testPartners(columns, walkers, partners, candidates, sink);
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
#define INNERSPHERE_KERNELS(name, attributes)                                                                \
  struct name {                                                                                              \
    attributes static bool walk(const core::Walker& walker, const Columns& columns,                          \
                                const core::Cluster& cluster, Candidates& candidates, CandidateSink& sink) { \
      return walkImpl(walker, columns, cluster, candidates, sink);                                           \
    }                                                                                                        \
    attributes static void sumAll(const core::Setup& setup, bool from_a, const Candidates& candidates,       \
                                  Tally& tally) {                                                            \
      sumImpl<true>(setup, from_a, candidates, tally);                                                       \
    }                                                                                                        \
    attributes static void sumVolumes(const core::Setup& setup, bool from_a, const Candidates& candidates,   \
                                      Tally& tally) {                                                        \
      sumImpl<false>(setup, from_a, candidates, tally);                                                      \
    }                                                                                                        \
    attributes static void evaluate(const core::Setup& setup, std::size_t count, PairValues& pairs) {        \
      evaluateImpl(setup, count, pairs);                                                                     \
    }                                                                                                        \
    static constexpr CpuKernels kKernels{walk, sumAll, sumVolumes, evaluate};                                \
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
