#include "innersphere/packer.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "common/task_arena.hpp"
#include "innersphere/error.hpp"
#include "mesh/mesh_report.hpp"
#include "packer/ball.hpp"
#include "packer/cell_volumes.hpp"
#include "packer/container.hpp"
#include "packer/cover.hpp"
#include "packer/empty_parts.hpp"
#include "packer/greedy_rounds.hpp"
#include "packer/mass_weights.hpp"
#include "packer/overlap_errors.hpp"
#include "packer/pack_options.hpp"
#include "packer/reporter.hpp"
#include "packer/surface_samples.hpp"
#include "packer/volume_true.hpp"

namespace innersphere {
namespace {

// A solid filled to this fraction counts as full: a ball, after its first sphere.
constexpr double kFull = 1 - 1e-6;

// SphereOrder::coverage leaves no larger gaps than this many of the largest radii that still fit. So far
// apart are surface and largest spheres in solids without thin parts, where it changes little.
constexpr double kCovered = 2.5;

// After so many spheres that cover the surface the user may cancel.
constexpr std::size_t kPause = 256;

// The first prefix with volume-true radii of its own; the next ones double.
constexpr std::size_t kFirstPrefix = 64;

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

}  // namespace

std::string commandLine(const PackOptions& options) {
  std::string line = "--spheres " + std::to_string(options.spheres);
  const auto add = [&](const char* name, double x) {
    char digits[32];  // as few as give the same number back
    line.append(name).append(digits, std::to_chars(digits, digits + sizeof digits, x).ptr);
  };
  if (options.min_radius > 0) add(" --min-radius ", options.min_radius);
  if (options.density > 0) add(" --density ", options.density);
  if (options.gap > 0) add(" --gap ", options.gap);
  add(" --delta ", options.delta);
  if (options.order == SphereOrder::coverage) line += " --order coverage";
  return line;
}

namespace {

/// The solid and the limits in the packer's coordinates.
struct Problem {
  Problem(const Solid& solid, const PackOptions& wishes, const MassProperties& mass, const Mesh& surface,
          const Reporter& reporter)
      : container(solid, &reporter), options(wishes), samples(surface, container) {
    const double side = container.side();
    volume = mass.volume / (side * side * side);
    enough = std::min(options.density > 0 ? options.density : 1.0, kFull) * volume;
    gap = options.gap / side - 2 * container.coarseness();
    const Bounds box = solid.bounds();
    diagonal = norm(box.max - box.min) / side;
    const double asked = options.min_radius > 0 ? options.min_radius / side : 1e-4 * diagonal;
    // Rounding makes a sphere smaller, and gaps larger.
    smallest = std::max((1 + 1e-6) * asked + container.coarseness(), 1e-5);
  }

  Container container;
  const PackOptions& options;
  SurfaceSamples samples;
  double volume, enough, gap, diagonal, smallest;
};

/// Says at once of a sheet or a rod what the search for spheres would find out in minutes. A little less than
/// the smallest radius, because a ball of just the largest radius touches the surface at few points.
void requireThickness(const Problem& problem) {
  const SurfaceSamples& samples = problem.samples;
  if (samples.empty() || samples.touchedByBall(problem.container, 0.9 * problem.smallest)) return;
  throw Error(
      ErrorCode::no_sphere_fits,
      "no sphere of the smallest allowed radius, " + text(problem.smallest * problem.container.side()) +
          " m, fits into '" + problem.container.solid().name() +
          "': it is a sheet or a rod, thinner than that everywhere; make it thicker, or ask for a smaller "
          "min_radius");
}

GreedyRounds::Placed place(const Problem& problem, tbb::task_arena& arena, const Reporter& report) {
  const PackOptions& options = problem.options;
  double filled = 0;
  std::size_t uncovered = 0;
  const auto stop = [&](const GreedyRounds::Placed& now) {
    filled += now.rounded.back().volume();
    return now.top.size() == options.spheres || filled >= problem.enough;
  };
  const auto pause = [&](const GreedyRounds::Placed& now, double bound) {
    // The number of spheres that fit grows with this power of their radius.
    const double by_radius = std::pow(problem.smallest / bound, 2.5);
    const double by_count =
        options.spheres > 0 ? static_cast<double>(now.top.size()) / static_cast<double>(options.spheres) : 0;
    const double by_density = options.density > 0 ? std::pow(filled / problem.enough, 10) : 0;
    report("packing", std::max({by_radius, by_count, by_density}));
    return options.gap > 0 && problem.samples.covered(now.grid, problem.gap, uncovered);
  };
  std::optional<Cover> cover;
  const auto add = [&](GreedyRounds::Placed& now, double bound) {
    if (!cover) cover.emplace(problem.container, problem.samples, now.grid, problem.smallest);
    return cover->upTo(kCovered * bound, [&](const Ball& ball) {
      now.grid.insert(ball);
      now.rounded.push_back(problem.container.rounded(ball));
      now.top.push_back(static_cast<float>(bound));
      return stop(now) || (now.top.size() % kPause == 0 && pause(now, bound));
    });
  };
  const bool covers = options.order == SphereOrder::coverage;
  // A gap is closed, if it can be, by a sphere for each sample.
  std::size_t most =
      options.gap > 0 ? problem.samples.points().size() : std::numeric_limits<std::size_t>::max();
  if (options.spheres > 0) most = options.spheres;
  return GreedyRounds(problem.container, options.delta, problem.smallest, most)
      .run(arena, stop, pause, covers ? add : GreedyRounds::Add());
}

/// The spheres by falling radius, as many as the limits ask for, and what is certain about them.
struct Chosen {
  std::vector<Ball> balls;
  double filled = 0;
  double delta = 0;
  double largest_missing = 0;
};

Chosen choose(const Problem& problem, const GreedyRounds::Placed& placed) {
  std::vector<std::size_t> order(placed.top.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::vector<Ball>& balls = placed.rounded;
  const bool by_radius = problem.options.order == SphereOrder::radius;
  if (by_radius) {
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return balls[a].radius > balls[b].radius; });
  }
  // A sphere's bound holds once everything that was placed before it is there, wherever sorting has put that.
  std::vector<double> top(order.size() + 1, placed.largest_missing);
  for (std::size_t i = order.size(); i-- > 0;) top[i] = std::max<double>(top[i + 1], placed.top[order[i]]);

  Chosen chosen;
  for (std::size_t i : order) chosen.balls.push_back(balls[i]);
  if (problem.options.gap > 0) {
    const SphereGrid grid(chosen.balls);
    if (const auto count = problem.samples.prefixWithin(grid, problem.gap)) chosen.balls.resize(*count);
  }
  std::size_t count = 0;
  while (count < chosen.balls.size() && chosen.filled < problem.enough) {
    if (by_radius) chosen.delta = std::max(chosen.delta, top[count] / chosen.balls[count].radius - 1);
    chosen.filled += chosen.balls[count++].volume();
  }
  chosen.balls.resize(count);
  const double room = std::max(0.0, problem.volume - chosen.filled);
  chosen.largest_missing = std::min(top[count], std::cbrt(room / kBallVolume));
  return chosen;
}

/// The lengths of prefixes of which more is known: 64, 128, ..., all.
std::vector<std::size_t> prefixesOf(std::size_t count) {
  std::vector<std::size_t> prefixes;
  for (std::size_t prefix = kFirstPrefix; prefix < count; prefix *= 2) prefixes.push_back(prefix);
  prefixes.push_back(count);
  return prefixes;
}

/// Adds how well the spheres fill the solid and come near to its surface.
void addQuality(const Problem& problem, const Chosen& chosen, tbb::task_arena& arena, Packing& packing) {
  const double side = problem.container.side();
  arena.execute([&] {
    packing.coverage = problem.samples.coverage(chosen.balls, prefixesOf(chosen.balls.size()),
                                                kCoverageDistance * problem.diagonal);
  });
  for (Coverage& c : packing.coverage) {
    const Point farthest(c.farthest[0], c.farthest[1], c.farthest[2]);
    c.farthest = problem.container.toWorld(farthest) - packing.origin;
    for (double* length : {&c.mean, &c.p95, &c.max}) *length *= side;
  }
  packing.quality.density = chosen.filled / problem.volume;
  if (packing.coverage.empty()) return;
  const Coverage& all = packing.coverage.back();
  packing.quality.gap_mean = all.mean;
  packing.quality.gap_p95 = all.p95;
  packing.quality.gap_max = all.max;
}

/// Says which spheres are left out.
std::string smallestOf(const Problem& problem) {
  return "no sphere has less than the smallest allowed radius, " +
         text(problem.smallest * problem.container.side()) + " m";
}

/// Warns if parts of the surface have no sphere near them, with the number of spheres that would do, or how
/// near those of the smallest radius and more would come.
void warnOfBareSurface(const Problem& problem, const Chosen& chosen, Packing& packing) {
  const std::string bare = bareSurface(packing, chosen.balls.size());
  if (bare.empty()) return;
  const double wanted = kCoverageDistance * problem.diagonal;
  SphereGrid grid(chosen.balls);
  Cover(problem.container, problem.samples, grid, problem.smallest).upTo(wanted, [&](const Ball& ball) {
    grid.insert(ball);
    return false;
  });
  const std::array<std::size_t, 1> all{grid.balls().size()};
  const double nearest = problem.samples.coverage(grid.balls(), all, wanted).back().max;
  if (nearest > (1 + 1e-6) * wanted) {
    packing.warnings.push_back(bare + "; any number of spheres would come within " +
                               text(100 * nearest / problem.diagonal) + " % everywhere and no nearer, as " +
                               smallestOf(problem));
    return;
  }
  packing.warnings.push_back(bare + "; about " + text(static_cast<double>(all[0])) +
                             " in the order of coverage would come within " + text(100 * kCoverageDistance) +
                             " % everywhere");
}

/// Warns if spheres that are small enough to close a gap are not allowed.
void warnOfMissedGap(const Problem& problem, const Chosen& chosen, Packing& packing) {
  const PackOptions& options = problem.options;
  const bool other_limit =
      (options.spheres > 0 && chosen.balls.size() >= options.spheres) || chosen.filled >= problem.enough;
  const double left = packing.quality.gap_max;
  if (options.gap == 0 || other_limit || left <= (1 + 1e-6) * options.gap) return;
  const double part = left / (problem.diagonal * problem.container.side());
  packing.warnings.push_back("the largest distance from the surface to a sphere is " + text(left) + " m, " +
                             text(100 * part) + " % of the diagonal, and not the " + text(options.gap) +
                             " m that were asked for, as " + smallestOf(problem));
}

/// Adds the volume-true radii of all prefixes. Returns the volumes of the cells of all spheres [m^3].
std::vector<double> addVolumeTrueRadii(const Problem& problem, const Chosen& chosen, tbb::task_arena& arena,
                                       const Reporter& report, Packing& packing) {
  const std::size_t count = chosen.balls.size();
  CellVolumes cells;
  for (std::size_t prefix : prefixesOf(count)) {
    report("cell volumes", static_cast<double>(prefix) / static_cast<double>(2 * count));
    const auto balls = std::span(chosen.balls).first(prefix);
    arena.execute([&] {
      cells = findCellVolumes(problem.container, balls, problem.volume);
      packing.volume_true.push_back(volumeTrueRadii(problem.container, balls, cells));
    });
  }
  const double side = problem.container.side();
  for (double& volume : cells.volumes) volume *= side * side * side;
  return std::move(cells.volumes);
}

/// Adds the mass weights, and what a user should know.
void addMassWeights(const std::vector<double>& cell_volumes, const Mesh& surface, Packing& packing) {
  packing.mass_weights = findMassWeights(packing.spheres, cell_volumes, packing.solid);
  const Mat3d& inertia = packing.solid.inertia;
  if (packing.mass_weights.empty() && inertia[0] + inertia[4] + inertia[8] > 0) {
    packing.warnings.push_back(
        "no masses of the spheres give the inertia of the solid; use that of the solid");
  }
  for (std::string& sentence : nameEmptyParts(surface, packing)) {
    packing.warnings.push_back(std::move(sentence));
  }
}

}  // namespace

Packing pack(const Solid& solid, const PackOptions& options, const Progress& progress) {
  checkOptions(options);
  Packing packing;
  packing.solid = solid.massProperties();
  require(packing.solid.volume > 0, "the solid's mass properties must have a volume greater than 0");
  packing.provenance = {solid.name(), solid.hash(), commandLine(options), INNERSPHERE_VERSION};
  const Mesh surface = solid.surface();
  const Reporter report(progress, "packing '" + solid.name() + "'");
  report("packing", 0);
  const Problem problem(solid, options, packing.solid, surface, report);
  require(options.gap == 0 || !problem.samples.empty(),
          "a gap can only be asked for if the solid has a surface");
  require(options.order == SphereOrder::radius || !problem.samples.empty(),
          "spheres can only be ordered by coverage if the solid has a surface");

  requireThickness(problem);
  tbb::task_arena arena(arenaThreads(options.threads));
  const Chosen chosen = choose(problem, place(problem, arena, report));
  if (chosen.balls.empty()) {
    throw Error(ErrorCode::no_sphere_fits, "no sphere of the smallest allowed radius fits into '" +
                                               solid.name() + "'; ask for a smaller min_radius");
  }
  packing.order = options.order;
  packing.origin = problem.container.origin();
  packing.surface = problem.container.toSurface(surface);
  for (const Ball& ball : chosen.balls) packing.spheres.push_back(problem.container.toSphere(ball));
  packing.certificate = {chosen.delta, problem.container.side() * chosen.largest_missing};

  report("quality", 0);
  addQuality(problem, chosen, arena, packing);
  arena.execute([&] {
    warnOfBareSurface(problem, chosen, packing);
    warnOfMissedGap(problem, chosen, packing);
  });
  const std::vector<double> cell_volumes = addVolumeTrueRadii(problem, chosen, arena, report, packing);
  report("measuring", 0);
  if (options.overlap_errors) {
    arena.execute([&] {
      packing.overlap_errors = findOverlapErrors(problem.container, packing.surface, problem.samples,
                                                 chosen.balls, packing.volume_true, problem.volume);
    });
  }
  packing.solid.centre_of_mass = packing.solid.centre_of_mass - packing.origin;
  addMassWeights(cell_volumes, surface, packing);
  report("measuring", 1);
  return packing;
}

}  // namespace innersphere
