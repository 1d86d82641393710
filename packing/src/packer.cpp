#include "innersphere/packer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>

#include "innersphere/error.hpp"
#include "packer/container.hpp"
#include "packer/rounds.hpp"

namespace innersphere {
namespace {

constexpr double kBallVolume = 4.0 / 3.0 * std::numbers::pi;

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

}  // namespace

Packing pack(const Solid& solid, const PackOptions& options, const Progress& progress) {
  checkOptions(options);
  const Container container(solid);
  Packing packing;
  packing.solid = solid.massProperties();
  packing.surface = solid.surface();
  packing.provenance = {solid.name(), solid.hash(), commandLine(options), INNERSPHERE_VERSION};

  const double smallest = options.min_radius > 0 ? options.min_radius : 1e-4 * diagonal(solid.bounds());
  const double volume = packing.solid.volume / std::pow(container.side(), 3);
  double filled = 0;
  Rounds rounds(container, options, smallest / container.side());
  const Rounds::Placed placed = rounds.run(
      [&](const Rounds::Placed& now) {
        filled += kBallVolume * std::pow(now.balls.back().radius, 3);
        return (options.spheres > 0 && now.balls.size() == options.spheres) ||
               (options.density > 0 && filled >= options.density * volume);
      },
      [&](const Rounds::Placed& now, float) {
        const double fraction = options.spheres > 0 ? double(now.balls.size()) / double(options.spheres) : 0;
        if (progress && !progress("packing", fraction))
          throw Error(ErrorCode::cancelled, "packing was cancelled");
        return false;
      });
  if (placed.balls.empty())
    throw Error(ErrorCode::no_sphere_fits, "no sphere fits into '" + solid.name() + "'");
  std::vector<std::size_t> order(placed.balls.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return placed.balls[a].radius > placed.balls[b].radius;
  });
  for (std::size_t i : order) packing.spheres.push_back(container.toSphere(placed.balls[i]));
  packing.certificate = {options.delta, placed.largest_missing * container.side()};
  packing.quality.density = filled / volume;
  return packing;
}

}  // namespace innersphere
