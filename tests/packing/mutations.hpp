// Damages files at random, as many as a test has time for.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <random>
#include <string>

namespace innersphere::test {

/// Changes a few places: bits, bytes, numbers, pieces that go, come twice or from elsewhere in the file.
inline std::string mutated(std::string bytes, std::mt19937_64& random) {
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random() % std::max<std::size_t>(n, 1));
  };
  static const char* const kWords[] = {"-1",
                                       "0",
                                       "4294967295",
                                       "99999999999999999999",
                                       "1e999",
                                       "nan",
                                       "inf",
                                       "3e8",
                                       "\n",
                                       " ",
                                       "\\\n",
                                       "end_header\n",
                                       "element vertex 1000000000\n",
                                       "property list uchar int x\n",
                                       "\xff\xff\xff\xff",
                                       "f 1 1 1\n"};
  for (std::size_t n = 1 + below(4); n > 0; --n) {
    const std::size_t at = below(bytes.size()), length = 1 + below(below(2) ? 8 : bytes.size() / 2);
    switch (below(7)) {
      case 0:
        if (!bytes.empty()) bytes[at] = static_cast<char>(bytes[at] ^ 1 << below(8));
        break;
      case 1:
        if (!bytes.empty()) bytes[at] = static_cast<char>(random());
        break;
      case 2:
        bytes.erase(at, length);
        break;
      case 3:
        bytes.resize(at);
        break;
      case 4:
        bytes.insert(at, bytes.substr(below(bytes.size()), length));
        break;
      case 5:
        bytes.insert(at, kWords[below(std::size(kWords))]);
        break;
      default:
        bytes.replace(at, length, kWords[below(std::size(kWords))]);
    }
  }
  return bytes;
}

/// Calls read(bytes) for `count` mutations of a good file, the same in every run. With
/// INNERSPHERE_FUZZ_SECONDS others follow until that time is over. Each round has a seed, which is printed
/// before it, for what fails may end the program: INNERSPHERE_FUZZ_SEED repeats that round alone.
template <typename Read>
void feedMutations(const std::string& good, int count, const Read& read) {
  using Clock = std::chrono::steady_clock;
  const char* seconds = std::getenv("INNERSPHERE_FUZZ_SECONDS");
  const char* wanted = std::getenv("INNERSPHERE_FUZZ_SEED");
  const auto end = Clock::now() + std::chrono::duration<double>(seconds && !wanted ? std::atof(seconds) : 0);
  std::uint64_t seed = 1;
  if (seconds) seed = static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
  if (wanted) seed = std::strtoull(wanted, nullptr, 10);
  do {
    std::cout << "INNERSPHERE_FUZZ_SEED=" << seed << std::endl;
    std::mt19937_64 random(seed++);
    for (int i = 0; i < count; ++i) read(mutated(good, random));
  } while (Clock::now() < end && !testing::Test::HasFailure());
}

}  // namespace innersphere::test
