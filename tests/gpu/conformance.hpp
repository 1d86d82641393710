// The suite that every backend must pass.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>

#include "cases.hpp"
#include "device.hpp"
#include "innersphere/query.hpp"
#include "oracle.hpp"
#include "sphere_sets.hpp"

namespace innersphere::test {

/// Each test runs once for each backend.
class Conformance : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    if (GetParam() == Backend::cuda) needDevice();
  }

  QueryContext makeContext(int threads = 0) const { return QueryContext({GetParam(), threads}); }
};

#define INNERSPHERE_FOR_EACH_BACKEND(Suite)                                          \
  INSTANTIATE_TEST_SUITE_P(Cpu, Suite, testing::Values(innersphere::Backend::cpu),   \
                           [](const auto&) { return std::string("cpu"); });          \
  INSTANTIATE_TEST_SUITE_P(Cuda, Suite, testing::Values(innersphere::Backend::cuda), \
                           [](const auto&) { return std::string("cuda"); })

/// Two models that live as long as the query.
struct Scene {
  std::shared_ptr<CollisionModel> a, b;
  PairQuery query;

  Scene(std::shared_ptr<CollisionModel> model_a, std::shared_ptr<CollisionModel> model_b)
      : a(model_a), b(model_b) {
    query.a = a.get();
    query.b = b.get();
  }
};

/// Runs pairs and wrench and compares all with the oracle.
inline void expectOracle(QueryContext& context, const PairQuery& query, Estimator estimator = Estimator::raw,
                         double tolerance = 1e-9) {
  const Oracle oracle = bruteForce(query, estimator);
  QueryResult result;
  context.run(&query, 1, {Want::pairs, estimator}, result);
  EXPECT_EQ(differenceInPairs(oracle, result.pairs.items.data(), result.pairs.items.size()), "");
  EXPECT_EQ(differenceInSums(oracle, result.overlaps[0], tolerance), "");
}

inline bool sameBits(const Overlap& a, const Overlap& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

template <typename T>
void expectSameRanges(const QueryResult::Ranges<T>& x, const QueryResult::Ranges<T>& y) {
  EXPECT_EQ(x.first, y.first);
  ASSERT_EQ(x.items.size(), y.items.size());
  EXPECT_TRUE(x.items.empty() ||
              std::memcmp(x.items.data(), y.items.data(), x.items.size() * sizeof(T)) == 0);
}

/// All bits of all results.
inline void expectSame(const QueryResult& x, const QueryResult& y) {
  ASSERT_EQ(x.overlaps.size(), y.overlaps.size());
  for (std::size_t i = 0; i < x.overlaps.size(); ++i)
    EXPECT_TRUE(sameBits(x.overlaps[i], y.overlaps[i])) << i;
  expectSameRanges(x.pairs, y.pairs);
  expectSameRanges(x.contacts_a, y.contacts_a);
  expectSameRanges(x.contacts_b, y.contacts_b);
}

}  // namespace innersphere::test
