// Times of work that is repeated while others may use the machine.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace innersphere::benchmarks {

/// Wall time of one call [us].
template <typename Work>
double timeOf(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

/// The value below which `share` of the values lie; 0.5: the median.
inline double quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

inline double median(const std::vector<double>& values) {
  return quantile(values, 0.5);
}

/// Calls work(i) for all i < count, pass after pass. The least time of each [us]: what it takes when nothing
/// else disturbs. Passes are interleaved, so that a disturbance overlapping pairs all kinds of work alike.
template <typename Work>
std::vector<double> leastTimes(std::size_t count, std::size_t passes, const Work& work) {
  std::vector<double> least(count, 1e300);
  for (std::size_t i = 0; i < count; ++i) work(i);
  for (std::size_t pass = 0; pass < passes; ++pass) {
    for (std::size_t i = 0; i < count; ++i) least[i] = std::min(least[i], timeOf([&] { work(i); }));
  }
  return least;
}

}  // namespace innersphere::benchmarks
