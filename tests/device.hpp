// Tests that need a CUDA device.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "innersphere/query.hpp"

namespace innersphere::test {

/// For SetUp() or the start of a test. Without a device the test is skipped, and says so, unless the
/// environment has INNERSPHERE_REQUIRE_GPU=1: then it fails. Return if this has made either of it.
inline void needDevice() {
  if (cudaAvailable()) return;
  const char* required = std::getenv("INNERSPHERE_REQUIRE_GPU");
  if (required && std::string(required) == "1")
    FAIL() << "INNERSPHERE_REQUIRE_GPU=1, but no CUDA device answers";
  GTEST_SKIP() << "no CUDA device answers";
}

}  // namespace innersphere::test
