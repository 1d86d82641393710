// Time to build the grid of a packing, on the CPU and on a device.
#include <tbb/task_arena.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <vector>

#include "cuda/device_grid.hpp"
#include "greedy_ball.hpp"
#include "grid/hash_grid.hpp"
#include "innersphere/error.hpp"
#include "machine.hpp"
#include "timing.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

double medianTime(std::size_t runs, const std::function<void()>& work) {
  work();
  work();
  std::vector<double> times;
  for (std::size_t run = 0; run < runs; ++run) times.push_back(timeOf(work));
  return median(times);
}

void row(std::size_t count, std::size_t runs) {
  const auto packing = greedyBall(count, 1);
  const Sphere* const spheres = packing->spheres.data();
  const auto plan = [&] { return planGrid(spheres, count); };
  tbb::task_arena one(1);
  HashGrid of_cpu;
  GridScratch scratch;
  double cpu = 0, cpu_plan = 0;
  one.execute([&] {
    cpu_plan = medianTime(runs, [&] { plan(); });
    cpu = medianTime(7, [&] { of_cpu.build(spheres, plan(), scratch); });
  });
  const double plan_all = medianTime(runs, [&] { plan(); });

  cudaStream_t stream = nullptr;
  INNERSPHERE_CUDA(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking));
  DeviceArray<Sphere> on_device;
  on_device.reserve(count);
  copyAsync(on_device.data(), spheres, count, stream);
  const core::GridPlan planned = plan();
  const double first = medianTime(runs / 5, [&] {
    device::CudaGrid grid(0);
    grid.build(on_device.data(), planned, stream);
  });
  double kernels = 0, host = 0, from_host = 0;
  {
    device::CudaGrid grid(0);
    Event start, stop;
    std::vector<double> times;
    for (std::size_t run = 0; run < runs + 2; ++run) {
      INNERSPHERE_CUDA(cudaEventRecord(start.get(), stream));
      grid.build(on_device.data(), planned, stream);
      INNERSPHERE_CUDA(cudaEventRecord(stop.get(), stream));
      INNERSPHERE_CUDA(cudaEventSynchronize(stop.get()));
      if (run >= 2) times.push_back(1e6 * secondsBetween(start, stop));
    }
    kernels = median(times);
    host = medianTime(runs, [&] { grid.build(on_device.data(), planned, stream); });
    from_host = medianTime(runs, [&] { grid.build(spheres, plan(), stream); });
  }
  cudaStreamDestroy(stream);
  std::printf("| %zu | %.0f | %.0f (%.0f) | %.0f | %.1f | %.1f | %.1f |\n", count, cpu, cpu_plan, plan_all,
              first, kernels, host, from_host);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Time to build grids, as a Markdown table on stdout");
  std::vector<std::size_t> counts = {4000, 15000, 60000, 250000};
  std::size_t runs = 101;
  std::string device;
  app.add_option("--device", device, "Name of the GPU, for the head of the table");
  app.add_option("--spheres", counts, "Numbers of spheres")->capture_default_str()->delimiter(',');
  app.add_option("--runs", runs, "Repetitions")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("%s", heading("Construction of grids", argc, argv).c_str());
    if (!device.empty()) std::printf("GPU: %s\n\n", device.c_str());
    std::printf(
        "Unit balls, raw radii; medians, us. Plan: bounds, levels and tiers, which the host finds out for "
        "both "
        "(with all its threads). First: with all memory allocated and freed. Again: in the memory of the "
        "grid "
        "before; events before and after it, or the clock of the host until it is done; spheres in the "
        "memory of "
        "the device. Update: again, from spheres in the memory of the host, with the plan.\n\n"
        "| spheres | CPU, one thread | of it plan | device, first | again, events | again, host | update |\n"
        "|---|---|---|---|---|---|---|\n");
    for (const std::size_t count : counts) row(count, runs);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
