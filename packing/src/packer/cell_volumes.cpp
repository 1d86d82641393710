#include "packer/cell_volumes.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>

#include "packer/clearance_cache.hpp"
#include "packer/jitter.hpp"

namespace innersphere {
namespace {

// Samples in the gaps for each sphere, on average.
constexpr double kGapSamples = 16;

// A block is the smallest cube that is looked at as a whole: 4 x 4 x 4 samples.
constexpr int kSampleBlock = 4;

// The samples are dealt into two halves, whose difference tells the sampling error.
using Counts = std::vector<std::array<std::atomic<std::uint32_t>, 2>>;

/// Samples one cube of the unit cube, descending to the blocks that are partly gap.
class Sampler {
 public:
  Sampler(const Container& container, const SphereGrid& grid, double spacing, double reach, Counts& counts)
      : container_(container),
        grid_(grid),
        spacing_(spacing),
        reach_(reach),
        counts_(counts),
        clearances_(container.margin()) {}

  /// The cube of `lattice` points along an edge, the first of which is `at`.
  void descend(const std::array<std::uint32_t, 3>& at, std::uint32_t lattice, bool inside) {
    const double half = lattice * spacing_ / 2;
    const Point centre = Point(at[0], at[1], at[2]) * spacing_ + Point::Constant(half);
    if (grid_.nearest(centre, 0).distance <= -std::numbers::sqrt3 * half) return;
    if (!inside) {
      const double distance = container_.closest(centre, 1.01 * std::numbers::sqrt3 * half).distance;
      if (distance > std::numbers::sqrt3 * half) {
        if (!container_.contains(centre)) return;
        inside = true;
      }
    }
    if (lattice == kSampleBlock) {
      sampleBlock(at, centre, half, inside);
      return;
    }
    const std::uint32_t step = lattice / 2;
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      descend({at[0] + (octant & 1) * step, at[1] + (octant >> 1 & 1) * step, at[2] + (octant >> 2) * step},
              step, inside);
    }
  }

 private:
  void gather(const Point& centre, double half) {
    near_.clear();
    grid_.visitNear(
        centre - Point::Constant(half), centre + Point::Constant(half), reach_, [&](std::uint32_t i) {
          const double away =
              ((centre - grid_.balls()[i].centre).cwiseAbs() - Point::Constant(half)).cwiseMax(0.0).norm();
          if (away - grid_.balls()[i].radius < reach_) near_.push_back(i);
        });
  }

  SphereGrid::Nearest nearest(const Point& x) const {
    SphereGrid::Nearest best;
    for (std::uint32_t i : near_) {
      const Ball& ball = grid_.balls()[i];
      const double reach = best.distance + ball.radius;
      const double squared = (x - ball.centre).squaredNorm();
      if (reach > 0 && squared < reach * reach) best = {std::sqrt(squared) - ball.radius, i};
    }
    return best;
  }

  void sampleBlock(const std::array<std::uint32_t, 3>& block, const Point& centre, double half, bool inside) {
    gather(centre, half);
    clearances_ = ClearanceCache(container_.margin());
    for (std::uint32_t k = 0; k < kSampleBlock * kSampleBlock * kSampleBlock; ++k) {
      const std::array<std::uint32_t, 3> at{block[0] + k % kSampleBlock,
                                            block[1] + k / kSampleBlock % kSampleBlock,
                                            block[2] + k / (kSampleBlock * kSampleBlock)};
      const Point x = Point(at[0] + jitter(at, 0), at[1] + jitter(at, 1), at[2] + jitter(at, 2)) * spacing_;
      SphereGrid::Nearest hit = nearest(x);
      if (hit.distance <= 0 || (!inside && !clearances_.contains(container_, x, half))) continue;
      if (!(hit.distance < reach_)) hit = grid_.nearestOfAll(x, 2 * reach_);
      counts_[hit.index][(at[0] + at[1] + at[2]) % 2].fetch_add(1, std::memory_order_relaxed);
    }
  }

  const Container& container_;
  const SphereGrid& grid_;
  const double spacing_;
  const double reach_;
  Counts& counts_;
  std::vector<std::uint32_t> near_;
  ClearanceCache clearances_;
};

void sample(const Container& container, const SphereGrid& grid, double spacing, double reach,
            Counts& counts) {
  // The lattice covers the unit cube with a power of two of blocks along an edge; enough tasks for any
  // machine.
  std::uint32_t lattice = kSampleBlock;
  while (lattice * spacing < 1) lattice *= 2;
  const std::uint32_t tasks = std::min<std::uint32_t>(8, lattice / kSampleBlock);
  tbb::parallel_for(0u, tasks * tasks * tasks, [&](std::uint32_t task) {
    const std::uint32_t size = lattice / tasks;
    Sampler(container, grid, spacing, reach, counts)
        .descend({task % tasks * size, task / tasks % tasks * size, task / (tasks * tasks) * size}, size,
                 false);
  });
}

}  // namespace

CellVolumes findCellVolumes(const Container& container, std::span<const Ball> balls, double volume) {
  const auto count = static_cast<double>(balls.size());
  double filled = 0, smallest = 1;
  for (const Ball& ball : balls) {
    filled += ball.volume();
    smallest = std::min(smallest, ball.radius);
  }
  // Where the spheres fill nearly everything there is no use in a finer lattice.
  const double gaps = std::max(volume - filled, 1e-2 * volume);
  Counts counts(balls.size());
  sample(container, SphereGrid(balls), std::cbrt(gaps / (kGapSamples * count)), 2 * smallest, counts);

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
