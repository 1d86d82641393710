#include "innersphere/cover_solid.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "common/bounds.hpp"
#include "common/task_arena.hpp"
#include "innersphere/error.hpp"
#include "packer/container.hpp"
#include "packer/near_balls.hpp"
#include "packer/pattern_search.hpp"
#include "packer/reporter.hpp"
#include "packer/surface_samples.hpp"
#include "packer/surface_solid.hpp"
#include "packer/union_measures.hpp"

namespace innersphere {
namespace {

// Points in the solid for each sphere, and in all at least.
constexpr double kInnerPoints = 64;
constexpr double kLeastInnerPoints = 4096;

// The most steps in which spheres fit themselves to the points around them. They win little after ten.
constexpr int kSteps = 30;

// A pattern search ends when its steps are this small a part of the radius, and takes those that win at least
// this part of their length.
constexpr double kFinestFit = 0.01;
constexpr double kWorthwhile = 0.01;

/// A cube of the octree.
struct OctreeCube {
  Point centre;
  double half;
  double farthest(const Ball& ball) const {
    return ((centre - ball.centre).array().abs() + half).matrix().norm() - ball.radius;
  }
  double nearest(const Ball& ball) const {
    return ((centre - ball.centre).array().abs() - half).max(0.0).matrix().norm() - ball.radius;
  }
};

// Points along the edge of blocks of a lattice that are looked at one by one.
constexpr int kBlock = 8;

/// Adds the points of a part of a lattice that lie in the solid, and looks at no block that is clear of it: a
/// slender solid is in few blocks.
void addInnerPoints(const Container& container, int cells, const Eigen::Array3i& from,
                    const Eigen::Array3i& to, std::vector<Point>& points) {
  const Eigen::Array3i size = to - from;
  if (size.maxCoeff() > kBlock) {
    const Point half = 0.5 * size.cast<double>().matrix() / cells;
    const Point middle = from.cast<double>().matrix() / cells + half;
    if (std::isinf(container.closest(middle, half.norm() + container.margin()).distance) &&
        !container.contains(middle))
      return;
    int longest = 0;
    size.maxCoeff(&longest);
    Eigen::Array3i cut_to = to, cut_from = from;
    cut_to[longest] = cut_from[longest] = from[longest] + size[longest] / 2;
    addInnerPoints(container, cells, from, cut_to, points);
    addInnerPoints(container, cells, cut_from, to, points);
    return;
  }
  for (int z = from[2]; z < to[2]; ++z) {
    for (int y = from[1]; y < to[1]; ++y) {
      for (int x = from[0]; x < to[0]; ++x) {
        const Point p = Point(x + 0.5, y + 0.5, z + 0.5) / cells;
        if (container.contains(p)) points.push_back(p);
      }
    }
  }
}

/// Points of the surface and of the inside.
std::vector<Point> pointsOf(const Solid& solid, const Container& container, std::size_t spheres) {
  std::vector<Point> points = SurfaceSamples(solid.surface(), container).points();
  const double volume =
      solid.massProperties().volume / (container.side() * container.side() * container.side());
  const double inner = std::max(kInnerPoints * static_cast<double>(spheres), kLeastInnerPoints);
  const int cells = static_cast<int>(std::ceil(std::cbrt(inner / volume)));
  addInnerPoints(container, cells, Eigen::Array3i::Zero(), Eigen::Array3i::Constant(cells), points);
  return points;
}

/// A ball in the solid that touches its surface, and by how much it has to grow to hold some points.
struct Fit {
  Ball ball;
  double growth = 0;
};

/// Looks for the place from which the largest ball in the solid has to grow least until it holds the points.
Fit fitted(const Container& container, const Ball& start, const std::vector<Point>& points) {
  const auto fitAt = [&](const Point& x) -> Fit {
    double farthest = 0;
    for (const Point& p : points) farthest = std::max(farthest, (p - x).squaredNorm());
    const double room = container.closest(x, 1).distance;
    return {{x, room}, std::sqrt(farthest) - room};
  };
  Fit best = fitAt(start.centre);
  for (double step = (best.ball.radius + best.growth) / 4;
       step > kFinestFit * (best.ball.radius + best.growth);) {
    const Point centre = best.ball.centre;
    bool better = false;
    for (const Point& way : patternDirections()) {
      const Point x = centre + step * way;
      const Fit fit = fitAt(x);
      if (!(fit.growth < best.growth - kWorthwhile * step) || !container.contains(x)) continue;
      best = fit;
      better = true;
    }
    if (!better) step /= 2;
  }
  return best;
}

/// Each point belongs to the ball that has to grow least for it.
std::vector<std::vector<Point>> grouped(const std::vector<Ball>& balls, const std::vector<Point>& points) {
  const std::vector<NearBalls::Nearest> nearest = nearestBalls(points, balls);
  std::vector<std::vector<Point>> groups(balls.size());
  for (std::size_t i = 0; i < points.size(); ++i) groups[nearest[i].index].push_back(points[i]);
  return groups;
}

/// Moves balls in the solid to where they have to grow least, and lets them grow.
std::vector<Ball> tightened(const Container& container, std::vector<Ball> balls,
                            const std::vector<Point>& points, const std::function<void(double)>& report) {
  std::vector<Ball> best;
  double least = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kSteps; ++step) {
    report(static_cast<double>(step) / (2 * kSteps));
    const std::vector<std::vector<Point>> groups = grouped(balls, points);
    std::vector<double> growth(balls.size());
    tbb::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t i) {
      const Fit fit = fitted(container, balls[i], groups[i]);
      balls[i] = fit.ball;
      growth[i] = std::max(0.0, fit.growth);
    });
    const double sum = std::accumulate(growth.begin(), growth.end(), 0.0);
    if (!(sum < (1 - 1e-3) * least)) break;
    least = sum;
    best = balls;
    for (std::size_t i = 0; i < balls.size(); ++i) best[i].radius += growth[i];
  }
  return best;
}

/// Proves cube by cube that balls hold a solid, once they have grown as much as it finds. They do not grow
/// meanwhile: a ball that just grew would be next to grow, too, and go on across the solid.
class Proof {
 public:
  Proof(const Container& container, double smallest, const std::vector<Ball>& balls)
      : container_(container), smallest_(smallest), balls_(balls), growth_(balls.size()) {}

  /// Returns by how much each ball has to grow.
  const std::vector<double>& growth() const { return growth_; }

  /// Looks at a cube. `near` are the balls that may have to grow least for a part of it.
  void visit(const OctreeCube& cube, const std::vector<std::uint32_t>& near) {
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t nearest = 0;
    for (std::uint32_t i : near) {
      const double growth = cube.farthest(balls_[i]);
      if (growth < least) least = growth, nearest = i;
    }
    if (least <= 0) return;
    const double reach = std::sqrt(3.0) * cube.half + container_.margin();
    if (std::isinf(container_.closest(cube.centre, reach).distance) && !container_.contains(cube.centre))
      return;
    if (cube.half <= smallest_) {
      growth_[nearest] = std::max(growth_[nearest], least);
      return;
    }
    std::vector<std::uint32_t> rest;
    for (std::uint32_t i : near) {
      if (cube.nearest(balls_[i]) <= least) rest.push_back(i);
    }
    for (int corner = 0; corner < 8; ++corner) {
      const Point way(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      visit({cube.centre + cube.half / 2 * way, cube.half / 2}, rest);
    }
  }

 private:
  const Container& container_;
  const double smallest_;
  const std::vector<Ball>& balls_;
  std::vector<double> growth_;
};

}  // namespace

Covering coverSolid(const Solid& solid, const Packing& packing, const CoverOptions& options,
                    const Progress& progress) {
  if (!(options.resolution >= 1e-4 && options.resolution <= 0.1))
    throw Error(ErrorCode::bad_argument, "resolution must lie between 0.0001 and 0.1");
  if (options.threads < 0) throw Error(ErrorCode::bad_argument, "threads must be 0 or more");
  validate(packing);
  const Reporter reporter(progress, "covering '" + solid.name() + "'");
  const auto report = [&](double fraction) { reporter("covering", fraction); };
  report(0);
  const Container container(solid, &reporter);
  std::vector<Ball> balls;
  for (const Sphere& s : packing.spheres)
    balls.push_back(
        {container.fromWorld(packing.origin + Vec3d{s.x, s.y, s.z}), s.radius / container.side()});
  tbb::task_arena arena(arenaThreads(options.threads));
  arena.execute([&] {
    const std::vector<Point> points = pointsOf(solid, container, balls.size());
    balls = tightened(container, std::move(balls), points, report);
  });

  // Centres are rounded before the proof, radii are rounded up after it.
  for (Ball& ball : balls) {
    const double radius = ball.radius;
    ball = container.rounded({ball.centre, 1});
    ball.radius = radius;
  }
  std::vector<std::uint32_t> all(balls.size());
  std::iota(all.begin(), all.end(), 0u);
  const double diagonal_length = diagonal(solid.bounds()) / container.side();
  report(0.5);
  Proof proof(container, options.resolution * diagonal_length / 2, balls);
  proof.visit({Point::Constant(0.5), 0.5}, all);

  Covering covering;
  covering.origin = container.origin();
  for (std::size_t i = 0; i < balls.size(); ++i) {
    balls[i].radius += proof.growth()[i] + container.coarseness();
    covering.spheres.push_back(container.toSphere(balls[i]));
    float& radius = covering.spheres.back().radius;
    radius = std::nextafter(radius, std::numeric_limits<float>::infinity());
  }
  report(0.9);
  arena.execute([&] { measureUnion(container, balls, covering); });
  covering.provenance = packing.provenance;
  covering.provenance.options += " --cover";
  report(1);
  return covering;
}

Covering coverSurface(const Packing& packing, const CoverOptions& options, const Progress& progress) {
  return coverSolid(*solidOf(packing), packing, options, progress);
}

}  // namespace innersphere
