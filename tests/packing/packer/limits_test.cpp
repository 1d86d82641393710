// When a packing ends, and what it reports.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <thread>

#include "analytic_solids.hpp"
#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "mesh_shapes.hpp"
#include "packer/container.hpp"
#include "packer/greedy_rounds.hpp"
#include "packer_oracles.hpp"

namespace innersphere::test {
namespace {

PackOptions nothing() {
  PackOptions options;
  options.spheres = 0;
  options.overlap_errors = false;
  return options;
}

PackOptions spheres(std::size_t count) {
  PackOptions options = nothing();
  options.spheres = count;
  return options;
}

double filled(const Packing& packing, std::size_t count) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    sum += 4.0 / 3.0 * std::numbers::pi * std::pow(double{packing.spheres[i].radius}, 3);
  }
  return sum;
}

ErrorCode codeOf(const PackOptions& options, const Progress& progress = {}) {
  try {
    pack(Cube(), options, progress);
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::bad_format;
}

TEST(PackerLimits, ExactNumberOfSpheres) {
  for (std::size_t count : {1u, 2u, 9u, 63u, 64u, 65u, 311u}) {
    EXPECT_EQ(pack(Cube(), spheres(count)).spheres.size(), count);
  }
}

TEST(PackerLimits, SmallestRadius) {
  PackOptions options = nothing();
  options.min_radius = 0.03;
  const Cube cube;
  const Packing packing = pack(cube, options);
  EXPECT_GE(packing.spheres.back().radius, 0.03);
  EXPECT_LT(packing.certificate.largest_missing_radius, 0.0302);
  EXPECT_LE(largestRoom(cube, packing, packing.spheres.size(), 100000),
            packing.certificate.largest_missing_radius);
}

TEST(PackerLimits, SmallestRadiusThatJustFits) {
  PackOptions options = nothing();
  options.min_radius = 0.498;
  EXPECT_EQ(pack(Cube(), options).spheres.size(), 1u);
  options.min_radius = 0.5001;
  EXPECT_EQ(codeOf(options), ErrorCode::no_sphere_fits);
}

TEST(PackerLimits, Density) {
  PackOptions options = nothing();
  options.density = 0.78;
  const Packing packing = pack(Cube(), options);
  EXPECT_GE(packing.quality.density, 0.78);
  EXPECT_LT(filled(packing, packing.spheres.size() - 1), 0.78);
}

TEST(PackerLimits, Gap) {
  PackOptions options = nothing();
  options.gap = 0.06;
  const Packing packing = pack(Cube(), options);
  EXPECT_LE(packing.quality.gap_max, 0.06);
  options.gap = 0;
  options.spheres = packing.spheres.size() - 1;
  EXPECT_GT(pack(Cube(), options).quality.gap_max, 0.06);
}

TEST(PackerLimits, WhicheverComesFirst) {
  PackOptions options = spheres(50);
  options.density = 0.9;
  EXPECT_EQ(pack(Cube(), options).spheres.size(), 50u);
  options.density = 0.6;
  EXPECT_LT(pack(Cube(), options).spheres.size(), 50u);
}

// A round that needs more cells than may be live is no question of memory.
TEST(PackerLimits, Cells) {
  const Cube cube;
  const Container container(cube);
  tbb::task_arena arena(2);
  const auto codeWith = [&](std::size_t cells) {
    try {
      GreedyRounds(container, 0.1, 0.001, 100'000, cells)
          .run(
              arena, [](const auto&) { return false; },
              [](const auto& now, double) { return now.top.size() > 1000; }, {});
    } catch (const Error& error) {
      return std::optional(error.code());
    }
    return std::optional<ErrorCode>();
  };
  EXPECT_EQ(codeWith(GreedyRounds::kMostCells), std::nullopt);
  EXPECT_EQ(codeWith(10), ErrorCode::bad_argument);
}

// Sheet metal of 1 m and 1 mm has a million places for the largest sphere, but its faces are flat.
TEST(PackerLimits, CellsOfThinPlates) {
  const auto plate = makeSolid(boxMesh({-0.5, -0.5, -0.0005}, {0.5, 0.5, 0.0005}), "plate");
  const Container container(*plate);
  tbb::task_arena arena(2);
  const auto placed = GreedyRounds(container, 0.1, 1e-4, 200, 500'000)
                          .run(
                              arena, [](const auto& now) { return now.top.size() == 200; },
                              [](const auto&, double) { return false; }, {});
  EXPECT_EQ(placed.rounded.size(), 200u);
}

TEST(PackerLimits, GapNeedsASurface) {
  PackOptions options;
  options.gap = 0.1;
  EXPECT_THROW(pack(TestTorus(), options), Error);
}

TEST(PackerLimits, RefusesNonsense) {
  for (double delta : {0.0, -0.1, 2.0, double(NAN)}) {
    PackOptions options;
    options.delta = delta;
    EXPECT_EQ(codeOf(options), ErrorCode::bad_argument);
  }
  PackOptions options;
  options.min_radius = -1;
  EXPECT_EQ(codeOf(options), ErrorCode::bad_argument);
  options = {};
  options.density = 1.5;
  EXPECT_EQ(codeOf(options), ErrorCode::bad_argument);
  options = {};
  options.gap = NAN;
  EXPECT_EQ(codeOf(options), ErrorCode::bad_argument);
  options = {};
  options.threads = -1;
  EXPECT_EQ(codeOf(options), ErrorCode::bad_argument);
}

TEST(PackerProgress, RisesAndComesFromTheCallingThread) {
  PackOptions options;
  options.spheres = 300;
  options.threads = 2;
  const auto caller = std::this_thread::get_id();
  double last = 0;
  std::string stage;
  pack(Cube(), options, [&](const char* now, double fraction) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    if (stage != now) last = 0;
    stage = now;
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1);
    last = fraction;
    return true;
  });
  EXPECT_EQ(last, 1);
}

TEST(PackerProgress, CancelsInEveryStage) {
  PackOptions options = spheres(100);
  for (const std::string stage : {"packing", "quality", "cell volumes"}) {
    int calls = 0;
    EXPECT_EQ(codeOf(options,
                     [&](const char* now, double) {
                       calls += stage == now;
                       return stage != now;
                     }),
              ErrorCode::cancelled);
    EXPECT_EQ(calls, 1);
  }
}

TEST(PackerReport, Provenance) {
  PackOptions options = spheres(5);
  options.delta = 0.25;
  const Packing packing = pack(Cube(), options);
  EXPECT_EQ(packing.provenance.source, "test cube");
  EXPECT_EQ(packing.provenance.options, "--spheres 5 --delta 0.25");
  EXPECT_FALSE(packing.provenance.version.empty());
  EXPECT_EQ(packing.solid.volume, 1);
  EXPECT_EQ(packing.surface.triangles.size(), 12u);
}

// One sphere in a cube: the gap at a face's centre is 0 and at a corner sqrt(3)/2 - 1/2; its mean over a face
// is an integral that is easily summed.
TEST(PackerReport, GapsOfOneSphereInACube) {
  const Packing packing = pack(Cube(), spheres(1));
  double mean = 0;
  const int n = 400;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) mean += std::hypot((i + 0.5) / n - 0.5, (j + 0.5) / n - 0.5, 0.5) - 0.5;
  }
  EXPECT_NEAR(packing.quality.gap_mean, mean / n / n, 1e-4);
  EXPECT_NEAR(packing.quality.gap_max, std::sqrt(3.0) / 2 - 0.5, 5e-3);
  EXPECT_LT(packing.quality.gap_p95, packing.quality.gap_max);
  EXPECT_GT(packing.quality.gap_p95, packing.quality.gap_mean);
}

}  // namespace
}  // namespace innersphere::test
