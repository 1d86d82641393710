// The same bits, whatever the threads, the batch and the roles; and both backends alike.
#include <algorithm>
#include <cmath>
#include <thread>

#include "conformance.hpp"

namespace innersphere::test {
namespace {

class DeterminismConformance : public Conformance {
 protected:
  std::shared_ptr<CollisionModel> a = makeModel(randomSpheres(2000, 0.2, 30, 1), true);
  std::shared_ptr<CollisionModel> b = makeModel(randomSpheres(300, 0.3, 20, 2), true);

  /// A batch of pairs of either model, at random poses, prefixes, scales and margins; some touch, some do
  /// not.
  std::vector<PairQuery> batch(std::size_t count) const {
    Random random(11);
    std::vector<PairQuery> queries(count);
    for (PairQuery& query : queries) {
      query.a = random.uniform() < 0.5 ? a.get() : b.get();
      query.b = random.uniform() < 0.5 ? a.get() : b.get();
      query.placement_a = randomPlacement(random, random.uniform(0, 1.5), random.uniform(0.5, 2));
      query.placement_b = randomPlacement(random, random.uniform(0, 1.5), random.uniform(0.5, 2));
      query.prefix_a = random.uniform() < 0.5 ? 0 : 200;
      query.margin = random.uniform() < 0.5 ? 0 : random.uniform(0, 0.02);
    }
    return queries;
  }
};

TEST_P(DeterminismConformance, AnyThreadsAndRuns) {
  const std::vector<PairQuery> queries = batch(cases(60, 6));
  for (Want want :
       {Want::touch, Want::volume, Want::wrench, Want::contacts_of_a, Want::contacts, Want::pairs}) {
    QueryResult first;
    makeContext(1).run(queries.data(), queries.size(), {want, Estimator::volume_true}, first);
    std::vector<int> numbers{2, 1, 3, 8};
    numbers.resize(cases(4, 1));
    for (const int threads : numbers) {
      QueryContext context = makeContext(threads);
      QueryResult again;
      for (int run = 0; run < 2; ++run) {
        context.run(queries.data(), queries.size(), {want, Estimator::volume_true}, again);
        expectSame(first, again);
      }
    }
  }
}

/// More than a backend works on at once; and after it one pair, which may come back in another way.
TEST_P(DeterminismConformance, AnyLengthOfABatch) {
  QueryContext context = makeContext();
  std::vector<PairQuery> queries(cases(100000, 20000));
  const std::size_t near = cases(queries.size(), 30);  // at both ends
  for (std::size_t i = 0; i < queries.size(); ++i) {
    queries[i].a = a.get();
    queries[i].b = i % 2 == 0 ? a.get() : b.get();
    const bool is_near = i < near || i + near >= queries.size();
    queries[i].placement_b = at({(is_near ? 1.7 : 100) + 0.05 * static_cast<double>(i % 3), 0.1, 0});
  }
  QueryResult together;
  context.run(queries.data(), queries.size(), {Want::wrench, Estimator::raw}, together);
  std::uint64_t pairs = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const Overlap alone = context.overlap(queries[i], {Want::wrench, Estimator::raw});
    pairs += alone.pair_count;
    for (std::size_t k = i; k < queries.size(); k += 6) {
      const bool same_place = queries[k].placement_b.translation == queries[i].placement_b.translation;
      ASSERT_TRUE(sameBits(same_place ? alone : Overlap{}, together.overlaps[k])) << k;
    }
  }
  EXPECT_GT(pairs, 0u);
}

TEST_P(DeterminismConformance, TimeOfTheDevice) {
  PairQuery query;
  query.a = a.get();
  query.b = b.get();
  QueryContext context({GetParam(), 1, true}), untimed = makeContext();
  const Overlap timed = context.overlap(query);
  EXPECT_TRUE(sameBits(timed, untimed.overlap(query)));
  EXPECT_EQ(context.kernelTime() > 0, GetParam() == Backend::cuda);
  EXPECT_LT(context.kernelTime(), 10);
  EXPECT_EQ(untimed.kernelTime(), 0);
}

TEST_P(DeterminismConformance, AnyPlaceInABatch) {
  QueryContext context = makeContext();
  std::vector<PairQuery> queries = batch(cases(40, 5));
  for (Want want : {Want::contacts, Want::pairs}) {
    QueryResult together, alone;
    context.run(queries.data(), queries.size(), {want, Estimator::raw}, together);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      context.run(&queries[i], 1, {want, Estimator::raw}, alone);
      EXPECT_TRUE(sameBits(together.overlaps[i], alone.overlaps[0])) << i;
      const auto expectSlice = [&](const auto& all, const auto& one) {
        ASSERT_EQ(all.first[i + 1] - all.first[i], one.items.size());
        EXPECT_TRUE(one.items.empty() || std::memcmp(&all.items[all.first[i]], one.items.data(),
                                                     one.items.size() * sizeof one.items[0]) == 0);
      };
      expectSlice(together.pairs, alone.pairs);
      expectSlice(together.contacts_a, alone.contacts_a);
      expectSlice(together.contacts_b, alone.contacts_b);
    }
  }
}

TEST_P(DeterminismConformance, SwappingTheBodiesNegatesTheForceExactly) {
  QueryContext context = makeContext();
  std::size_t touching = 0;
  for (PairQuery query : batch(cases(40, 5))) {
    query.margin = 0;  // the margin grows A only, so it has no mirror image
    PairQuery swapped = query;
    std::swap(swapped.a, swapped.b);
    std::swap(swapped.placement_a, swapped.placement_b);
    std::swap(swapped.prefix_a, swapped.prefix_b);
    QueryResult x, y;
    context.run(&query, 1, {Want::contacts, Estimator::volume_true}, x);
    context.run(&swapped, 1, {Want::contacts, Estimator::volume_true}, y);
    const Overlap &o = x.overlaps[0], &p = y.overlaps[0];
    EXPECT_EQ(o.pair_count, p.pair_count);
    EXPECT_EQ(o.volume, p.volume);
    EXPECT_EQ(o.stiffness, p.stiffness);
    EXPECT_EQ(o.energy, p.energy);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(o.force[i], -p.force[i]);
      EXPECT_EQ(o.area[i], -p.area[i]);
    }
    ASSERT_EQ(x.contacts_a.items.size(), y.contacts_b.items.size());
    for (std::size_t k = 0; k < x.contacts_a.items.size(); ++k) {
      const SphereContact &c = x.contacts_a.items[k], &d = y.contacts_b.items[k];
      EXPECT_EQ(c.sphere, d.sphere);
      EXPECT_EQ(c.volume, d.volume);
      for (int i = 0; i < 3; ++i) EXPECT_EQ(c.area[i], -d.area[i]);
    }
    touching += o.pair_count > 0;
  }
  EXPECT_GT(touching, cases(10, 1));
}

TEST_P(DeterminismConformance, SwappingEqualBodiesNegatesTheForceExactly) {
  QueryContext context = makeContext();
  PairQuery query;
  query.a = query.b = b.get();
  query.placement_b = at({0.125, 0.25, 0});  // all radii have an equal partner
  PairQuery swapped = query;
  std::swap(swapped.placement_a, swapped.placement_b);
  const Overlap o = context.overlap(query), p = context.overlap(swapped);
  EXPECT_EQ(o.volume, p.volume);
  EXPECT_GT(o.pair_count, 100u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(o.force[i], -p.force[i]);
}

TEST_P(DeterminismConformance, CheaperWantsAgree) {
  QueryContext context = makeContext();
  const std::vector<PairQuery> queries = batch(cases(40, 8));
  QueryResult wrench, volume, touch;
  context.run(queries.data(), queries.size(), {Want::wrench, Estimator::volume_true}, wrench);
  context.run(queries.data(), queries.size(), {Want::volume, Estimator::volume_true}, volume);
  context.run(queries.data(), queries.size(), {Want::touch, Estimator::volume_true}, touch);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    EXPECT_EQ(wrench.overlaps[i].volume, volume.overlaps[i].volume);
    EXPECT_EQ(wrench.overlaps[i].centroid, volume.overlaps[i].centroid);
    EXPECT_EQ(wrench.overlaps[i].pair_count, volume.overlaps[i].pair_count);
    EXPECT_EQ(volume.overlaps[i].energy, 0);
    EXPECT_EQ(touch.overlaps[i].pair_count, wrench.overlaps[i].pair_count > 0 ? 1u : 0u);
    EXPECT_EQ(touch.overlaps[i].volume, 0);
  }
}

TEST_P(DeterminismConformance, BackendsAgree) {
  QueryContext context = makeContext(), cpu({Backend::cpu, 1});
  const std::vector<PairQuery> queries = batch(cases(200, 8));
  for (Want want : {Want::wrench, Want::contacts, Want::pairs}) {
    QueryResult x, y;
    context.run(queries.data(), queries.size(), {want, Estimator::volume_true}, x);
    cpu.run(queries.data(), queries.size(), {want, Estimator::volume_true}, y);
    expectSameRanges(x.pairs, y.pairs);
    expectSameRanges(x.contacts_a, y.contacts_a);
    expectSameRanges(x.contacts_b, y.contacts_b);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const Overlap &o = x.overlaps[i], &p = y.overlaps[i];
      EXPECT_EQ(o.pair_count, p.pair_count);
      EXPECT_EQ(o.volume, p.volume);
      EXPECT_EQ(o.stiffness, p.stiffness);
      EXPECT_EQ(o.force, p.force);
      EXPECT_EQ(o.torque, p.torque);
      EXPECT_EQ(o.area, p.area);
      EXPECT_EQ(o.centroid, p.centroid);
      EXPECT_EQ(o.energy, p.energy);
    }
  }
  EXPECT_EQ(context.lastBackend(), GetParam());
}

TEST_P(DeterminismConformance, ContextsInManyThreadsShareModels) {
  const std::vector<PairQuery> queries = batch(cases(20, 4));
  std::vector<QueryResult> results(cases(4, 2));
  std::vector<std::thread> threads;  // the first to come builds the grids, and copies them to the device
  for (QueryResult& result : results) {
    threads.emplace_back([&] {
      QueryContext context = makeContext(2);
      for (std::size_t run = 0; run < cases(3, 1); ++run) {
        context.run(queries.data(), queries.size(), {Want::contacts, Estimator::volume_true}, result);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const QueryResult& result : results) expectSame(results[0], result);
}

TEST_P(DeterminismConformance, AnyBatchSize) {
  QueryContext context = makeContext();
  QueryResult result;
  context.run(nullptr, 0, {Want::pairs, Estimator::raw}, result);
  EXPECT_TRUE(result.overlaps.empty());
  EXPECT_EQ(result.pairs.first, std::vector<std::size_t>{0});
  const std::vector<PairQuery> queries = batch(cases(500, 12));
  const std::size_t from = queries.size() / 3;
  QueryResult some;
  context.run(queries.data(), queries.size(), {Want::wrench, Estimator::raw}, result);
  context.run(queries.data() + from, 7, {Want::wrench, Estimator::raw}, some);
  for (std::size_t i = 0; i < 7; ++i) EXPECT_TRUE(sameBits(some.overlaps[i], result.overlaps[from + i]));
}

INNERSPHERE_FOR_EACH_BACKEND(DeterminismConformance);

}  // namespace
}  // namespace innersphere::test
