// How many like cases a test goes through.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <string>

namespace innersphere::test {

/// `all` of them, or `few` where the environment has INNERSPHERE_FEW_CASES=1: under compute-sanitizer a
/// kernel is thousands of times slower. The same kernels run, and take the same branches.
inline std::size_t cases(std::size_t all, std::size_t few) {
  static const bool take_few = [] {
    const char* wanted = std::getenv("INNERSPHERE_FEW_CASES");
    return wanted && std::string(wanted) == "1";
  }();
  return take_few ? few : all;
}

}  // namespace innersphere::test
