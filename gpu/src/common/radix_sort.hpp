// Sorts by integer keys, a digit at a time.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace innersphere {

/// Sorts `items` by the bits from..from + bits of their keys and keeps the order of equal ones. `items` and
/// `spare` are pointers to `count` items each, and may change places.
template <typename T, typename Key>
void sortByBits(T*& items, T*& spare, std::size_t count, const Key& key, int from, int bits) {
  constexpr int kDigit = 8;
  for (int shift = from; shift < from + bits; shift += kDigit) {
    std::array<std::size_t, 1 << kDigit> at{};
    const auto digit = [&](const T& item) { return key(item) >> shift & ((1u << kDigit) - 1); };
    for (std::size_t k = 0; k < count; ++k) ++at[digit(items[k])];
    std::size_t sum = 0;
    for (std::size_t& count_or_place : at) sum += std::exchange(count_or_place, sum);
    for (std::size_t k = 0; k < count; ++k) spare[at[digit(items[k])]++] = items[k];
    std::swap(items, spare);
  }
}

/// Sorts a vector by some bits of its keys; `spare` has its size.
template <typename T, typename Key>
void sortByBits(std::vector<T>& items, std::vector<T>& spare, const Key& key, int from, int bits) {
  T *first = items.data(), *second = spare.data();
  sortByBits(first, second, items.size(), key, from, bits);
  if (first != items.data()) std::swap(items, spare);
}

/// Sorts few items by key(item) < limit, in few steps of large digits; otherwise it does what sortByBits()
/// does.
template <typename Key>
void sortByNumber(std::uint32_t*& items, std::uint32_t*& spare, std::size_t count, std::uint32_t limit,
                  const Key& key) {
  constexpr int kMostBits = 12;
  const int bits = std::bit_width(limit - 1), digits = (bits + kMostBits - 1) / kMostBits;
  for (int digit = 0, from = 0; digit < digits; ++digit) {
    const int end = bits * (digit + 1) / digits;
    const std::uint32_t values = 1u << (end - from);
    std::array<std::uint32_t, 1 << kMostBits> at;
    std::fill_n(at.begin(), values, 0u);
    const auto of = [&](std::uint32_t item) { return key(item) >> from & (values - 1); };
    for (std::size_t k = 0; k < count; ++k) ++at[of(items[k])];
    std::uint32_t sum = 0;
    for (std::uint32_t d = 0; d < values; ++d) sum += std::exchange(at[d], sum);
    for (std::size_t k = 0; k < count; ++k) spare[at[of(items[k])]++] = items[k];
    std::swap(items, spare);
    from = end;
  }
}

}  // namespace innersphere
