// Density, time and memory of packings.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <functional>

#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"
#include "machine.hpp"

namespace {

double secondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Density, time and memory of packings, as a Markdown table on stdout");
  std::vector<std::string> solids = {"box"};
  std::vector<std::size_t> counts = {1000, 4000, 10000};
  app.add_option("SOLID", solids, "Mesh files or names of solids")->capture_default_str();
  app.add_option("--spheres", counts, "Numbers of spheres")->capture_default_str()->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  using namespace innersphere;
  try {
    std::printf("%s", benchmarks::heading("Packing", argc, argv).c_str());
    std::printf(
        "| solid | spheres | density %% | time s | spheres/s | peak memory MiB "
        "|\n|---|---|---|---|---|---|\n");
    for (const std::string& name : solids) {
      const bool is_mesh = name.find('.') != std::string::npos;
      const auto solid = is_mesh ? makeSolid(readMesh(name), name) : makeNamedSolid(name);
      for (std::size_t count : counts) {
        PackOptions options;
        options.spheres = count;
        Packing packing;
        const double seconds = secondsOf([&] { packing = pack(*solid, options); });
        const double placed = static_cast<double>(packing.spheres.size());
        std::printf("| %s | %.0f | %.2f | %.2f | %.0f | %.0f |\n", name.c_str(), placed,
                    100 * packing.quality.density, seconds, placed / seconds, benchmarks::peakMemory());
        std::fflush(stdout);
      }
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
