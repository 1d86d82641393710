// Overlaps by triangles: the closed forms of boxes, however thin, small or coplanar, and what is refused.
#include <cmath>
#include <functional>

#include "conformance.hpp"
#include "innersphere/bounded_query.hpp"
#include "innersphere/error.hpp"

namespace innersphere::test {
namespace {

/// A box about the origin with one sphere in it.
std::shared_ptr<Packing> boxPacking(const Vec3d& size) {
  const auto radius = static_cast<float>(0.45 * std::min({size.x, size.y, size.z}));
  const auto packing = makePacking({{0, 0, 0, radius}});
  for (int i = 0; i < 8; ++i) {
    std::array<float, 3> v;
    for (int k = 0; k < 3; ++k) v[k] = static_cast<float>(((i >> k & 1) - 0.5) * size[k]);
    packing->surface.vertices.push_back(v);
  }
  packing->surface.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return packing;
}

std::shared_ptr<CollisionModel> boxModel(const Vec3d& size) {
  return std::make_shared<CollisionModel>(boxPacking(size));
}

Placement turned(double angle, const Vec3d& place) {
  Placement result = at(place);
  const double c = std::cos(angle), s = std::sin(angle);
  result.rotation = {c, -s, 0, s, c, 0, 0, 0, 1};
  return result;
}

constexpr QueryOptions kSurface{Want::wrench, Estimator::surface};

class SurfaceConformance : public Conformance {
 protected:
  Overlap overlap(const CollisionModel& a, const CollisionModel& b, const Placement& place_b) {
    PairQuery query;
    query.a = &a;
    query.b = &b;
    query.placement_b = place_b;
    return makeContext().overlap(query, kSurface);
  }
};

void expectNear(const Vec3d& a, const Vec3d& b, double tolerance) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << k;
}

// Parallel boxes of a power of two have exact corners; each face of the overlap lies in a face of one of
// them.
TEST_P(SurfaceConformance, ParallelBoxes) {
  const auto a = boxModel({2, 2, 2}), b = boxModel({1, 1, 4});
  for (const Vec3d& place : {Vec3d{1.25, 0, 0}, Vec3d{1.375, 1.25, 2.5}, Vec3d{1, -0.25, 2.75},
                             Vec3d{0, 0, 0}, Vec3d{1.5 - 0x1p-14, 0.25, 0.5}, Vec3d{0.5, 0.5, 0}}) {
    Vec3d low, high;
    const Vec3d half_a{1, 1, 1}, half_b{0.5, 0.5, 2};
    for (int k = 0; k < 3; ++k) {
      low[k] = std::max(-half_a[k], place[k] - half_b[k]);
      high[k] = std::min(half_a[k], place[k] + half_b[k]);
    }
    const Vec3d size = high - low;
    const double volume = size.x * size.y * size.z;
    const Overlap got = overlap(*a, *b, at(place));
    EXPECT_NEAR(got.volume, volume, 1e-14);
    expectNear(got.centroid, 0.5 * (low + high), 1e-12);
    // Faces of B that are in A push; where a face of A and one of B are in one plane, either may count.
    for (int k = 0; k < 3; ++k) {
      const double face = volume / size[k];
      const bool low_is_of_b = place[k] - half_b[k] > -half_a[k],
                 high_is_of_b = place[k] + half_b[k] < half_a[k];
      const bool coplanar = place[k] - half_b[k] == -half_a[k] || place[k] + half_b[k] == half_a[k];
      if (!coplanar) {
        EXPECT_NEAR(got.area[k], face * (low_is_of_b - high_is_of_b), 1e-9 * face);
      }
    }
    EXPECT_EQ(got.energy, got.volume);
  }
}

// Of two bodies that are one solid, one reaches into the cube from above; the other is below it, apart.
TEST_P(SurfaceConformance, PartsAboveAndBelow) {
  const auto cube = boxModel({1, 1, 1});
  const auto packing = boxPacking({0.5, 0.5, 0.5});
  const Surface upper = packing->surface;
  for (const auto& v : upper.vertices) packing->surface.vertices.push_back({v[0], v[1], v[2] - 2});
  for (const auto& t : upper.triangles) packing->surface.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  const CollisionModel pair(packing);
  for (const double depth : {0.125, 0x1p-8}) {
    const Overlap got = overlap(*cube, pair, at({0.125, 0, 0.75 - depth}));
    EXPECT_NEAR(got.volume, depth / 4, 1e-14);
    expectNear(got.area, {0, 0, 0.25}, 1e-9);
  }
}

// A square and the same turned by 45 degrees share a regular octagon.
TEST_P(SurfaceConformance, TurnedThinPlates) {
  constexpr double kThickness = 0x1p-10, kShift = 0x1p-14;
  const auto plate = boxModel({1, 1, kThickness});
  const Overlap got = overlap(*plate, *plate, turned(M_PI / 4, {0, 0, kThickness - kShift}));
  const double octagon = 2 * (std::sqrt(2.0) - 1);
  EXPECT_NEAR(got.volume / (octagon * kShift), 1, 1e-9);
  expectNear(got.area, {0, 0, octagon}, 1e-9);
  expectNear(got.force, got.area, 0);
  expectNear(got.torque, {0, 0, 0}, 1e-9);
}

// Two boxes, which are one solid, have a half of each in common.
TEST_P(SurfaceConformance, ErrorsAreUnknownWhereShellsOverlap) {
  const auto expected = [this](const CollisionModel& a, const CollisionModel& b) {
    PairQuery query;
    query.a = &a;
    query.b = &b;
    return expectedError(query, Estimator::surface, makeContext().overlap(query, kSurface));
  };
  const auto packing = boxPacking({1, 1, 1});
  packing->solid.volume = 1;
  const CollisionModel box(packing);
  const auto crossing = std::make_shared<Packing>(*packing);
  const Surface first = packing->surface;
  for (const auto& v : first.vertices) crossing->surface.vertices.push_back({v[0] + 0.5F, v[1], v[2]});
  for (const auto& t : first.triangles) crossing->surface.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  crossing->solid.volume = 1.5;
  const CollisionModel both(crossing);
  EXPECT_NEAR(overlap(both, box, at({0.25, 0, 0})).volume, 1.5, 1e-12) << "of 1";
  EXPECT_EQ(expected(box, box).bound, 0);
  for (const ExpectedError& error : {expected(both, box), expected(box, both)}) {
    EXPECT_TRUE(std::isnan(error.mean));
    EXPECT_TRUE(std::isnan(error.bound));
  }
}

// By 10^-12 of a cube: one corner inside the other's corner, both turned about z, far from the world's
// origin.
TEST_P(SurfaceConformance, TinyOverlapFarAway) {
  const auto cube = boxModel({1, 1, 1});
  const double depth = 0x1p-13;
  const Vec3d far{1e4, -3e4, 2e4};
  PairQuery query;
  query.a = query.b = cube.get();
  query.placement_a = turned(0.5, far);
  const Vec3d step = (1 - depth) * Vec3d{std::cos(0.5) - std::sin(0.5), std::sin(0.5) + std::cos(0.5), 1};
  query.placement_b = turned(0.5, far + step);
  const Overlap got = makeContext().overlap(query, kSurface);
  EXPECT_NEAR(got.volume / (depth * depth * depth), 1, 1e-5);  // rounding of the places
  EXPECT_NEAR(norm(got.area) / (std::sqrt(3.0) * depth * depth), 1, 1e-5);
}

TEST_P(SurfaceConformance, ApartTouchingAndInside) {
  const auto cube = boxModel({1, 1, 1}), small = boxModel({0.25, 0.25, 0.25});
  EXPECT_EQ(overlap(*cube, *cube, at({1.5, 0, 0})).volume, 0);
  EXPECT_NEAR(overlap(*cube, *cube, at({1, 0, 0})).volume, 0, 1e-12);
  for (const bool swapped : {false, true}) {
    const Overlap got =
        swapped ? overlap(*small, *cube, at({-0.1, 0, 0.2})) : overlap(*cube, *small, at({0.1, 0, -0.2}));
    EXPECT_NEAR(got.volume, 1.0 / 64, 1e-12);
    expectNear(got.area, {0, 0, 0}, 1e-9);
  }
}

// One is a million times as large as the other.
TEST_P(SurfaceConformance, VeryDifferentSizes) {
  constexpr float kLarge = 0x1p20F;
  const auto large = boxModel({kLarge, kLarge, kLarge}), small = boxModel({1, 1, 1});
  for (const Vec3d& place : {Vec3d{kLarge / 2 - 0.25, 0.125, 0.25}, Vec3d{0.25, kLarge / 2 - 0.25, -1e5}}) {
    EXPECT_NEAR(overlap(*large, *small, at(place)).volume, 0.75, 1e-5);
    EXPECT_NEAR(overlap(*small, *large, at(-place)).volume, 0.75, 1e-5);
  }
}

// Force and torque are those of the energy, in any pose and scale.
TEST_P(SurfaceConformance, ForceIsTheGradient) {
  const auto a = boxModel({1, 0.5, 0.75}), b = boxModel({0.5, 1, 0.625});
  Random random(3);
  QueryContext context = makeContext();
  for (int i = 0; i < 10; ++i) {
    PairQuery query;
    query.a = a.get();
    query.b = b.get();
    query.placement_a = randomPlacement(random, 0.1, 1.5);
    query.placement_b = randomPlacement(random, 0.3, 1.25);
    const Overlap got = context.overlap(query, kSurface);
    ASSERT_GT(got.volume, 0);
    const auto slope = [&](const std::function<void(PairQuery&, double)>& move) {
      PairQuery ahead = query, back = query;
      move(ahead, 1e-5);
      move(back, -1e-5);
      return (context.overlap(ahead, kSurface).energy - context.overlap(back, kSurface).energy) / 2e-5;
    };
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(got.force[k], -slope([&](PairQuery& q, double s) { q.placement_b.translation[k] += s; }),
                  1e-5);
      const auto turn = [&](PairQuery& q, double s) {
        const int x = (k + 1) % 3, y = (k + 2) % 3;
        for (int j = 0; j < 3; ++j) {
          double &u = q.placement_b.rotation[3 * x + j], &v = q.placement_b.rotation[3 * y + j];
          const double old = u;
          u = std::cos(s) * old - std::sin(s) * v;
          v = std::sin(s) * old + std::cos(s) * v;
        }
      };
      EXPECT_NEAR(got.torque[k], -slope(turn), 1e-5);
    }
  }
}

TEST_P(SurfaceConformance, BatchesAndSweepsHaveTheSameBits) {
  const auto a = boxModel({1, 0.5, 0.75}), b = boxModel({0.5, 1, 0.625});
  constexpr std::size_t kCount = 100;
  Random random(4);
  std::vector<PairQuery> queries(kCount);
  std::vector<double> matrices;
  for (PairQuery& query : queries) {
    query.a = a.get();
    query.b = b.get();
    query.placement_b = randomPlacement(random, 0.5);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) matrices.push_back(query.placement_b.rotation[3 * i + j]);
      matrices.push_back(query.placement_b.translation[i]);
    }
    matrices.insert(matrices.end(), {0, 0, 0, 1});
  }
  QueryResult one, two;
  makeContext(1).run(queries.data(), kCount, kSurface, one);
  QueryContext context = makeContext(2);
  context.run(queries.data(), kCount, kSurface, two);
  expectSame(one, two);
  std::vector<Overlap> swept(kCount);
  context.sweep(queries[0], {kCount, matrices.data()}, kSurface, swept.data());
  for (std::size_t i = 0; i < kCount; ++i)
    EXPECT_TRUE(sameBits(swept[i], context.overlap(queries[i], kSurface))) << i;
}

TEST_P(SurfaceConformance, WhatIsNotWantedIsZero) {
  const auto cube = boxModel({1, 1, 1});
  PairQuery query;
  query.a = query.b = cube.get();
  query.placement_b = at({0.5, 0, 0});
  QueryContext context = makeContext();
  const Overlap got = context.overlap(query, {Want::volume, Estimator::surface});
  EXPECT_NEAR(got.volume, 0.5, 1e-12);
  EXPECT_EQ(norm(got.area) + norm(got.force) + norm(got.torque) + got.energy + got.stiffness, 0);
  EXPECT_EQ(context.overlap(query, {Want::touch, Estimator::surface}).pair_count, 1u);
}

TEST_P(SurfaceConformance, WhatHasNoClosedSurfaceIsRefused) {
  const auto cube = boxModel({1, 1, 1});
  const auto spheres = makeModel({{0, 0, 0, 1}});
  const auto open_packing = boxPacking({1, 1, 1});
  open_packing->surface.triangles.pop_back();
  const auto open = std::make_shared<CollisionModel>(open_packing);
  const auto bent = boxModel({1, 1, 1});
  const Sphere sphere{0, 0, 0, 0.25F};
  bent->update(&sphere, 1);
  const auto refuses = [&](const CollisionModel& b, double margin, ErrorCode code) {
    PairQuery query;
    query.a = cube.get();
    query.b = &b;
    query.margin = margin;
    try {
      makeContext().overlap(query, kSurface);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      EXPECT_NE(std::string(error.what()).find("query 0: "), std::string::npos) << error.what();
    }
  };
  refuses(*spheres, 0, ErrorCode::empty_input);
  refuses(*open, 0, ErrorCode::not_a_solid);
  refuses(*bent, 0, ErrorCode::bad_argument);
  refuses(*cube, 0.1, ErrorCode::bad_argument);
}

INNERSPHERE_FOR_EACH_BACKEND(SurfaceConformance);

}  // namespace
}  // namespace innersphere::test
