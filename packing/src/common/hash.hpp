// Hashes numbers and text, the same on every machine: to recognise a geometry again, or to look random.
#pragma once

#include <bit>
#include <cstdint>
#include <string>

namespace innersphere {

/// Mixes the bits of a number, as SplitMix64 does.
inline std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// This is the hash FNV-1a of 64 bits, fed with numbers in little-endian order.
class Hash {
 public:
  void add(std::uint64_t x) {
    for (int byte = 0; byte < 8; ++byte) {
      state_ ^= (x >> (8 * byte)) & 0xff;
      state_ *= 0x100000001b3u;
    }
  }
  void add(double x) { add(std::bit_cast<std::uint64_t>(x + 0.0)); }  // -0 and 0 are equal
  void add(const std::string& text) {
    for (unsigned char c : text) add(std::uint64_t{c});
  }

  /// Returns the hash as 16 hexadecimal digits.
  std::string text() const {
    std::string digits(16, '0');
    for (int i = 0; i < 16; ++i) digits[i] = "0123456789abcdef"[(state_ >> (60 - 4 * i)) & 15];
    return digits;
  }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

}  // namespace innersphere
