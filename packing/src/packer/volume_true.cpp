#include "packer/volume_true.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "common/steady_math.hpp"
#include "packer/ball.hpp"

namespace innersphere {
namespace {

// Balls with the volumes of their cells fill a solid right in the mean, but not at its surface: a cell
// reaches to the surface, and the ball in its place does not. Down to about one smallest radius s below the
// surface too little is filled, from 1.5 s to 4 s too much. So shallow overlaps come out too small. The same
// profile is found on all solids and for all numbers of spheres, in units of s. Radii with their centres near
// the surface grow by this much, falling off within kNear s of depth, ...
constexpr double kGrowth = 0.12;
constexpr double kNear = 0.35;
// ... and what that adds is taken from the spheres down to about kFar s.
constexpr double kFar = 4;

}  // namespace

VolumeTrueRadii volumeTrueRadii(const Container& container, std::span<const Ball> balls,
                                const CellVolumes& cells) {
  double smallest = 1, volume = 0;
  for (const Ball& ball : balls) smallest = std::min(smallest, ball.radius);
  for (double cell : cells.volumes) volume += cell;
  // How far the centres are deeper than that of a smallest sphere that touches the surface, in units of s.
  std::vector<double> depth(balls.size());
  const double cutoff = 5 * kFar * smallest;
  tbb::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t i) {
    const double distance = std::min(container.closest(balls[i].centre, cutoff).distance, cutoff);
    depth[i] = std::max(0.0, distance / smallest - 1);
  });

  std::vector<double> gain(balls.size()), share(balls.size()), equal(balls.size()), radii(balls.size());
  for (std::size_t i = 0; i < balls.size(); ++i) {
    gain[i] = 1 + kGrowth * steady::exp(-depth[i] / kNear);
    share[i] = steady::exp(-depth[i] / kFar);
    equal[i] = std::cbrt(cells.volumes[i] / kBallVolume);
  }
  const auto adjust = [&](double loss) {
    double sum = 0;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      // No sphere stands for less than itself.
      radii[i] = std::max(balls[i].radius, (gain[i] - loss * share[i]) * equal[i]);
      sum += kBallVolume * radii[i] * radii[i] * radii[i];
    }
    return sum;
  };
  // The loss that keeps the volume; rounding and spheres that cannot lose leave a rest for all.
  double low = 0, high = kGrowth;
  for (int step = 0; step < 30; ++step) {
    const double middle = (low + high) / 2;
    (adjust(middle) > volume ? low : high) = middle;
  }
  const double rest = std::cbrt(volume / adjust(high));

  VolumeTrueRadii result;
  result.count = static_cast<std::uint32_t>(balls.size());
  result.sampling_error = cells.sampling_error;
  for (double r : radii) result.radii.push_back(static_cast<float>(rest * r * container.side()));
  return result;
}

}  // namespace innersphere
