// Pairs that come and go keep their order.
#include "pair_cache/pair_list.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <vector>

namespace innersphere::test {
namespace {

struct Pair {
  std::size_t list_index = 0;
  int visits = 0;
};

TEST(PairList, HasThoseThatAreLeftInTheOrderInWhichTheyCame) {
  std::mt19937 engine(1);
  std::deque<Pair> all;
  std::vector<Pair*> expected;
  PairList<Pair> list;
  // First more come, then more go, until all have gone.
  for (int i = 0; i < 3000 || !expected.empty(); ++i) {
    const bool comes = i < 3000 && engine() % 3 < (i < 1500 ? 2 : 1);
    if (expected.empty() || comes) {
      expected.push_back(&all.emplace_back());
      list.add(expected.back());
    } else {
      const auto which = expected.begin() + static_cast<std::ptrdiff_t>(engine() % expected.size());
      list.remove(*which);
      expected.erase(which);
    }
    std::vector<Pair*> found;
    list.forEach([&](Pair& pair) { found.push_back(&pair); });
    ASSERT_EQ(found, expected) << i;
  }
}

TEST(PairList, ThreadsVisitEachOnce) {
  std::vector<Pair> pairs(1000);
  PairList<Pair> list;
  for (Pair& pair : pairs) list.add(&pair);
  for (std::size_t i = 0; i < pairs.size(); i += 3) list.remove(&pairs[i]);
  list.forEachInParallel([](Pair& pair) { ++pair.visits; });
  for (std::size_t i = 0; i < pairs.size(); ++i) EXPECT_EQ(pairs[i].visits, i % 3 == 0 ? 0 : 1) << i;
}

}  // namespace
}  // namespace innersphere::test
