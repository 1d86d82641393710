#include "packer/cell_volumes.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include "packer/clearance_cache.hpp"
#include "packer/jitter.hpp"
#include "packer/near_balls.hpp"

namespace innersphere {
namespace {

// Samples in the gaps for each sphere, on average.
constexpr double kGapSamples = 16;

// A block is the smallest cube that is looked at as a whole: 4 x 4 x 4 samples.
constexpr int kSampleBlock = 4;

// With more balls than this the nearest one takes longer to find than the side of the surface.
constexpr std::size_t kManyBalls = 8;

using Index = std::array<std::uint32_t, 3>;

// The samples are dealt into two halves, whose difference tells the sampling error.
using Counts = std::vector<std::array<std::atomic<std::uint32_t>, 2>>;

/// Samples the unit cube, descending to the blocks that are partly gap.
class Sampler {
 public:
  Sampler(const Container& container, double spacing, Counts& counts)
      : container_(container), spacing_(spacing), counts_(counts) {}

  /// The cube of `lattice` points along an edge, the first of which is `at`. Of a cube that holds this one
  /// `around` are the balls that can be nearest in it, and `above` is what is known of its centre.
  void descend(const Index& at, std::uint32_t lattice, bool inside, const NearBalls& around,
               const ClearanceCache::Entry& above) const {
    const double half = lattice * spacing_ / 2;
    const Point centre = Point(at[0], at[1], at[2]) * spacing_ + Point::Constant(half);
    ClearanceCache::Entry here{centre, 0};
    if (!inside) {
      // How far the surface is beyond the cube counts only where it has to tell the side.
      const double reach = std::numbers::sqrt3 * half;
      const bool known = above.clearance(centre) > container_.margin();
      const Container::Nearest wall =
          container_.closest(centre, known ? reach : std::numeric_limits<double>::infinity());
      const bool within = known ? above.distance > 0 : container_.contains(centre, wall);
      if (wall.distance > reach) {
        if (!within) return;
        inside = true;
      } else {
        here.distance = within ? wall.distance : -wall.distance;
      }
    }
    const NearBalls balls(around, centre, half);
    if (balls.insideOne()) return;
    if (lattice == kSampleBlock) {
      ClearanceCache clearances(container_.margin());
      if (!inside) clearances.add(centre, here.distance);
      sampleBlock(at, half, inside, balls, clearances);
      return;
    }
    const std::uint32_t step = lattice / 2;
    const auto visit = [&](std::uint32_t octant) {
      descend({at[0] + (octant & 1) * step, at[1] + (octant >> 1 & 1) * step, at[2] + (octant >> 2) * step},
              step, inside, balls, here);
    };
    if (half >= kSharedHalf) {
      tbb::parallel_for(0u, 8u, visit);
    } else {
      for (std::uint32_t octant = 0; octant < 8; ++octant) visit(octant);
    }
  }

 private:
  void sampleBlock(const Index& block, double half, bool inside, const NearBalls& balls,
                   ClearanceCache& clearances) const {
    const bool many = balls.size() > kManyBalls;
    for (std::uint32_t k = 0; k < kSampleBlock * kSampleBlock * kSampleBlock; ++k) {
      const Index at{block[0] + k % kSampleBlock, block[1] + k / kSampleBlock % kSampleBlock,
                     block[2] + k / (kSampleBlock * kSampleBlock)};
      const Point x = Point(at[0] + jitter(at, 0), at[1] + jitter(at, 1), at[2] + jitter(at, 2)) * spacing_;
      const auto isOutside = [&] { return !inside && !clearances.contains(container_, x, half); };
      if (many && isOutside()) continue;
      const NearBalls::Nearest hit = balls.nearest(x);
      if (hit.distance <= 0 || (!many && isOutside())) continue;
      counts_[hit.index][(at[0] + at[1] + at[2]) % 2].fetch_add(1, std::memory_order_relaxed);
    }
  }

  const Container& container_;
  const double spacing_;
  Counts& counts_;
};

}  // namespace

CellVolumes findCellVolumes(const Container& container, std::span<const Ball> balls, double volume) {
  const auto count = static_cast<double>(balls.size());
  double filled = 0;
  for (const Ball& ball : balls) filled += ball.volume();
  // Where the spheres fill nearly everything there is no use in a finer lattice.
  const double gaps = std::max(volume - filled, 1e-2 * volume);
  const double spacing = std::cbrt(gaps / (kGapSamples * count));
  // The lattice covers the unit cube with a power of two of blocks along an edge.
  std::uint32_t lattice = kSampleBlock;
  while (lattice * spacing < 1) lattice *= 2;
  Counts counts(balls.size());
  Sampler(container, spacing, counts)
      .descend({0, 0, 0}, lattice, false, NearBalls(balls), {Point::Zero(), 0});

  double sum = 0, difference = 0;
  for (const auto& c : counts) {
    const double a = c[0], b = c[1];
    sum += a + b;
    difference += (a - b) * (a - b);
  }
  const double each = sum > 0 ? std::max(0.0, volume - filled) / sum : 0;
  // All cells together are the solid, whatever the rounding.
  const double scale = volume / (filled + each * sum);
  CellVolumes cells;
  cells.sampling_error = std::sqrt(difference / count) * each / (volume / count);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const double cell = balls[i].volume() + each * (counts[i][0] + counts[i][1]);
    cells.volumes.push_back(scale * cell);
  }
  return cells;
}

}  // namespace innersphere
