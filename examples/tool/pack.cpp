#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "exit_codes.hpp"
#include "file_names.hpp"
#include "innersphere/cover_solid.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"
#include "inputs.hpp"
#include "outputs.hpp"
#include "packing_report.hpp"
#include "report.hpp"
#include "terminal.hpp"

namespace innersphere::tool {
namespace {

enum class Order { unsaid, radius, coverage };

struct Arguments {
  SolidArguments solid;
  PackOptions pack;
  PackingOutput output;
  double accuracy = 0.01;
  Order order = Order::unsaid;
  bool split = false;
  bool cover = false;
  bool json = false;
};

// Spheres of a covering, where none are asked for: what planners take for a link of a robot.
constexpr std::size_t kCoveringSpheres = 64;

// Without any other limit as many spheres as the accuracy asks for. Walls then get theirs before the middle
// is filled, unless the user wants another order.
PackOptions limitsFor(const Solid& solid, const Arguments& arguments) {
  PackOptions options = arguments.pack;
  if (arguments.order == Order::coverage) options.order = SphereOrder::coverage;
  if (options.spheres > 0 || options.density > 0 || options.gap > 0) return options;
  const Bounds box = solid.bounds();
  options.gap = arguments.accuracy * norm(box.max - box.min);
  if (arguments.order == Order::unsaid) options.order = SphereOrder::coverage;
  say("as many spheres as come within " + percent(arguments.accuracy) + " of the diagonal, " +
      number(options.gap, "m") + ", everywhere on the surface; --accuracy, --spheres choose others");
  return options;
}

void checkOutputOf(const Arguments& arguments, const PackingOutput& output) {
  checkPackingOutput(output);
  if (arguments.cover && (endingOf(output.path) == ".cbor" || output.format == "cbor"))
    throw Error(ErrorCode::bad_argument, "a covering is written to .json, .ply or .xyzr, not to .cbor");
}

Report reportOf(const Covering& covering, double diagonal) {
  Report report;
  const Provenance& from = covering.provenance;
  report.add("kind", "kind", "covering: the spheres contain the solid and overlap each other");
  report.add("source", "source", from.source);
  report.add("options", "options", from.options);
  report.add("spheres", "spheres", covering.spheres.size());
  const auto addLength = [&](const std::string& key, const std::string& label, double length) {
    report.add(key, label, length,
               number(length, "m") + ", " + percent(length / diagonal) + " of the diagonal");
  };
  addLength("overhang_mean", "overhang, mean", covering.overhang_mean);
  addLength("overhang_max", "overhang, max", covering.overhang_max);
  report.add("volume", "volume of the solid", covering.solid.volume, number(covering.solid.volume, "m^3"));
  return report;
}

void coverInto(const PackingOutput& output, bool say_where, const Solid& solid, const Arguments& arguments) {
  PackOptions options = arguments.pack;
  if (options.spheres == 0 && options.density == 0 && options.gap == 0) options.spheres = kCoveringSpheres;
  options.order = arguments.order == Order::radius ? SphereOrder::radius : SphereOrder::coverage;
  options.overlap_errors = false;
  CoverOptions cover;
  cover.threads = options.threads;
  const Covering covering = coverSolid(solid, pack(solid, options, progressBar()), cover, progressBar());
  clearProgressBar();
  writeNamedOutput(output,
                   [&](const std::string& path, bool force) { writeCovering(covering, path, force); });
  if (say_where) say("wrote " + output.path);
  const Bounds box = solid.bounds();
  reportOf(covering, norm(box.max - box.min)).print(arguments.json, isStdout(output.path) ? stderr : stdout);
}

void packInto(const PackingOutput& output, bool say_where, const Solid& solid, const Arguments& arguments) {
  checkOutputOf(arguments, output);
  if (arguments.cover) return coverInto(output, say_where, solid, arguments);
  const Packing packing = pack(solid, limitsFor(solid, arguments), progressBar());
  clearProgressBar();
  writePackingOutput(packing, output);
  if (say_where) say("wrote " + output.path);
  describe(packing).print(arguments.json, isStdout(output.path) ? stderr : stdout);
}

// "chess.cbor" becomes "chess-3.cbor".
std::string numbered(const std::string& path, std::size_t number) {
  std::filesystem::path name(path);
  name.replace_filename(name.stem().string() + "-" + std::to_string(number) + name.extension().string());
  return name.string();
}

// One packing each.
void packBodies(const Solid& solid, const Arguments& arguments) {
  const std::vector<Mesh> bodies = splitBodies(solid.surface());
  std::vector<PackingOutput> outputs(bodies.size(), arguments.output);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    outputs[i].path = numbered(arguments.output.path, i + 1);
    checkOutputOf(arguments, outputs[i]);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::string name =
        arguments.solid.source + ", body " + std::to_string(i + 1) + " of " + std::to_string(bodies.size());
    packInto(outputs[i], true, *makeSolid(bodies[i], name, arguments.solid.mesh), arguments);
  }
}

void run(Arguments& arguments) {
  PackingOutput& output = arguments.output;
  const bool named = !output.path.empty();
  if (!named) output.path = stemOf(arguments.solid.source) + (arguments.cover ? ".json" : ".cbor");
  if (arguments.split && isStream(output.path)) {
    throw Error(ErrorCode::bad_argument,
                "--split writes a file for each body; give -o a name, not " + output.path);
  }
  if (!arguments.split) checkOutputOf(arguments, output);
  const auto solid = loadSolid(arguments.solid);
  if (arguments.split) return packBodies(*solid, arguments);
  packInto(output, !named, *solid, arguments);
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
  options.spheres = 0;
  command.count("--spheres", options.spheres, kNotNegative, "Stop at exactly this many spheres; 0: no limit")
      .withDefault("as --accuracy asks for");
  command.number(
      "--accuracy", arguments->accuracy, {0, 1, true},
      "Without --spheres, --density and --gap: the fewest spheres of which one is within this part of "
      "the diagonal of every point of the surface");
  command.number("--min-radius", options.min_radius, kNotNegative,
                 "Place no smaller sphere [m]; 0: 1e-4 of the diagonal");
  command.number("--density", options.density, {0, 1},
                 "Stop when this fraction of the volume is filled; 0: no limit");
  command.number("--gap", options.gap, kNotNegative,
                 "Stop when no surface point is farther from a sphere [m]; 0: no limit");
  command
      .choice<Order>(
          "--order", arguments->order, {{"radius", Order::radius}, {"coverage", Order::coverage}},
          "What the first spheres are chosen for: to fill the solid, or to be near all of its surface, "
          "also where it is thin")
      .withDefault("radius; coverage where --accuracy sets the number, and with --cover");
  command.number("--delta", options.delta, kPositive,
                 "Greediness: each radius is at least 1/(1+delta) of the largest possible");
  command.count("--threads", options.threads, kNotNegative, "0: all cores; the result does not depend on it");
  addScaleOption(command, arguments->solid.mesh);
  addRepairOption(command, arguments->solid.mesh);
  command.flag("--split", arguments->split,
               "Pack each body of the file for itself: NAME-1.cbor, NAME-2.cbor, ...");
  command.flag(
      "--cover", arguments->cover,
      "Write spheres that contain the solid, 64 where no limit is set, for planners: they overlap each "
      "other and are no packing; to .json, .ply or .xyzr, by default SOLID.json");
  addPackingOutputOptions(command, arguments->output);
  command.flag("--json", arguments->json, "Print the summary as JSON");
  command.notes = "The first limit that is reached ends the packing.";
  command.examples = {"innersphere pack bunny.obj --spheres 4000 -o bunny.cbor",
                      "innersphere pack bracket.stl --scale 0.001 --spheres 0 --density 0.85 -o bracket.json",
                      "innersphere pack torus",
                      "innersphere pack link.stl --cover --spheres 32 -o link.json"};
  command.run = [arguments] {
    run(*arguments);
    return kOk;
  };
  return command;
}

}  // namespace innersphere::tool
