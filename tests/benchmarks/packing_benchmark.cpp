// What packings cost and how dense they are: one Markdown table for each question.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "machine.hpp"
#include "packing_tables.hpp"

int main(int argc, char** argv) {
  using namespace innersphere;
  using namespace innersphere::benchmarks;
  CLI::App app("Density, time and memory of packings, as Markdown tables on stdout");
  std::vector<std::string> sources;
  std::vector<std::size_t> counts{1000, 4000, 10000, 16000};
  std::size_t large = 0;
  bool invariance = false, slow = false;
  std::string csv;
  app.add_option("SOLID", sources, "Mesh files or names of solids; default: all named solids");
  app.add_option("--spheres", counts, "Numbers of spheres")->capture_default_str()->delimiter(',');
  app.add_option("--large", large, "Also pack the first solid with this many spheres; 0: do not")
      ->capture_default_str();
  app.add_flag("--invariance", invariance,
               "Also: threads, scale, place and repeated runs of the first solid");
  app.add_flag("--slow-cases", slow, "Also: solids that are hard to pack");
  app.add_option("--csv", csv, "Write density against the number of spheres there, for plots");
  CLI11_PARSE(app, argc, argv);
  if (sources.empty()) sources = namedSolids();
  try {
    std::vector<Case> cases;
    for (const std::string& source : sources) {
      if (!std::filesystem::exists(source)) {
        cases.push_back({source, makeNamedSolid(source)});
        continue;
      }
      cases.push_back({std::filesystem::path(source).stem().string(), makeSolid(readMesh(source), source)});
    }
    std::printf("%s", heading("Packing", argc, argv).c_str());
    Curves curves;
    tableOfDensities(cases, counts, curves);
    if (!csv.empty()) writeCurves(curves, csv);
    if (large > 0) tableOfLinearity(cases.front(), large);
    if (invariance) tableOfInvariance(cases.front());
    if (slow) tableOfSlowCases();
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
