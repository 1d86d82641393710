#include "innersphere/packer.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>

#include "innersphere/error.hpp"
#include "packer/container.hpp"
#include "packer/rounds.hpp"
#include "packer/shares.hpp"
#include "packer/surface_samples.hpp"

namespace innersphere {
namespace {

constexpr double kBallVolume = 4.0 / 3.0 * std::numbers::pi;

// A solid filled to this fraction counts as full: a ball, after its first sphere.
constexpr double kFull = 1 - 1e-6;

[[noreturn]] void noSphereFits(const Solid& solid) {
  throw Error(ErrorCode::no_sphere_fits,
              "no sphere of the smallest allowed radius fits into '" + solid.name() + "'; lower min_radius");
}

void require(bool condition, const char* message) {
  if (!condition) throw Error(ErrorCode::bad_argument, message);
}

void checkOptions(const PackOptions& options) {
  require(std::isfinite(options.min_radius) && options.min_radius >= 0,
          "min_radius must be a length of 0 or more");
  require(options.density >= 0 && options.density <= 1, "density must lie between 0 and 1");
  require(std::isfinite(options.gap) && options.gap >= 0, "gap must be a length of 0 or more");
  require(options.delta >= 0.001 && options.delta <= 1, "delta must lie between 0.001 and 1");
  require(options.threads >= 0, "threads must be 0 or more");
}

std::string commandLine(const PackOptions& options) {
  std::ostringstream line;
  line << "--spheres " << options.spheres;
  if (options.min_radius > 0) line << " --min-radius " << options.min_radius;
  if (options.density > 0) line << " --density " << options.density;
  if (options.gap > 0) line << " --gap " << options.gap;
  line << " --delta " << options.delta;
  return line.str();
}

double diagonal(const Bounds& box) {
  return std::hypot(box.max[0] - box.min[0], box.max[1] - box.min[1], box.max[2] - box.min[2]);
}

double volumeOf(const Ball& ball) {
  return kBallVolume * std::pow(ball.radius, 3);
}

/// The spheres of a packing in the making, sorted by falling radius.
struct Sorted {
  std::vector<Ball> balls;
  std::vector<float> top;  ///< for each: nothing larger was possible after those before it
};

Sorted sortByRadius(const Rounds::Placed& placed) {
  std::vector<std::size_t> order(placed.top.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::vector<Ball>& balls = placed.grid.balls();
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return balls[a].radius > balls[b].radius; });
  Sorted sorted;
  for (std::size_t i : order) {
    sorted.balls.push_back(balls[i]);
    sorted.top.push_back(placed.top[i]);
  }
  // A bound holds once everything that was placed before it is there, wherever sorting has put that.
  for (std::size_t i = sorted.top.size(); i-- > 1;)
    sorted.top[i - 1] = std::max(sorted.top[i - 1], sorted.top[i]);
  return sorted;
}

/// The first spheres that fill a fraction of the volume, or all.
std::size_t prefixFilling(const std::vector<Ball>& balls, double volume) {
  double filled = 0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    filled += volumeOf(balls[i]);
    if (filled >= volume) return i + 1;
  }
  return balls.size();
}

}  // namespace

Packing pack(const Solid& solid, const PackOptions& options, const Progress& progress) {
  checkOptions(options);
  const Container container(solid);
  Packing packing;
  packing.solid = solid.massProperties();
  require(packing.solid.volume > 0, "the solid's mass properties must have a volume greater than 0");
  packing.surface = solid.surface();
  packing.provenance = {solid.name(), solid.hash(), commandLine(options), INNERSPHERE_VERSION};
  const SurfaceSamples samples(packing.surface, container);
  require(options.gap == 0 || !samples.empty(), "a gap can only be asked for if the solid has a surface");

  const double side = container.side();
  const double volume = packing.solid.volume / (side * side * side);
  const double gap = options.gap / side;
  // Below this, single precision could not hold a centre.
  const double smallest =
      std::max((options.min_radius > 0 ? options.min_radius : 1e-4 * diagonal(solid.bounds())) / side +
                   container.coarseness(),
               4 * container.coarseness());
  const double enough = std::min(options.density > 0 ? options.density : 1.0, kFull) * volume;
  const auto report = [&](const char* stage, double fraction) {
    if (progress && !progress(stage, std::clamp(fraction, 0.0, 1.0))) {
      throw Error(ErrorCode::cancelled, "packing '" + solid.name() + "' was cancelled");
    }
  };

  tbb::task_arena arena(options.threads > 0 ? options.threads : static_cast<int>(tbb::task_arena::automatic));
  double filled = 0;
  std::size_t uncovered = 0;
  const auto stop = [&](const Rounds::Placed& now) {
    filled += volumeOf(now.grid.balls().back());
    return now.top.size() == options.spheres || filled >= enough;
  };
  const auto pause = [&](const Rounds::Placed& now, float threshold) {
    const double count = static_cast<double>(now.top.size());
    const double by_count = options.spheres > 0 ? count / static_cast<double>(options.spheres) : 0;
    const double by_radius = std::pow(smallest / threshold, 2.5);  // the number of spheres grows like this
    report("packing",
           std::max({by_count, by_radius, options.density > 0 ? std::pow(filled / enough, 10) : 0}));
    return gap > 0 && samples.covered(now.grid, gap, uncovered);
  };
  if (smallest >= 0.5) noSphereFits(solid);
  const Rounds::Placed placed = Rounds(container, options.delta, smallest).run(arena, stop, pause);
  if (placed.top.empty()) noSphereFits(solid);

  Sorted sorted = sortByRadius(placed);
  std::size_t count = prefixFilling(sorted.balls, enough);
  if (gap > 0) count = std::min(count, samples.prefixWithin(SphereGrid(sorted.balls), gap).value_or(count));
  const double missing = count < sorted.balls.size() ? sorted.top[count] : placed.largest_missing;
  sorted.balls.resize(count);

  filled = 0;
  packing.certificate.delta = 0;
  for (std::size_t i = 0; i < count; ++i) {
    packing.spheres.push_back(container.toSphere(sorted.balls[i]));
    packing.certificate.delta =
        std::max(packing.certificate.delta, sorted.top[i] / sorted.balls[i].radius - 1);
    filled += volumeOf(sorted.balls[i]);
  }
  // Nothing larger than the space that is left.
  packing.certificate.largest_missing_radius =
      side * std::min(missing, std::cbrt(std::max(0.0, volume - filled) / kBallVolume));

  const SphereGrid grid(sorted.balls);
  report("quality", 0);
  arena.execute([&] { packing.quality = samples.measure(grid); });
  packing.quality.density = filled / volume;
  for (double* length : {&packing.quality.gap_mean, &packing.quality.gap_p95, &packing.quality.gap_max})
    *length *= side;

  for (std::size_t prefix = 64;; prefix *= 2) {
    prefix = std::min(prefix, count);
    report("shares", static_cast<double>(prefix) / static_cast<double>(count) / 2);
    arena.execute([&] {
      packing.volume_true.push_back(
          findVolumeTrueRadii(container, std::span(sorted.balls).first(prefix), volume));
    });
    if (prefix == count) break;
  }
  report("shares", 1);
  return packing;
}

}  // namespace innersphere
