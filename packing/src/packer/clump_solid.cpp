#include "innersphere/clump_solid.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "common/task_arena.hpp"
#include "innersphere/error.hpp"
#include "packer/container.hpp"
#include "packer/pattern_search.hpp"
#include "packer/reporter.hpp"
#include "packer/surface_solid.hpp"
#include "packer/union_lattice.hpp"
#include "packer/union_measures.hpp"

namespace innersphere {
namespace {

constexpr std::size_t kMostSpheres = 1000;
constexpr double kMostWeight = 100;

// Cells in the solid: for each sphere, and in all at least. With four times as many the bunny is filled as
// well.
constexpr double kCellsPerSphere = 250;
constexpr double kLeastCells = 100000;

// Cells across a wall.
constexpr double kCellsAcross = 4;

// Places where a sphere may start: for each sphere, and in all at least.
constexpr double kPlacesPerSphere = 16;
constexpr double kLeastPlaces = 1000;

// Of places where the union wins at least this part of the most, that counts which is farthest from other
// spheres: they are to be all over a solid that is as thick everywhere.
constexpr double kAlike = 0.9;

// The most rounds in which spheres move. They end when one wins less than this part of the solid.
constexpr int kRounds = 50;
constexpr double kLeastWin = 1e-4;

// First steps of a search relative to the radius, of a new sphere and of one that had been moved; and the
// last ones relative to a cell.
constexpr double kFirstStep = 0.25;
constexpr double kNextStep = 0.1;
constexpr double kFinestStep = 0.02;

/// Seeks the balls of a clump.
class ClumpSearch {
 public:
  ClumpSearch(UnionLattice& lattice, std::function<void(double)> report)
      : lattice_(lattice), report_(std::move(report)) {}

  /// Places as many balls, fewer if there is nothing more to win. Each starts as the ball in the solid by
  /// which the union wins most.
  void place(std::size_t count) {
    std::vector<Ball> places =
        lattice_.innerBalls(std::max(kPlacesPerSphere * static_cast<double>(count), kLeastPlaces));
    std::vector<double> gains(places.size(), 0), gaps(places.size(), 2);  // wider than the unit cube
    while (balls_.size() < count && !places.empty()) {
      report_(static_cast<double>(balls_.size()) / static_cast<double>(2 * count));
      tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t k) {
        const Ball& last = balls_.empty() ? places[k] : balls_.back();
        const double gap = last.distance(places[k].centre);
        if (gap < places[k].radius) gains[k] = lattice_.gain(places[k]);
        if (!balls_.empty()) gaps[k] = std::min(gaps[k], gap);
      });
      const double enough = kAlike * *std::max_element(gains.begin(), gains.end());
      std::size_t best = 0;
      double gap = -std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < places.size(); ++k) {
        if (gains[k] >= enough && gaps[k] > gap) gap = gaps[k], best = k;
      }
      Ball ball = places[best];
      if (!(fit(ball, kFirstStep * ball.radius) > 0)) return;
      lattice_.add(ball);
      balls_.push_back(ball);
    }
  }

  /// Lets each in turn move and change its size, as long as the union wins by it.
  void improve(double least) {
    const auto all = static_cast<double>(balls_.size());
    double won = std::numeric_limits<double>::infinity();
    for (int round = 0; round < kRounds && won > least; ++round) {
      won = 0;
      for (std::size_t i = 0; i < balls_.size(); ++i) {
        report_(0.5 + (round + static_cast<double>(i) / all) / (2 * kRounds));
        Ball& ball = balls_[i];
        lattice_.remove(ball);
        const double before = lattice_.gain(ball);
        won += fit(ball, std::max(kNextStep * ball.radius, lattice_.spacing() / 2)) - before;
        lattice_.add(ball);
      }
    }
  }

  const std::vector<Ball>& balls() const { return balls_; }

 private:
  /// Takes the best of all ways to move a ball by a step, and to change its radius by as much, as long as
  /// that is better; then steps are halved. Returns what the union wins by the ball.
  double fit(Ball& ball, double step) const {
    double best = lattice_.gain(ball);
    while (step > kFinestStep * lattice_.spacing()) {
      std::array<Ball, 45> tried;
      std::array<double, 45> gains;
      for (std::size_t i = 0; i < tried.size(); ++i) {
        const std::size_t way = i / 3;
        tried[i] = ball;
        if (way > 0) tried[i].centre += step * ways_[way - 1];
        tried[i].radius += step * (static_cast<double>(i % 3) - 1);
      }
      tbb::parallel_for(std::size_t{0}, tried.size(),
                        [&](std::size_t i) { gains[i] = tried[i].radius > 0 ? lattice_.gain(tried[i]) : 0; });
      const auto most = std::max_element(gains.begin(), gains.end());
      if (*most > best) {
        best = *most;
        ball = tried[static_cast<std::size_t>(most - gains.begin())];
      } else {
        step /= 2;
      }
    }
    return best;
  }

  UnionLattice& lattice_;
  const std::function<void(double)> report_;
  const std::array<Point, 14> ways_ = patternDirections();
  std::vector<Ball> balls_;
};

/// Returns how large cells are to be, in units of the cube.
double spacingFor(const Container& container, double volume, std::size_t spheres) {
  const double cells = std::max(kCellsPerSphere * static_cast<double>(spheres), kLeastCells);
  const Mesh mesh = container.solid().surface();
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3d& a = mesh.vertices[t[0]];
    area += norm(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a)) / 2;
  }
  const double even = std::cbrt(volume / cells);
  if (!(area > 0)) return even;
  const double thickness = 2 * volume * container.side() * container.side() / area;
  return std::min(even, thickness / kCellsAcross);
}

void checkOptions(const ClumpOptions& options) {
  const auto require = [](bool holds, const std::string& text) {
    if (!holds) throw Error(ErrorCode::bad_argument, text);
  };
  require(options.spheres >= 1 && options.spheres <= kMostSpheres,
          "a clump has 1 to " + std::to_string(kMostSpheres) + " spheres, not " +
              std::to_string(options.spheres));
  require(options.outside_weight >= 1 && options.outside_weight <= kMostWeight,
          "outside_weight must lie between 1 and 100");
  require(options.threads >= 0, "threads must be 0 or more");
}

std::string commandLine(const ClumpOptions& options) {
  std::string line = "--clump --spheres " + std::to_string(options.spheres);
  if (options.outside_weight == 1) return line;
  char digits[32];  // as few as give the same number back
  return line.append(" --outside-weight ")
      .append(digits, std::to_chars(digits, digits + sizeof digits, options.outside_weight).ptr);
}

}  // namespace

Covering clumpSolid(const Solid& solid, const ClumpOptions& options, const Progress& progress) {
  checkOptions(options);
  const Reporter reporter(progress, "the clump of '" + solid.name() + "'");
  const auto report = [&](double fraction) { reporter("clump", fraction); };
  report(0);
  const Container container(solid, &reporter);
  const double volume = solid.massProperties().volume / std::pow(container.side(), 3);
  if (!(volume > 0))
    throw Error(ErrorCode::bad_argument, "the solid's mass properties must have a volume greater than 0");

  Covering clump;
  clump.kind = CoveringKind::clump;
  clump.origin = container.origin();
  tbb::task_arena arena(arenaThreads(options.threads));
  arena.execute([&] {
    UnionLattice lattice(container, spacingFor(container, volume, options.spheres), options.outside_weight);
    ClumpSearch search(lattice, report);
    search.place(options.spheres);
    search.improve(kLeastWin * volume / std::pow(lattice.spacing(), 3));
    std::vector<Ball> balls = search.balls();
    if (balls.empty()) {
      throw Error(ErrorCode::no_sphere_fits,
                  "'" + solid.name() +
                      "' is too thin for a clump: no sphere of it would be more inside than outside");
    }
    for (Ball& ball : balls) {
      ball = container.rounded(ball);
      clump.spheres.push_back(container.toSphere(ball));
    }
    measureUnion(container, balls, clump);
  });
  clump.provenance = {solid.name(), solid.hash(), commandLine(options), INNERSPHERE_VERSION};
  report(1);
  return clump;
}

Covering clumpSurface(const Packing& packing, const ClumpOptions& options, const Progress& progress) {
  return clumpSolid(*solidOf(packing), options, progress);
}

}  // namespace innersphere
