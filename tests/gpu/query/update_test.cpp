// Models whose spheres move and grow: the same as models that were made that way, without allocations.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <thread>

#include "allocation_counter.hpp"
#include "conformance.hpp"
#include "innersphere/error.hpp"

namespace innersphere::test {
namespace {

class UpdateConformance : public Conformance {};

/// Bent, and all spheres a little larger: none changes its rank.
Spheres bent(Spheres spheres, double by) {
  for (Sphere& s : spheres) {
    const double x = s.x, z = s.z;
    s.x = static_cast<float>(x + by * z * z);
    s.z = static_cast<float>(z - by * x);
    s.radius *= 1 + 0.3f * static_cast<float>(by);
  }
  return spheres;
}

Overlap overlapOf(QueryContext& context, const CollisionModel& a, const CollisionModel& b,
                  Estimator estimator, std::uint32_t prefix = 0) {
  PairQuery query;
  query.a = &a;
  query.b = &b;
  query.placement_b = at({0.6, 0.1, -0.2});
  query.prefix_a = prefix;
  return context.overlap(query, {Want::wrench, estimator});
}

TEST_P(UpdateConformance, EqualsAModelMadeThatWay) {
  QueryContext context = makeContext();
  const Spheres spheres = randomSpheres(cases(2000, 400), 0.2, 30, 1);
  const auto model = makeModel(spheres), other = makeModel(randomSpheres(500, 0.25, 20, 2), true);
  overlapOf(context, *model, *other, Estimator::raw);  // now its grids are there
  overlapOf(context, *model, *other, Estimator::raw, 300);
  for (const double by : {0.1, -0.2, 0.0}) {
    const Spheres moved = bent(spheres, by);
    model->update(moved.data(), moved.size());
    const auto fresh = makeModel(moved);
    for (const std::uint32_t prefix : {0u, 300u, 77u}) {
      const Overlap updated = overlapOf(context, *model, *other, Estimator::raw, prefix);
      EXPECT_TRUE(sameBits(updated, overlapOf(context, *fresh, *other, Estimator::raw, prefix)));
      EXPECT_GT(updated.pair_count, 0u);
    }
  }
}

TEST_P(UpdateConformance, RadiiInAnyOrder) {
  QueryContext context = makeContext();
  Random random(5);
  const Spheres spheres = randomSpheres(600, 0.2, 30, 1);
  const auto model = makeModel(spheres), other = makeModel(randomSpheres(500, 0.25, 20, 2));
  Spheres grown = spheres;
  for (Sphere& s : grown) s.radius *= static_cast<float>(std::exp(random.uniform(-2, 1)));
  model->update(grown.data(), grown.size());
  std::vector<std::uint32_t> order(grown.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t i, std::uint32_t j) { return grown[i].radius > grown[j].radius; });
  Spheres sorted;
  for (std::uint32_t i : order) sorted.push_back(grown[i]);
  Scene updated(model, other), fresh(makeModel(sorted), other);
  updated.query.placement_b = fresh.query.placement_b = at({0.5, 0.3, 0});
  expectOracle(context, fresh.query);
  QueryResult x, y;
  context.run(&updated.query, 1, {Want::pairs, Estimator::raw}, x);
  context.run(&fresh.query, 1, {Want::pairs, Estimator::raw}, y);
  EXPECT_TRUE(sameBits(x.overlaps[0], y.overlaps[0]));
  for (SpherePair& pair : y.pairs.items) pair.a = order[pair.a];
  const auto before = [](const SpherePair& p, const SpherePair& q) {
    return p.a != q.a ? p.a < q.a : p.b < q.b;
  };
  std::sort(y.pairs.items.begin(), y.pairs.items.end(), before);
  ASSERT_EQ(x.pairs.items.size(), y.pairs.items.size());
  for (std::size_t k = 0; k < x.pairs.items.size(); ++k) {
    EXPECT_EQ(x.pairs.items[k].a, y.pairs.items[k].a);
    EXPECT_EQ(x.pairs.items[k].b, y.pairs.items[k].b);
  }
}

TEST_P(UpdateConformance, VolumeTrueRadiiGrowAsTheirSpheres) {
  QueryContext context = makeContext();
  const Spheres spheres = randomSpheres(300, 0.25, 20, 3);
  const auto packing = makePacking(spheres, true);
  const auto model = std::make_shared<CollisionModel>(packing);
  const auto other = makeModel(randomSpheres(200, 0.25, 20, 4), true);
  overlapOf(context, *model, *other, Estimator::volume_true);
  Packing twice = *packing;  // a power of two: all products are exact
  for (Sphere& s : twice.spheres) s = {2 * s.x, 2 * s.y, 2 * s.z, 2 * s.radius};
  for (VolumeTrueRadii& radii : twice.volume_true) {
    for (float& r : radii.radii) r *= 2;
  }
  model->update(twice.spheres.data(), twice.spheres.size());
  const CollisionModel fresh(std::make_shared<const Packing>(twice));
  for (const std::uint32_t prefix : {0u, 100u}) {
    const Overlap updated = overlapOf(context, *model, *other, Estimator::volume_true, prefix);
    EXPECT_TRUE(sameBits(updated, overlapOf(context, fresh, *other, Estimator::volume_true, prefix)));
    EXPECT_GT(updated.volume, 0);
  }
  EXPECT_EQ(model->packing().spheres[0].radius, packing->spheres[0].radius);
}

TEST_P(UpdateConformance, BadSpheresChangeNothing) {
  QueryContext context = makeContext();
  const Spheres spheres = randomSpheres(100, 0.3, 20, 1);
  const auto model = makeModel(spheres, true), other = makeModel(spheres);
  const Overlap before = overlapOf(context, *model, *other, Estimator::raw);
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  struct Case {
    const char* name;
    ErrorCode code;
    std::function<void(Spheres&)> spoil;
  };
  const Case cases[] = {
      {"NaN", ErrorCode::not_finite, [](Spheres& s) { s[7].y = kNaN; }},
      {"NaN radius", ErrorCode::not_finite, [](Spheres& s) { s[7].radius = kNaN; }},
      {"infinity", ErrorCode::not_finite,
       [](Spheres& s) { s[99].x = std::numeric_limits<float>::infinity(); }},
      {"no radius", ErrorCode::bad_argument, [](Spheres& s) { s[7].radius = 0; }},
      {"negative radius", ErrorCode::bad_argument, [](Spheres& s) { s[7].radius = -1; }},
      {"far away", ErrorCode::bad_argument, [](Spheres& s) { s[0].x = 2e15f; }},
      {"too large", ErrorCode::bad_argument, [](Spheres& s) { s[0].radius = 2e15f; }},
      {"one too few", ErrorCode::bad_argument, [](Spheres& s) { s.pop_back(); }},
      {"one too many", ErrorCode::bad_argument, [](Spheres& s) { s.push_back(s.back()); }},
      {"none", ErrorCode::bad_argument, [](Spheres& s) { s.clear(); }},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    Spheres bad = bent(spheres, 0.2);
    c.spoil(bad);
    try {
      model->update(bad.data(), bad.size());
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), c.code) << error.what();
    }
    EXPECT_TRUE(sameBits(before, overlapOf(context, *model, *other, Estimator::raw)));
  }
  EXPECT_THROW(model->update(nullptr, spheres.size()), Error);
}

TEST_P(UpdateConformance, ManyThreadsMayBeTheFirstToAskAgain) {
  const Spheres spheres = randomSpheres(500, 0.25, 30, 1);
  const auto model = makeModel(spheres, true), other = makeModel(spheres, true);
  for (const double by : {0.1, -0.1}) {
    const Spheres moved = bent(spheres, by);
    model->update(moved.data(), moved.size());
    std::vector<Overlap> overlaps(cases(4, 2));
    std::vector<std::thread> threads;
    for (Overlap& overlap : overlaps) {
      threads.emplace_back([&] {
        QueryContext context = makeContext(1);
        overlap = overlapOf(context, *model, *other, Estimator::volume_true);
        overlapOf(context, *model, *other, Estimator::raw, 100);
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (const Overlap& overlap : overlaps) EXPECT_TRUE(sameBits(overlap, overlaps[0]));
  }
}

INNERSPHERE_FOR_EACH_BACKEND(UpdateConformance);

TEST(Update, AllocatesNothingAfterTheFirstTime) {
  for (const int threads : {1, 2}) {
    QueryContext context({Backend::cpu, threads});
    const Spheres spheres = randomSpheres(3000, 0.2, 30, 1);
    const auto model = makeModel(spheres, true), other = makeModel(randomSpheres(500, 0.25, 20, 2), true);
    std::vector<Spheres> steps;
    for (int step = 0; step < 8; ++step) steps.push_back(bent(spheres, 0.1 * std::sin(1 + step)));
    const auto step = [&](const Spheres& moved) {
      model->update(moved.data(), moved.size());
      overlapOf(context, *model, *other, Estimator::raw);
      overlapOf(context, *model, *other, Estimator::volume_true);
      overlapOf(context, *model, *other, Estimator::raw, 200);
    };
    for (int i = 0; i < 2; ++i) step(steps[0]);
    const std::size_t before = allocations();
    for (const Spheres& moved : steps) step(moved);
    EXPECT_EQ(allocations() - before, 0u) << threads;
  }
}

}  // namespace
}  // namespace innersphere::test
