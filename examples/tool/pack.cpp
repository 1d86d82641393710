#include <memory>

#include "commands.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing_file.hpp"
#include "inputs.hpp"
#include "numbers.hpp"
#include "outputs.hpp"
#include "packing_report.hpp"
#include "terminal.hpp"

namespace innersphere::tool {
namespace {

struct Arguments {
  SolidArguments solid;
  PackOptions pack;
  std::string output;
  bool force = false;
  bool json = false;
};

void run(const Arguments& arguments) {
  checkPackingOutput(arguments.output, arguments.force);
  const auto solid = loadSolid(arguments.solid);
  const Packing packing = pack(*solid, arguments.pack, progressBar());
  clearProgressBar();
  writePacking(packing, arguments.output, arguments.force);
  describe(packing).print(arguments.json);
}

}  // namespace

void addPackCommand(CLI::App& app, Session&) {
  CLI::App* command = app.add_subcommand("pack", "Fill a solid with spheres");
  auto arguments = std::make_shared<Arguments>();
  PackOptions& options = arguments->pack;
  command->add_option("SOLID", arguments->solid.source, "Mesh file (OBJ, STL, PLY, ...) or name of a solid")
      ->required();
  command->add_option("-o,--output", arguments->output, "Packing file to write: .json, .cbor, .ply or .xyzr")
      ->required();
  command->add_option("--spheres", options.spheres, "Stop at exactly this many spheres; 0: no limit")
      ->check(notNegative())
      ->capture_default_str();
  command
      ->add_option("--min-radius", options.min_radius, "Place no smaller sphere [m]; 0: 1e-4 of the diagonal")
      ->check(notNegative())
      ->capture_default_str();
  command
      ->add_option("--density", options.density,
                   "Stop when this fraction of the volume is filled; 0: no limit")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command
      ->add_option("--gap", options.gap,
                   "Stop when no surface point is farther from a sphere [m]; 0: no limit")
      ->check(notNegative())
      ->capture_default_str();
  command
      ->add_option("--delta", options.delta,
                   "Greediness: each radius is at least 1/(1+delta) of the largest possible")
      ->check(positive())
      ->capture_default_str();
  command->add_option("--threads", options.threads, "0: all cores; the result does not depend on it")
      ->check(notNegative())
      ->capture_default_str();
  addScaleOption(*command, arguments->solid.mesh);
  addRepairOption(*command, arguments->solid.mesh);
  command->add_flag("--force", arguments->force, "Replace an existing output");
  command->add_flag("--json", arguments->json, "Print the summary as JSON");
  command->footer(
      "The first limit that is reached ends the packing.\n"
      "Examples:\n"
      "  innersphere pack bunny.obj --spheres 4000 -o bunny.cbor\n"
      "  innersphere pack bracket.stl --scale 0.001 --spheres 0 --density 0.85 -o bracket.json\n"
      "  innersphere pack torus -o torus.cbor");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace innersphere::tool
