// The volume of each lens, all the way through a query, against long double.
#include <cmath>

#include "conformance.hpp"

namespace innersphere::test {
namespace {

class LensVolumeConformance : public Conformance {};

struct TwoBalls {
  std::shared_ptr<CollisionModel> a, b;
  PairQuery query;
  Real depth;  ///< that was asked for, of the smaller radius
};

/// Two balls somewhere in their packings, at any rotation, that reach into each other by `depth` of the
/// smaller radius.
TwoBalls twoBalls(Random& random, double ratio, double depth) {
  const double ra = std::exp(random.uniform(-3, 3)), rb = ra / ratio;
  const auto ball = [&](double radius, double scale) {
    const Vec3d d = random.direction();
    const double far = 3 * radius / scale;
    return Spheres{{static_cast<float>(far * d[0]), static_cast<float>(far * d[1]),
                    static_cast<float>(far * d[2]), static_cast<float>(radius / scale)}};
  };
  TwoBalls balls;
  balls.depth = depth;
  const double scale_a = random.uniform(0.3, 3), scale_b = random.uniform(0.3, 3);
  const Spheres a = ball(ra, scale_a), b = ball(rb, scale_b);
  balls.a = makeModel(a);
  balls.b = makeModel(b);
  PairQuery& query = balls.query;
  query.a = balls.a.get();
  query.b = balls.b.get();
  query.placement_a = randomPlacement(random, 10, scale_a);
  query.placement_b = randomPlacement(random, 0, scale_b);
  // B goes where its ball is at the right distance from that of A.
  const auto centre = [](const Placement& p, const Sphere& s) {
    const double local[3] = {s.x, s.y, s.z};
    Vec3d c{};
    for (int i = 0; i < 9; ++i) c[i / 3] += p.scale * p.rotation[i] * local[i % 3];
    return c;
  };
  const double small = std::min(ra, rb), distance = ra + rb - depth * small;
  const Vec3d ca = centre(query.placement_a, a[0]), cb = centre(query.placement_b, b[0]),
              d = random.direction();
  for (int i = 0; i < 3; ++i)
    query.placement_b.translation[i] = query.placement_a.translation[i] + ca[i] + distance * d[i] - cb[i];
  return balls;
}

TEST_P(LensVolumeConformance, WithinABoundOfLongDouble) {
  QueryContext context = makeContext();
  Random random(17);
  std::size_t large = 0, small = 0;
  for (const double ratio : {1.0, 1.0001, 1.5, 10.0, 1e2, 1e3, 1e4, 1e-4}) {
    std::vector<TwoBalls> balls;
    for (std::size_t i = 0; i < cases(150, 6); ++i)
      balls.push_back(twoBalls(random, ratio, std::exp(random.uniform(-25, 1))));
    std::vector<PairQuery> queries;
    for (const TwoBalls& pair : balls) queries.push_back(pair.query);
    QueryResult result;
    context.run(queries.data(), queries.size(), {Want::wrench, Estimator::raw}, result);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const Oracle oracle = bruteForce(queries[i], Estimator::raw);
      if (!oracle.unclear.empty()) continue;
      SCOPED_TRACE(testing::Message() << ratio << " depth " << static_cast<double>(balls[i].depth));
      ASSERT_EQ(result.overlaps[i].pair_count, oracle.pairs.size());
      if (oracle.pairs.empty()) continue;
      const Sphere &a = balls[i].a->packing().spheres[0], &b = balls[i].b->packing().spheres[0];
      const double ra = a.radius * queries[i].placement_a.scale, rb = b.radius * queries[i].placement_b.scale;
      const double ball = 4.19 * std::pow(std::min(ra, rb), 3), volume = static_cast<double>(oracle.volume);
      const double error = std::fabs(static_cast<double>(oracle.volume - result.overlaps[i].volume));
      // The distance of two centres is known to some 1e-15 of the lengths that it is made of: of that of a
      // thin lens a part is lost. The volume changes by its rim's area times that.
      const double lengths = 10 * (ra + rb);
      EXPECT_LE(error, 1e-9 * volume + 1e-15 * lengths * static_cast<double>(oracle.stiffness));
      if (volume > 1e-6 * ball) {
        EXPECT_LE(error, 1e-5 * volume);
        ++large;
      } else {
        ++small;
      }
    }
  }
  EXPECT_GT(large, cases(200, 5));
  EXPECT_GT(small, cases(200, 5));
}

/// Bounds around many small spheres are large beside what they touch, and rounded by a part of their size.
TEST_P(LensVolumeConformance, SmallSpheresThatTouchASmallBody) {
  QueryContext context = makeContext();
  const Spheres spheres = dust(cases(600, 30), 5);
  const auto model = makeModel(spheres);
  const Sphere& grain = spheres.back();
  Random random(6);
  std::vector<std::shared_ptr<CollisionModel>> others;
  std::vector<PairQuery> queries;
  for (std::size_t i = 1; i < spheres.size(); ++i) {
    const Sphere& s = spheres[i];
    const double radius = grain.radius * random.uniform(0.5, 2);
    others.push_back(makeModel({{0, 0, 0, static_cast<float>(radius)}}));
    const Vec3d d = random.direction();
    const double distance = (s.radius + double{others.back()->packing().spheres[0].radius}) * (1 - 1e-5);
    PairQuery query;
    query.a = model.get();
    query.b = others.back().get();
    query.placement_b = at({s.x + distance * d[0], s.y + distance * d[1], s.z + distance * d[2]});
    queries.push_back(query);
  }
  for (int swapped = 0; swapped < 2; ++swapped) {
    QueryResult result;
    context.run(queries.data(), queries.size(), {Want::wrench, Estimator::raw}, result);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const Oracle oracle = bruteForce(queries[i], Estimator::raw);
      EXPECT_GE(oracle.pairs.size(), 1u);
      EXPECT_EQ(result.overlaps[i].pair_count, oracle.pairs.size()) << i;
    }
    for (PairQuery& query : queries) {
      std::swap(query.a, query.b);
      std::swap(query.placement_a, query.placement_b);
    }
  }
}

INNERSPHERE_FOR_EACH_BACKEND(LensVolumeConformance);

}  // namespace
}  // namespace innersphere::test
