// Well-spread random numbers that depend on nothing but the pixel and the sample.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace innersphere::demo {

/// Points of a six-dimensional Kronecker sequence: dimension k advances by phi^-(k+1), phi the root of x^7 =
/// x + 1, which spreads them evenly over pixel, light and reflection directions at once. Each pixel shifts
/// the sequence by a hash.
class Sampler {
 public:
  static constexpr int kDimensions = 6;

  Sampler(std::uint32_t x, std::uint32_t y) {
    std::uint32_t state = hash(x + hash(y + 1));
    for (float& shift : shifts_) {
      state = hash(state + 0x9e3779b9u);
      shift = static_cast<float>(state >> 8) * 0x1p-24f;
    }
  }

  std::array<float, kDimensions> sample(int index) const {
    constexpr double kPhi = 1.1127756842787055;
    std::array<float, kDimensions> result;
    double step = 1;
    for (int k = 0; k < kDimensions; ++k) {
      step /= kPhi;
      const double value = shifts_[k] + step * (index + 1);
      result[k] = static_cast<float>(value - std::floor(value));
      if (result[k] >= 1) result[k] = 0;  // rounded up
    }
    return result;
  }

 private:
  // Mixes the bits of a counter: odd multipliers and shifts, as in the usual integer finalisers.
  static std::uint32_t hash(std::uint32_t v) {
    v ^= v >> 16;
    v *= 0x7feb352du;
    v ^= v >> 15;
    v *= 0x846ca68bu;
    return v ^ (v >> 16);
  }

  std::array<float, kDimensions> shifts_;
};

}  // namespace innersphere::demo
