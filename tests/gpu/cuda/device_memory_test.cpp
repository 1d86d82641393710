// What happens when a device has no memory left or is lost, and that nobody asks for memory without need.
#include <cstdlib>

#include "allocation_counter.hpp"
#include "conformance.hpp"
#include "cuda_calls.hpp"
#include "innersphere/error.hpp"
#include "lost_device.hpp"

namespace innersphere::test {
namespace {

constexpr Want kWants[] = {Want::touch,         Want::volume,   Want::wrench,
                           Want::contacts_of_a, Want::contacts, Want::pairs};

/// Models that no grid was built of, and some pairs of them.
struct Bodies {
  std::shared_ptr<CollisionModel> a = makeModel(randomSpheres(500, 0.2, 30, 1), true),
                                  b = makeModel(randomSpheres(300, 0.3, 20, 2), true);
  std::vector<PairQuery> queries;

  Bodies() : queries(8) {
    Random random(3);
    for (PairQuery& query : queries) {
      query.a = a.get();
      query.b = b.get();
      query.placement_b = randomPlacement(random, random.uniform(0, 0.5));
    }
  }

  QueryResult run(QueryContext& context, Want want) const {
    QueryResult result;
    context.run(queries.data(), queries.size(), {want, Estimator::volume_true}, result);
    return result;
  }
};

class DeviceMemory : public testing::Test {
 protected:
  void SetUp() override { needDevice(); }
  void TearDown() override { failNoCudaAllocation(); }
};

TEST_F(DeviceMemory, AnyAllocationMayFail) {
  for (const Want want : {Want::wrench, Want::contacts, Want::pairs}) {
    std::size_t others = 0;
    for (bool failed = true; failed; others += cases(1, 9)) {
      SCOPED_TRACE(others);
      const Bodies bodies;
      QueryContext context({Backend::cuda, 1}), cpu({Backend::cpu, 1});
      failed = false;
      failCudaAllocationAfter(others);
      try {
        bodies.run(context, want);
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::device_out_of_memory) << error.what();
        failed = true;
      }
      failNoCudaAllocation();
      expectSame(bodies.run(context, want), bodies.run(cpu, want));  // now there is memory again
    }
    EXPECT_GT(others, 20u);
  }
}

TEST_F(DeviceMemory, NoneIsTakenAfterWarmUp) {
  const Bodies bodies;
  QueryContext context({Backend::cuda, 1});
  QueryResult result;
  for (const Want want : kWants) {
    const QueryOptions options{want, Estimator::volume_true};
    const auto run = [&] {
      context.run(bodies.queries.data(), bodies.queries.size(), options, result);
      context.overlap(bodies.queries[0], options);
    };
    for (int warm_up = 0; warm_up < 3; ++warm_up) run();
    const std::size_t of_device = cudaAllocations(), of_host = allocations();
    for (int again = 0; again < 3; ++again) run();
    EXPECT_EQ(cudaAllocations(), of_device) << static_cast<int>(want);
    EXPECT_EQ(allocations(), of_host) << static_cast<int>(want);
  }
}

/// In a process of its own: a CUDA context does not come back.
TEST_F(DeviceMemory, ALostDeviceIsNamed) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  const auto check = [] {
    const Bodies bodies;
    QueryContext context({Backend::cuda, 1}), cpu({Backend::cpu, 1});
    const QueryResult before = bodies.run(context, Want::contacts);
    loseDevice();
    for (int i = 0; i < 2; ++i) {
      try {
        bodies.run(context, Want::contacts);
        std::exit(1);
      } catch (const Error& error) {
        if (error.code() != ErrorCode::device_error) std::exit(2);
      }
    }
    expectSame(bodies.run(cpu, Want::contacts), before);
    std::exit(testing::Test::HasFailure() ? 3 : 0);
  };
  EXPECT_EXIT(check(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace innersphere::test
