// Speed against accuracy: packings of every budget, response, estimator, backend and time step beside
// Bullet's own ways to collide moving non-convex bodies, in scenes and poses whose outcome is known.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "innersphere/error.hpp"
#include "machine.hpp"
#include "packing_store.hpp"
#include "points_file.hpp"
#include "trade_overlaps.hpp"
#include "trade_scenes.hpp"

int main(int argc, char** argv) {
  using namespace innersphere::benchmarks;
  CLI::App app("Processor time against error, as a CSV table");
  TradeOptions options;
  std::string output;
  std::vector<std::string> solids{"ball", "box", "torus", "gear", "nut"};
  app.add_option("--output", output, "Where the table goes")->required();
  app.add_option("--scenes", options.scenes, "Only these scenes; none: only overlaps")
      ->delimiter(',')
      ->check(CLI::IsMember([] {
        std::vector<std::string> names = tradeScenes();
        names.push_back("none");
        return names;
      }()));
  app.add_option("--solids", solids, "Overlaps of these solids or mesh files; none: only scenes")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--spheres", options.most_spheres, "Of the largest packings")
      ->check(CLI::Range(1024, 1000000))
      ->capture_default_str();
  app.add_option("--passes", options.passes, "Each time is the least of so many runs")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (solids == std::vector<std::string>{"none"}) solids.clear();
  const PointsFile file(output);
  if (!file.good()) return 1;
  try {
    TradeTable table(file.get(), heading("The trade of speed for accuracy", argc, argv));
    PackingStore store(options.most_spheres);
    measureOverlaps(solids, options.passes, store, table);
    measureScenes(options, store, table);
  } catch (const innersphere::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
