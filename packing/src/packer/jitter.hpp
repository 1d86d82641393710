// Gives places for samples that look random and are the same on every run.
#pragma once

#include <array>
#include <cstdint>

namespace innersphere {

/// Returns a number in [0, 1) that looks random, from a lattice point and an axis.
inline double jitter(const std::array<std::uint32_t, 3>& at, std::uint32_t axis) {
  std::uint64_t x = (std::uint64_t{at[0]} << 42 ^ std::uint64_t{at[1]} << 21 ^ at[2]) * 4 + axis;
  x = (x + 0x9e3779b97f4a7c15ull) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ x >> 29) * 0x94d049bb133111ebull;
  return static_cast<double>((x ^ x >> 32) >> 11) * 0x1p-53;
}

}  // namespace innersphere
