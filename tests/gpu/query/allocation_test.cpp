// After warm-up a query on the CPU allocates nothing.
#include "allocation_counter.hpp"
#include "conformance.hpp"

namespace innersphere::test {
namespace {

class Allocation : public testing::TestWithParam<int> {};

TEST_P(Allocation, NoneAfterWarmUp) {
  QueryContext context({Backend::cpu, GetParam()});
  const auto a = makeModel(randomSpheres(2000, 0.2, 30, 1), true),
             b = makeModel(randomSpheres(300, 0.3, 20, 2), true);
  Random random(3);
  std::vector<PairQuery> queries(20);
  for (PairQuery& query : queries) {
    query.a = a.get();
    query.b = b.get();
    query.placement_b = randomPlacement(random, random.uniform(0, 1));
    query.margin = 0.001;
  }
  QueryResult result;
  for (Want want :
       {Want::touch, Want::volume, Want::wrench, Want::contacts_of_a, Want::contacts, Want::pairs}) {
    const auto run = [&] {
      context.run(queries.data(), queries.size(), {want, Estimator::volume_true}, result);
    };
    run();
    run();
    const std::size_t before = allocations();
    for (int i = 0; i < 3; ++i) run();
    EXPECT_EQ(allocations() - before, 0u) << static_cast<int>(want);
    context.overlap(queries[0]);
    const std::size_t single = allocations();
    context.overlap(queries[1]);
    EXPECT_EQ(allocations() - single, 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Cpu, Allocation, testing::Values(1, 2));

}  // namespace
}  // namespace innersphere::test
