// Queries in halves: the same bits as at once, errors where they are waited for.
#include <functional>
#include <limits>

#include "conformance.hpp"
#include "innersphere/error.hpp"

namespace innersphere::test {
namespace {

class AsynchronousConformance : public Conformance {
 protected:
  std::shared_ptr<CollisionModel> a = makeModel(randomSpheres(2000, 0.2, 30, 1), true);
  std::shared_ptr<CollisionModel> b = makeModel(randomSpheres(300, 0.3, 20, 2), true);

  std::vector<PairQuery> batch(std::size_t count, unsigned seed) const {
    Random random(seed);
    std::vector<PairQuery> queries(count);
    for (PairQuery& query : queries) {
      query.a = a.get();
      query.b = b.get();
      query.placement_b = randomPlacement(random, random.uniform(0, 1.5));
    }
    return queries;
  }

  static ErrorCode codeOf(const std::function<void()>& f) {
    try {
      f();
    } catch (const Error& error) {
      return error.code();
    }
    ADD_FAILURE() << "no error";
    return ErrorCode::cancelled;
  }
};

TEST_P(AsynchronousConformance, SameBitsAsAtOnce) {
  QueryContext at_once = makeContext(), in_halves = makeContext();
  for (std::size_t count : {std::size_t{0}, std::size_t{1}, cases(60, 6)}) {
    const std::vector<PairQuery> queries = batch(count, 11);
    for (Want want :
         {Want::touch, Want::volume, Want::wrench, Want::contacts_of_a, Want::contacts, Want::pairs}) {
      const QueryOptions options{want, Estimator::volume_true};
      QueryResult x, y, z;
      at_once.run(queries.data(), count, options, x);
      std::vector<PairQuery> copy = queries;
      in_halves.start(copy.data(), count, options);
      copy.assign(count, PairQuery{});  // it has what it needs
      in_halves.wait(y);
      expectSame(x, y);
      in_halves.start(queries.data(), count, options);
      while (!in_halves.ready()) continue;
      EXPECT_TRUE(in_halves.ready());
      in_halves.wait(z);
      expectSame(x, z);
    }
  }
}

TEST_P(AsynchronousConformance, OnePair) {
  QueryContext context = makeContext();
  for (const PairQuery& query : batch(10, 12)) {
    const Overlap at_once = context.overlap(query);
    context.startOverlap(query);
    EXPECT_TRUE(sameBits(context.waitOverlap(), at_once));
  }
}

TEST_P(AsynchronousConformance, SeveralContextsAtATime) {
  constexpr std::size_t kContexts = 4;
  std::vector<std::vector<PairQuery>> queries;
  std::vector<QueryContext> contexts;
  for (unsigned i = 0; i < kContexts; ++i) {
    queries.push_back(batch(cases(50, 3) + cases(10, 1) * i, i));
    contexts.push_back(makeContext());
  }
  const QueryOptions options{Want::contacts, Estimator::raw};
  for (std::size_t i = 0; i < kContexts; ++i)
    contexts[i].start(queries[i].data(), queries[i].size(), options);
  for (std::size_t i = kContexts; i-- > 0;) {
    QueryResult x, y;
    contexts[i].wait(x);
    makeContext().run(queries[i].data(), queries[i].size(), options, y);
    expectSame(x, y);
  }
}

TEST_P(AsynchronousConformance, ErrorsAreThrownByWait) {
  QueryContext context = makeContext();
  const std::vector<PairQuery> good = batch(cases(20, 8), 13);
  QueryResult expected, result;
  context.run(good.data(), good.size(), {}, expected);
  result = expected;
  std::vector<PairQuery> bad = good;
  bad[7].placement_b.translation[1] = std::numeric_limits<double>::quiet_NaN();
  context.start(bad.data(), bad.size(), {});
  EXPECT_TRUE(context.ready());
  EXPECT_EQ(codeOf([&] { context.wait(result); }), ErrorCode::not_finite);
  expectSame(result, expected);
  context.run(good.data(), good.size(), {}, result);
  expectSame(result, expected);
}

TEST_P(AsynchronousConformance, OneQueryUnderWay) {
  QueryContext context = makeContext();
  QueryResult result, expected;
  EXPECT_EQ(codeOf([&] { context.wait(result); }), ErrorCode::bad_argument);
  const std::vector<PairQuery> queries = batch(cases(20, 4), 14);
  context.start(queries.data(), queries.size(), {});
  context.start(queries.data(), 1, {});
  EXPECT_EQ(codeOf([&] { context.wait(result); }), ErrorCode::bad_argument);
  context.wait(result);  // the first is not lost
  context.run(queries.data(), queries.size(), {}, expected);
  expectSame(result, expected);
}

TEST_P(AsynchronousConformance, MayBeLeftAlone) {
  const std::vector<PairQuery> queries = batch(cases(200, 8), 15);
  for (int i = 0; i < 3; ++i) {
    QueryContext context = makeContext();
    context.start(queries.data(), queries.size(), {Want::contacts, Estimator::raw});
  }
}

/// The partners of a large sphere are summed side by side.
TEST_P(AsynchronousConformance, ContactsOfALargeSphere) {
  Random random(16);
  std::vector<Sphere> small(cases(9000, 1500));
  for (Sphere& s : small) {
    const auto at = [&] { return static_cast<float>(random.uniform(-1, 1)); };
    s = {at(), at(), at(), 0.01f};
  }
  const auto large = makeModel({{0, 0, 0, 0.8f}}), many = makeModel(small);
  Scene scene(large, many);
  QueryContext context = makeContext(), cpu({Backend::cpu, 1});
  QueryResult x, y;
  context.run(&scene.query, 1, {Want::contacts, Estimator::raw}, x);
  cpu.run(&scene.query, 1, {Want::contacts, Estimator::raw}, y);
  expectSame(x, y);
  ASSERT_EQ(x.contacts_a.items.size(), 1u);
  EXPECT_GT(x.contacts_b.items.size(), 300u);
  EXPECT_NEAR(x.contacts_a.items[0].volume, x.overlaps[0].volume, 1e-6 * x.overlaps[0].volume);
}

INNERSPHERE_FOR_EACH_BACKEND(AsynchronousConformance);

}  // namespace
}  // namespace innersphere::test
