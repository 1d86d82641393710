// Input that no query can answer is named, and the context lives on.
#include <functional>
#include <limits>

#include "conformance.hpp"
#include "innersphere/error.hpp"

namespace innersphere::test {
namespace {

class BadInputConformance : public Conformance {};

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST_P(BadInputConformance, IsAnErrorWithTheQuerysNumber) {
  QueryContext context = makeContext();
  const auto model = makeModel(randomSpheres(50, 0.3, 20, 1));
  struct Case {
    const char* name;
    ErrorCode code;
    std::function<void(PairQuery&)> spoil;
  };
  const Case cases[] = {
      {"null model", ErrorCode::bad_argument, [](PairQuery& q) { q.b = nullptr; }},
      {"NaN rotation", ErrorCode::not_finite, [](PairQuery& q) { q.placement_a.rotation[4] = kNaN; }},
      {"infinite translation", ErrorCode::not_finite,
       [](PairQuery& q) { q.placement_b.translation[2] = kInf; }},
      {"NaN scale", ErrorCode::not_finite, [](PairQuery& q) { q.placement_b.scale = kNaN; }},
      {"NaN margin", ErrorCode::not_finite, [](PairQuery& q) { q.margin = kNaN; }},
      {"zero scale", ErrorCode::bad_argument, [](PairQuery& q) { q.placement_a.scale = 0; }},
      {"negative scale", ErrorCode::bad_argument, [](PairQuery& q) { q.placement_a.scale = -1; }},
      {"scale beyond double", ErrorCode::bad_argument,
       [](PairQuery& q) { q.placement_a.scale = q.placement_b.scale = 1e150; }},
      {"scale below double", ErrorCode::bad_argument, [](PairQuery& q) { q.placement_a.scale = 1e-200; }},
      {"too different scales", ErrorCode::bad_argument, [](PairQuery& q) { q.placement_a.scale = 1e40; }},
      {"negative margin", ErrorCode::bad_argument, [](PairQuery& q) { q.margin = -1e-9; }},
      {"huge margin", ErrorCode::bad_argument, [](PairQuery& q) { q.margin = 1e200; }},
      {"shear", ErrorCode::bad_argument, [](PairQuery& q) { q.placement_a.rotation[1] = 0.01; }},
      {"scaled rotation", ErrorCode::bad_argument,
       [](PairQuery& q) {
         for (double& x : q.placement_b.rotation) x *= 2;
       }},
      {"zero rotation", ErrorCode::bad_argument, [](PairQuery& q) { q.placement_b.rotation = {}; }},
      {"reflection", ErrorCode::bad_argument, [](PairQuery& q) { q.placement_b.rotation[0] = -1; }},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    std::vector<PairQuery> queries(3);
    for (PairQuery& query : queries) query.a = query.b = model.get();
    QueryResult result;
    const auto run = [&] { context.run(queries.data(), queries.size(), {}, result); };
    run();
    const Overlap before = result.overlaps[1];
    c.spoil(queries[1]);
    try {
      run();
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), c.code) << error.what();
      EXPECT_NE(std::string(error.what()).find("query 1: "), std::string::npos) << error.what();
    }
    queries[1] = queries[0];
    run();
    EXPECT_TRUE(sameBits(before, result.overlaps[1]));
  }
}

TEST_P(BadInputConformance, NullQueries) {
  QueryContext context = makeContext();
  QueryResult result;
  EXPECT_THROW(context.run(nullptr, 1, {}, result), Error);
}

INNERSPHERE_FOR_EACH_BACKEND(BadInputConformance);

TEST(BadInput, NumbersOfThreads) {
  for (const int threads : {-1, kMostThreads + 1, 10'000'000, 100'000'000, std::numeric_limits<int>::max()}) {
    try {
      QueryContext context({Backend::cpu, threads});
      FAIL() << threads;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      EXPECT_NE(std::string(error.what()).find(std::to_string(threads)), std::string::npos) << error.what();
    }
  }
  QueryContext most({Backend::cpu, kMostThreads});
  const auto model = makeModel(randomSpheres(50, 0.3, 20, 1));
  Scene scene(model, model);
  EXPECT_GT(most.overlap(scene.query).pair_count, 0u);
}

TEST(BadInput, CudaByNameIsNeverReplaced) {
  if (cudaAvailable()) return;  // then the conformance suite runs there
  try {
    QueryContext context({Backend::cuda, 0});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::no_device) << error.what();
  }
}

TEST(Automatic, SmallWorkStaysOnTheCpu) {
  QueryContext context;
  const auto model = makeModel(randomSpheres(50, 0.3, 20, 1));
  Scene scene(model, model);
  EXPECT_GT(context.overlap(scene.query).pair_count, 0u);
  EXPECT_EQ(context.lastBackend(), Backend::cpu);
}

}  // namespace
}  // namespace innersphere::test
