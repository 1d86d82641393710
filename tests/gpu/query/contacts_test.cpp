// The contacts of each sphere against brute force.
#include <cmath>

#include "conformance.hpp"

namespace innersphere::test {
namespace {

class ContactsConformance : public Conformance {};

void expectContacts(const std::vector<OracleContact>& expected,
                    const QueryResult::Ranges<SphereContact>& contacts) {
  std::size_t k = contacts.first[0];
  for (std::uint32_t i = 0; i < expected.size(); ++i) {
    if (expected[i].volume == 0) continue;
    ASSERT_LT(k, contacts.first[1]);
    const SphereContact& contact = contacts.items[k++];
    const double volume = static_cast<double>(expected[i].volume);
    EXPECT_EQ(contact.sphere, i);
    EXPECT_NEAR(contact.volume, volume, 1e-6 * volume);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(contact.centroid[axis], static_cast<double>(expected[i].moment[axis] / expected[i].volume),
                  1e-6);
      EXPECT_NEAR(contact.area[axis], static_cast<double>(expected[i].area[axis]),
                  1e-6 * static_cast<double>(expected[i].area_size));
    }
  }
  EXPECT_EQ(k, contacts.first[1]);
}

TEST_P(ContactsConformance, EqualBruteForce) {
  QueryContext context = makeContext();
  const auto a = makeModel(randomSpheres(300, 0.3, 20, 1), true),
             b = makeModel(randomSpheres(200, 0.3, 20, 2), true);
  Random random(5);
  for (std::size_t pose = 0; pose < cases(10, 2); ++pose) {
    Scene scene(a, b);
    scene.query.placement_a = randomPlacement(random, 0.3);
    scene.query.placement_b = randomPlacement(random, 0.5, 0.8);
    scene.query.margin = pose % 2 ? 0.01 : 0;
    const Oracle oracle = bruteForce(scene.query, Estimator::volume_true);
    QueryResult result;
    context.run(&scene.query, 1, {Want::contacts, Estimator::volume_true}, result);
    EXPECT_EQ(differenceInSums(oracle, result.overlaps[0]), "");
    expectContacts(oracle.contacts_a, result.contacts_a);
    expectContacts(oracle.contacts_b, result.contacts_b);
    EXPECT_TRUE(result.pairs.items.empty());
    QueryResult of_a;
    context.run(&scene.query, 1, {Want::contacts_of_a, Estimator::volume_true}, of_a);
    expectSameRanges(of_a.contacts_a, result.contacts_a);
    EXPECT_TRUE(of_a.contacts_b.items.empty());
    EXPECT_EQ(of_a.contacts_b.first, (std::vector<std::size_t>{0, 0}));
  }
}

TEST_P(ContactsConformance, AreTheSameWithoutSums) {
  QueryContext context = makeContext();
  const auto a = makeModel(randomSpheres(300, 0.3, 20, 3), true),
             b = makeModel(randomSpheres(200, 0.3, 20, 4), true);
  Scene scene(a, b);
  for (const Want want : {Want::contacts, Want::contacts_of_a, Want::wrench}) {
    for (const double margin : {0.0, 0.3}) {
      scene.query.margin = margin;
      QueryResult with, without;
      context.run(&scene.query, 1, {want, Estimator::raw}, with);
      context.run(&scene.query, 1, {want, Estimator::raw, false}, without);
      expectSameRanges(without.contacts_a, with.contacts_a);
      expectSameRanges(without.contacts_b, with.contacts_b);
      Overlap expected = with.overlaps[0];
      EXPECT_GT(expected.volume, 0);
      if (want != Want::wrench) {
        expected = Overlap();
        expected.pair_count = with.overlaps[0].pair_count;
      }
      EXPECT_TRUE(sameBits(without.overlaps[0], expected));
    }
  }
}

TEST_P(ContactsConformance, RangesFollowTheBatch) {
  QueryContext context = makeContext();
  const auto model = makeModel({{0, 0, 0, 1}, {3, 0, 0, 0.5}});
  std::vector<PairQuery> queries(4);
  const double distance[4] = {0.1, 100, 3.2, 1.9};
  for (std::size_t i = 0; i < 4; ++i) {
    queries[i].a = queries[i].b = model.get();
    queries[i].placement_b = at({distance[i], 0, 0});
  }
  QueryResult result;
  context.run(queries.data(), 4, {Want::contacts, Estimator::raw}, result);
  EXPECT_EQ(result.contacts_a.first,
            (std::vector<std::size_t>{0, 2, 2, 3, 5}));  // of both, none, the small one, both
  EXPECT_EQ(result.contacts_b.first, (std::vector<std::size_t>{0, 2, 2, 3, 4}));
  EXPECT_EQ(result.contacts_a.items[2].sphere, 1u);
  EXPECT_EQ(result.contacts_b.items[2].sphere, 0u);
}

TEST_P(ContactsConformance, BatchesWithoutOverlapHaveNoneWhateverWasAskedBefore) {
  QueryContext context = makeContext();
  const auto model = makeModel({{0, 0, 0, 1}, {3, 0, 0, 0.5}});
  const auto batchAt = [&](std::size_t count, double distance) {
    std::vector<PairQuery> queries(count);
    for (PairQuery& query : queries) {
      query.a = query.b = model.get();
      query.placement_b = at({distance, 0, 0});
    }
    return queries;
  };
  for (const Want want : {Want::contacts, Want::pairs}) {
    QueryResult result;
    for (const auto& queries : {batchAt(200, 0.1), batchAt(1, 0.1), batchAt(100, 1000)})
      context.run(queries.data(), queries.size(), {want, Estimator::raw}, result);
    const std::vector<std::size_t> none(101, 0);
    if (want == Want::pairs) {
      EXPECT_EQ(result.pairs.first, none);
      EXPECT_TRUE(result.pairs.items.empty());
    } else {
      EXPECT_EQ(result.contacts_a.first, none);
      EXPECT_EQ(result.contacts_b.first, none);
      EXPECT_TRUE(result.contacts_a.items.empty() && result.contacts_b.items.empty());
    }
  }
}

TEST_P(ContactsConformance, ListsOfAHeapHaveTheSameBitsAsThoseOfEachPairAlone) {
  // Millions of pairs of spheres, more than go through together; some queries alone have more, some none.
  const auto model = makeModel(lattice(cases(12, 6), 0.1));
  Random random(11);
  std::vector<PairQuery> queries(cases(24, 6));
  for (std::size_t i = 0; i < queries.size(); ++i) {
    queries[i].a = queries[i].b = model.get();
    queries[i].placement_b = at((i % 3 == 2 ? 100 : 0.5) * random.direction());
    queries[i].margin = i % 7 == 3 ? 0.8 : 0.3;
  }
  QueryContext context = makeContext();
  for (const Want want : {Want::contacts, Want::pairs}) {
    QueryResult together;
    for (int i = 0; i < 2; ++i) context.run(queries.data(), queries.size(), {want, Estimator::raw}, together);
    const std::size_t found = want == Want::pairs ? together.pairs.items.size() : 0;
    if (want == Want::pairs && queries.size() == 24) EXPECT_GT(found, 2'000'000u);
    const auto expectEqual = [](const auto& alone, const auto& all, std::size_t i) {
      const std::size_t count = all.first[i + 1] - all.first[i];
      ASSERT_EQ(alone.items.size(), count) << i;
      if (count > 0)
        EXPECT_EQ(std::memcmp(alone.items.data(), &all.items[all.first[i]], count * sizeof alone.items[0]), 0)
            << i;
    };
    for (std::size_t i = 0; i < queries.size(); ++i) {
      QueryResult alone;
      makeContext().run(&queries[i], 1, {want, Estimator::raw}, alone);
      EXPECT_TRUE(sameBits(alone.overlaps[0], together.overlaps[i])) << i;
      expectEqual(alone.pairs, together.pairs, i);
      expectEqual(alone.contacts_a, together.contacts_a, i);
      expectEqual(alone.contacts_b, together.contacts_b, i);
    }
  }
}

INNERSPHERE_FOR_EACH_BACKEND(ContactsConformance);

}  // namespace
}  // namespace innersphere::test
