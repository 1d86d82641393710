#include <memory>

#include "commands.hpp"
#include "exit_codes.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"
#include "inputs.hpp"
#include "outputs.hpp"
#include "packing_report.hpp"
#include "terminal.hpp"

namespace innersphere::tool {
namespace {

struct Arguments {
  SolidArguments solid;
  PackOptions pack;
  PackingOutput output;
  bool json = false;
};

void run(Arguments& arguments) {
  PackingOutput& output = arguments.output;
  const bool named = !output.path.empty();
  if (!named) output.path = stemOf(arguments.solid.source) + ".cbor";
  checkPackingOutput(output);
  const auto solid = loadSolid(arguments.solid);
  const Packing packing = pack(*solid, arguments.pack, progressBar());
  clearProgressBar();
  writePackingOutput(packing, output);
  if (!named) say("wrote " + output.path);
  describe(packing).print(arguments.json, isStdout(output.path) ? stderr : stdout);
}

}  // namespace

Command packCommand() {
  Command command("pack", "Fill a solid with spheres");
  auto arguments = std::make_shared<Arguments>();
  PackOptions& options = arguments->pack;
  command.argument("SOLID", arguments->solid.source, "Mesh file (OBJ, STL, PLY, ...) or name of a solid")
      .withFile()
      .withSuggestions(namedSolids());
  command
      .text("-o,--output", arguments->output.path,
            "Packing file to write: .json, .cbor, .ply or .xyzr; -: to stdout")
      .withFile()
      .withDefault("SOLID.cbor in this folder");
  command.count("--spheres", options.spheres, kNotNegative, "Stop at exactly this many spheres; 0: no limit");
  command.number("--min-radius", options.min_radius, kNotNegative,
                 "Place no smaller sphere [m]; 0: 1e-4 of the diagonal");
  command.number("--density", options.density, {0, 1},
                 "Stop when this fraction of the volume is filled; 0: no limit");
  command.number("--gap", options.gap, kNotNegative,
                 "Stop when no surface point is farther from a sphere [m]; 0: no limit");
  command.number("--delta", options.delta, kPositive,
                 "Greediness: each radius is at least 1/(1+delta) of the largest possible");
  command.count("--threads", options.threads, kNotNegative, "0: all cores; the result does not depend on it");
  addScaleOption(command, arguments->solid.mesh);
  addRepairOption(command, arguments->solid.mesh);
  addPackingOutputOptions(command, arguments->output);
  command.flag("--json", arguments->json, "Print the summary as JSON");
  command.notes = "The first limit that is reached ends the packing.";
  command.examples = {"innersphere pack bunny.obj --spheres 4000 -o bunny.cbor",
                      "innersphere pack bracket.stl --scale 0.001 --spheres 0 --density 0.85 -o bracket.json",
                      "innersphere pack torus"};
  command.run = [arguments] {
    run(*arguments);
    return kOk;
  };
  return command;
}

}  // namespace innersphere::tool
