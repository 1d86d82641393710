// Computes functions with the same bits on every processor.
#pragma once

#include <cmath>

namespace innersphere::steady {

// The C library has several versions of these functions for double and picks one by the processor: with fused
// multiply-add they round otherwise. For long double it has one, exact enough to round to the nearest double.

inline double sin(double x) {
  return static_cast<double>(std::sin(static_cast<long double>(x)));
}
inline double cos(double x) {
  return static_cast<double>(std::cos(static_cast<long double>(x)));
}
inline double exp(double x) {
  return static_cast<double>(std::exp(static_cast<long double>(x)));
}
inline double pow(double x, double y) {
  return static_cast<double>(std::pow(static_cast<long double>(x), static_cast<long double>(y)));
}
inline double log1p(double x) {
  return static_cast<double>(std::log1p(static_cast<long double>(x)));
}
inline double log2(double x) {
  return static_cast<double>(std::log2(static_cast<long double>(x)));
}

}  // namespace innersphere::steady
