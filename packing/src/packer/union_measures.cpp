#include "packer/union_measures.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "common/bounds.hpp"
#include "common/steady_math.hpp"
#include "mesh/mass_properties.hpp"
#include "packer/mass_weights.hpp"
#include "packer/near_balls.hpp"
#include "packer/surface_samples.hpp"
#include "packer/voxels.hpp"

namespace innersphere {
namespace {

// Points on each sphere at which the overhang is measured.
constexpr int kOverhangPoints = 500;

// Points in the solid of which those in the union are counted.
constexpr double kInnerPoints = 200000;

// Lines along x through the union, in each of the two other directions.
constexpr int kLines = 512;

/// Measures the overhang at points of the balls that are in no other ball, by equal parts of the area.
void addOverhang(const Container& container, std::span<const Ball> balls, Covering& covering) {
  const double turn = std::numbers::pi * (1 + std::sqrt(5.0));
  std::vector<double> sums(balls.size()), areas(balls.size()), most(balls.size());
  tbb::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t i) {
    const Ball& ball = balls[i];
    const double area = ball.radius * ball.radius;
    for (int k = 0; k < kOverhangPoints; ++k) {
      const double z = 1 - (2 * k + 1.0) / kOverhangPoints, r = std::sqrt(1 - z * z);
      const Point x =
          ball.centre + ball.radius * Point(r * steady::cos(k * turn), r * steady::sin(k * turn), z);
      const auto holds = [&](const Ball& other) { return &other != &ball && other.distance(x) < 0; };
      if (std::any_of(balls.begin(), balls.end(), holds)) continue;
      areas[i] += area;
      const Container::Nearest nearest = container.closest(x, std::numeric_limits<double>::infinity());
      if (container.contains(x, nearest)) continue;
      sums[i] += area * nearest.distance;
      most[i] = std::max(most[i], nearest.distance);
    }
  });
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    sum += sums[i];
    area += areas[i];
    covering.overhang_max = std::max(covering.overhang_max, container.side() * most[i]);
  }
  covering.overhang_mean = area > 0 ? container.side() * sum / area : 0;
}

/// Returns the mass properties of a union, summed by lines along x, each exact along itself.
MassProperties massOf(const std::vector<Sphere>& spheres) {
  Bounds box = emptyBounds();
  for (const Sphere& s : spheres) {
    const Vec3d centre{s.x, s.y, s.z}, reach{s.radius, s.radius, s.radius};
    extend(box, centre - reach);
    extend(box, centre + reach);
  }
  const Vec3d step = (1.0 / kLines) * (box.max - box.min);
  std::vector<Moments> rows(kLines);
  tbb::parallel_for(0, kLines, [&](int row) {
    Moments& sum = rows[static_cast<std::size_t>(row)];
    sum.origin = centre(box);
    const double z = box.min[2] + row * step[2];
    std::vector<std::pair<double, double>> pieces;
    for (int line = 0; line < kLines; ++line) {
      const double y = box.min[1] + line * step[1];
      pieces.clear();
      for (const Sphere& s : spheres) {
        const double dy = y + step[1] / 2 - s.y, dz = z + step[2] / 2 - s.z;
        const double squared = double{s.radius} * s.radius - dy * dy - dz * dz;
        if (squared > 0) pieces.push_back({s.x - std::sqrt(squared), s.x + std::sqrt(squared)});
      }
      std::sort(pieces.begin(), pieces.end());
      double reached = box.min[0];
      for (const auto& [from, to] : pieces) {
        if (to <= reached) continue;
        sum.addBox({{std::max(from, reached), y, z}, {to, y + step[1], z + step[2]}}, 1);
        reached = to;
      }
    }
  });
  Moments all;
  all.origin = centre(box);
  for (const Moments& row : rows) all.add(row);
  return all.massProperties();
}

/// Adds the parts of the union inside and outside of the solid.
void addParts(const Container& container, std::span<const Ball> balls, Covering& covering) {
  const double side = container.side();
  const Voxels voxels(container, covering.solid.volume / (side * side * side), kInnerPoints);
  std::vector<Point> points;
  for (const auto& half : voxels.points()) {
    for (const Eigen::Vector3f& x : half) points.push_back(x.cast<double>());
  }
  const std::vector<NearBalls::Nearest> nearest = nearestBalls(points, balls);
  const auto held =
      std::count_if(nearest.begin(), nearest.end(), [](const auto& ball) { return ball.distance < 0; });
  if (!points.empty()) covering.inside = static_cast<double>(held) / static_cast<double>(points.size());
  covering.outside = std::max(0.0, covering.united.volume / covering.solid.volume - covering.inside);
}

/// Adds masses of the spheres, which change least from those of equal densities.
void addMasses(std::span<const Ball> balls, Covering& covering) {
  std::vector<double> volumes;
  double sum = 0;
  for (const Ball& ball : balls) sum += volumes.emplace_back(ball.volume());
  for (double& volume : volumes) volume *= covering.solid.volume / sum;
  covering.mass_weights = findMassWeights(covering.spheres, volumes, covering.solid);
}

void addGaps(const Container& container, std::span<const Ball> balls, Covering& covering) {
  const SurfaceSamples samples(container.solid().surface(), container);
  const std::size_t all[] = {balls.size()};
  for (const Coverage& c : samples.coverage(balls, all, 1)) {
    covering.gap_mean = container.side() * c.mean;
    covering.gap_max = container.side() * c.max;
  }
}

}  // namespace

void measureUnion(const Container& container, std::span<const Ball> balls, Covering& covering) {
  covering.solid = container.solid().massProperties();
  covering.solid.centre_of_mass = covering.solid.centre_of_mass - covering.origin;
  covering.united = massOf(covering.spheres);
  addParts(container, balls, covering);
  addOverhang(container, balls, covering);
  addGaps(container, balls, covering);
  addMasses(balls, covering);
}

}  // namespace innersphere
