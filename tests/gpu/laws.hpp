// Laws that hold for whatever a seed makes.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>

#ifdef INNERSPHERE_RAPIDCHECK
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#endif

namespace innersphere::test {

/// For seeds that rapidcheck picks, or for the first hundred where it is not installed.
inline void checkLaw(const std::function<bool(std::uint64_t)>& law) {
#ifdef INNERSPHERE_RAPIDCHECK
  EXPECT_TRUE(rc::check([&](std::uint32_t seed) { RC_ASSERT(law(seed)); }));
#else
  for (std::uint64_t seed = 0; seed < 100; ++seed) EXPECT_TRUE(law(seed)) << "seed " << seed;
#endif
}

}  // namespace innersphere::test
