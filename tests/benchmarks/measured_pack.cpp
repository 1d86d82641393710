#include "measured_pack.hpp"

#include <sys/resource.h>

#include <chrono>
#include <string>

namespace innersphere::benchmarks {
namespace {

double cpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

}  // namespace

MeasuredPack measuredPack(const Solid& solid, const PackOptions& options) {
  MeasuredPack measured;
  const auto start = std::chrono::steady_clock::now();
  const double cpu = cpuSeconds();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  measured.packing = pack(solid, options, [&](const char* stage, double) {
    if (measured.placing == 0 && std::string(stage) != "packing") measured.placing = seconds();
    return true;
  });
  measured.seconds = seconds();
  measured.cpu_seconds = cpuSeconds() - cpu;
  return measured;
}

}  // namespace innersphere::benchmarks
