// A body in many poses: what single queries say of each, to the bit, from arrays of either layout.
#include <cmath>
#include <functional>
#include <limits>

#include "conformance.hpp"
#include "innersphere/error.hpp"

namespace innersphere::test {
namespace {

/// A pair whose second body is near the first one in most poses, and a quaternion and a position for each.
struct Swept {
  std::shared_ptr<CollisionModel> a = makeModel(randomSpheres(cases(1000, 200), 0.2, 30, 1), true),
                                  b = makeModel(randomSpheres(300, 0.3, 20, 2), true);
  PairQuery pair;
  std::vector<double> quaternions, positions, matrices;
  std::vector<PairQuery> queries;

  explicit Swept(std::size_t count) {
    Random random(7);
    pair.a = a.get();
    pair.b = b.get();
    pair.placement_a = randomPlacement(random, 3, 1.25);
    pair.placement_b.scale = 0.75;
    pair.prefix_a = 150;
    pair.margin = 0.01;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3d axis = random.direction();
      const double angle = random.uniform(0, 6), sine = std::sin(angle / 2);
      const double q[4] = {sine * axis.x, sine * axis.y, sine * axis.z, std::cos(angle / 2)};
      const Vec3d t = pair.placement_a.translation + random.uniform(0, 3) * random.direction();
      const Mat3d r = matrixOf(q);
      quaternions.insert(quaternions.end(), q, q + 4);
      positions.insert(positions.end(), {t.x, t.y, t.z});
      for (int row = 0; row < 3; ++row)
        matrices.insert(matrices.end(), {r[3 * row], r[3 * row + 1], r[3 * row + 2], t[row]});
      matrices.insert(matrices.end(), {0, 0, 0, 1});
      PairQuery query = pair;
      query.placement_b.rotation = r;
      query.placement_b.translation = t;
      queries.push_back(query);
    }
  }

  /// By turning the axes: q e q*.
  static Mat3d matrixOf(const double* q) {
    const Vec3d v{q[0], q[1], q[2]};
    const double w = q[3];
    Mat3d m{};
    for (std::size_t j = 0; j < 3; ++j) {
      Vec3d e{};
      e[j] = 1;
      const Vec3d t = 2.0 * cross(v, e);
      const Vec3d turned = e + w * t + cross(v, t);
      for (std::size_t i = 0; i < 3; ++i) m[3 * i + j] = turned[i];
    }
    return m;
  }

  Poses asMatrices() const { return {queries.size(), matrices.data(), nullptr, nullptr}; }
  Poses asQuaternions() const { return {queries.size(), nullptr, positions.data(), quaternions.data()}; }
};

class SweepConformance : public Conformance {};

/// More than a part of a sweep has, and one.
TEST_P(SweepConformance, IsWhatSingleQueriesSay) {
  QueryContext context = makeContext();
  for (const std::size_t count : {cases(20000, 60), std::size_t{1}}) {
    const Swept swept(count);
    for (const Want want : {Want::touch, Want::volume, Want::wrench}) {
      const QueryOptions options{want, Estimator::volume_true};
      QueryResult expected;
      context.run(swept.queries.data(), count, options, expected);
      std::vector<Overlap> overlaps(count);
      context.sweep(swept.pair, swept.asMatrices(), options, overlaps.data());
      std::size_t touching = 0;
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_TRUE(sameBits(overlaps[i], expected.overlaps[i])) << i;
        touching += overlaps[i].pair_count > 0;
      }
      if (count > 1) {
        EXPECT_GT(touching, count / 10);
        EXPECT_LT(touching, count);
      }
    }
  }
  EXPECT_EQ(context.lastBackend(), GetParam());
}

TEST_P(SweepConformance, IsWhatBruteForceSays) {
  QueryContext context = makeContext();
  const Swept swept(cases(30, 8));
  for (const Poses& poses : {swept.asMatrices(), swept.asQuaternions()}) {
    std::vector<Overlap> overlaps(poses.count);
    context.sweep(swept.pair, poses, {Want::contacts, Estimator::raw}, overlaps.data());
    for (std::size_t i = 0; i < poses.count; ++i)
      EXPECT_EQ(differenceInSums(bruteForce(swept.queries[i], Estimator::raw), overlaps[i], 1e-9), "") << i;
  }
}

TEST_P(SweepConformance, HasTheSameBitsOnTheCpuAndOnAllDevices) {
  const std::size_t count = cases(5000, 40);
  const Swept swept(count);
  std::vector<Overlap> one(count), all(count);
  QueryContext({Backend::cpu, 1}).sweep(swept.pair, swept.asQuaternions(), {}, one.data());
  QueryContextOptions options;
  options.backend = GetParam();
  options.device = kAllDevices;
  QueryContext context(options);
  context.sweep(swept.pair, swept.asQuaternions(), {}, all.data());
  for (std::size_t i = 0; i < count; ++i) ASSERT_TRUE(sameBits(one[i], all[i])) << i;
  for (const Want want : {Want::wrench, Want::contacts, Want::pairs}) {
    QueryResult split, single;
    context.run(swept.queries.data(), count, {want, Estimator::volume_true}, split);
    makeContext().run(swept.queries.data(), count, {want, Estimator::volume_true}, single);
    expectSame(split, single);
  }
}

TEST_P(SweepConformance, NamesTheFirstPoseThatIsNone) {
  QueryContext context = makeContext();
  const std::size_t count = cases(40000, 40), bad = count - 5;
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    const char* name;
    ErrorCode code;
    std::function<void(double*)> spoil;  ///< the numbers of a matrix
  };
  const Case cases[] = {
      {"NaN", ErrorCode::not_finite, [](double* m) { m[5] = kNaN; }},
      {"infinite", ErrorCode::not_finite, [](double* m) { m[3] = std::numeric_limits<double>::infinity(); }},
      {"last row", ErrorCode::bad_argument, [](double* m) { m[13] = 0.5; }},
      {"NaN in the last row", ErrorCode::not_finite, [](double* m) { m[15] = kNaN; }},
      {"transposed", ErrorCode::bad_argument, [](double* m) { m[15] = 0; }},
      {"shear", ErrorCode::bad_argument, [](double* m) { m[1] += 0.01; }},
      {"reflection", ErrorCode::bad_argument,
       [](double* m) {
         for (const int i : {0, 4, 8}) m[i] = -m[i];
       }},
      {"overflow", ErrorCode::bad_argument, [](double* m) { m[0] = 1e300; }},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    Swept swept(count);
    for (const std::size_t i : {bad, bad + 3}) c.spoil(swept.matrices.data() + 16 * i);
    std::vector<Overlap> overlaps(count);
    try {
      context.sweep(swept.pair, swept.asMatrices(), {}, overlaps.data());
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), c.code) << error.what();
      EXPECT_NE(std::string(error.what()).find("query " + std::to_string(bad) + ": "), std::string::npos)
          << error.what();
    }
  }
  Swept swept(3);
  swept.quaternions[6] *= 1.1;
  std::vector<Overlap> overlaps(3);
  EXPECT_THROW(context.sweep(swept.pair, swept.asQuaternions(), {}, overlaps.data()), Error);
  context.sweep(swept.pair, swept.asMatrices(), {}, overlaps.data());  // it lives on
  EXPECT_TRUE(sameBits(overlaps[1], context.overlap(swept.queries[1])));
}

TEST_P(SweepConformance, RefusesWhatIsNoSweep) {
  QueryContext context = makeContext();
  const Swept swept(3);
  std::vector<Overlap> overlaps(3);
  EXPECT_NO_THROW(context.sweep(swept.pair, {}, {}, nullptr));  // nothing to do
  EXPECT_THROW(context.sweep(swept.pair, swept.asMatrices(), {}, nullptr), Error);
  EXPECT_THROW(context.sweep(swept.pair, {3, nullptr, swept.positions.data(), nullptr}, {}, overlaps.data()),
               Error);
  EXPECT_THROW(context.sweep({}, swept.asMatrices(), {}, overlaps.data()), Error);
  PairQuery bad = swept.pair;
  bad.placement_b.scale = -1;
  EXPECT_THROW(context.sweep(bad, swept.asMatrices(), {}, overlaps.data()), Error);
  context.start(swept.queries.data(), 1, {});
  EXPECT_THROW(context.sweep(swept.pair, swept.asMatrices(), {}, overlaps.data()), Error);
  QueryResult result;
  context.wait(result);
}

TEST_P(SweepConformance, InAStreamNeedsArraysThatTheBackendReaches) {
  QueryContext context = makeContext();
  EXPECT_NO_THROW(context.waitSweep());  // nothing is under way
  const Swept swept(20);
  std::vector<Overlap> expected(20), overlaps(20), more(20);
  context.sweep(swept.pair, swept.asMatrices(), {}, expected.data());
  context.startSweep(swept.pair, swept.asMatrices(), {}, overlaps.data());
  context.startSweep(swept.pair, swept.asMatrices(), {}, more.data());
  if (GetParam() == Backend::cpu) {
    EXPECT_THROW(context.sweep(swept.pair, swept.asMatrices(), {}, more.data()), Error);  // under way
    context.waitSweep();
    for (std::size_t i = 0; i < 20; ++i) {
      EXPECT_TRUE(sameBits(overlaps[i], expected[i])) << i;
      EXPECT_TRUE(sameBits(more[i], expected[i])) << i;
    }
    int stream = 0;
    context.startSweep(swept.pair, swept.asMatrices(), {}, overlaps.data(), &stream);
  }
  EXPECT_THROW(context.waitSweep(), Error);
  EXPECT_TRUE(sameBits(context.overlap(swept.queries[1]), expected[1]));  // it lives on
}

INNERSPHERE_FOR_EACH_BACKEND(SweepConformance);

TEST(Devices, ThatAreNotThereAreAnError) {
  QueryContextOptions options;
  options.device = kAllDevices - 1;
  EXPECT_THROW(QueryContext{options}, Error);
  options.backend = Backend::cuda;
  options.device = cudaDeviceCount();
  EXPECT_THROW(QueryContext{options}, Error);
  EXPECT_EQ(cudaDeviceCount() > 0, cudaAvailable());
}

}  // namespace
}  // namespace innersphere::test
