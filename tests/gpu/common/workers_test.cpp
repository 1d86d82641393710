// The threads of a context.
#include <gtest/gtest.h>

#include <atomic>
#include <cfenv>

#include "common/workers.hpp"

namespace innersphere::test {
namespace {

TEST(Workers, ComputeInTheFloatingPointModeOfTheCaller) {
  Workers workers(4);
  std::atomic<int> calls{0}, upward{0};
  const auto look = [&](std::size_t, std::size_t) {
    ++calls;
    if (std::fegetround() == FE_UPWARD) ++upward;
  };
  workers.forRanges(1000, 1, look);
  EXPECT_EQ(upward, 0);
  calls = 0;
  std::fesetround(FE_UPWARD);
  workers.forRanges(1000, 1, look);
  std::fesetround(FE_TONEAREST);
  EXPECT_GT(calls, 1);
  EXPECT_EQ(upward, calls);
}

}  // namespace
}  // namespace innersphere::test
