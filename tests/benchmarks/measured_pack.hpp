// A packing with what it cost.
#pragma once

#include "innersphere/packer.hpp"

namespace innersphere::benchmarks {

struct MeasuredPack {
  Packing packing;
  double seconds = 0;      ///< of the clock
  double cpu_seconds = 0;  ///< of all threads
  double placing = 0;      ///< of the clock, until the last sphere was placed: without shares and measures
};

MeasuredPack measuredPack(const Solid& solid, const PackOptions& options);

}  // namespace innersphere::benchmarks
