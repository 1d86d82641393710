#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "exit_codes.hpp"
#include "file_names.hpp"
#include "innersphere/clump_solid.hpp"
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
  bool clump = false;
  double outside_weight = 1;
  bool json = false;
};

// Spheres of a covering or clump, where none are asked for: what planners take for a link of a robot.
constexpr std::size_t kCoveringSpheres = 64;

// Of --spheres, where it is not given.
constexpr std::size_t kUnsaid = std::numeric_limits<std::size_t>::max();

bool areCovering(const Arguments& arguments) {
  return arguments.cover || arguments.clump;
}

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
  if (areCovering(arguments) && (endingOf(output.path) == ".cbor" || output.format == "cbor")) {
    throw Error(ErrorCode::bad_argument, std::string(arguments.clump ? "a clump" : "a covering") +
                                             " is written to .json, .ply or .xyzr, not to .cbor");
  }
}

Covering covered(const Solid& solid, const Arguments& arguments) {
  PackOptions options = arguments.pack;
  if (options.spheres == 0 && options.density == 0 && options.gap == 0) options.spheres = kCoveringSpheres;
  options.order = arguments.order == Order::radius ? SphereOrder::radius : SphereOrder::coverage;
  options.overlap_errors = false;
  CoverOptions cover;
  cover.threads = options.threads;
  return coverSolid(solid, pack(solid, options, progressBar()), cover, progressBar());
}

Covering clumped(const Solid& solid, const Arguments& arguments) {
  ClumpOptions options;
  options.spheres = arguments.pack.spheres;
  options.outside_weight = arguments.outside_weight;
  options.threads = arguments.pack.threads;
  return clumpSolid(solid, options, progressBar());
}

// Beside spheres on stdout the report is a note.
void printReport(const Report& report, const PackingOutput& output, bool as_json) {
  if (!isStdout(output.path)) return report.print(as_json);
  if (!isQuiet()) report.print(as_json, stderr);
}

void coverInto(const PackingOutput& output, bool say_where, const Solid& solid, const Arguments& arguments) {
  const Covering covering = arguments.clump ? clumped(solid, arguments) : covered(solid, arguments);
  clearProgressBar();
  if (covering.spheres.size() < arguments.pack.spheres && arguments.clump)
    say("more than " + std::to_string(covering.spheres.size()) +
        " spheres would not come nearer to the solid");
  writeNamedOutput(output,
                   [&](const std::string& path, bool force) { writeCovering(covering, path, force); });
  if (say_where) say("wrote " + output.path);
  const Bounds box = solid.bounds();
  printReport(describe(covering, norm(box.max - box.min)), output, arguments.json);
}

void packInto(const PackingOutput& output, bool say_where, const Solid& solid, const Arguments& arguments,
              const std::vector<std::string>& notes) {
  checkOutputOf(arguments, output);
  if (areCovering(arguments)) return coverInto(output, say_where, solid, arguments);
  Packing packing = pack(solid, limitsFor(solid, arguments), progressBar());
  packing.warnings.insert(packing.warnings.begin(), notes.begin(), notes.end());
  clearProgressBar();
  writePackingOutput(packing, output);
  if (say_where) say("wrote " + output.path);
  printReport(describe(packing), output, arguments.json);
}

// "chess.cbor" becomes "chess-3.cbor".
std::string numbered(const std::string& path, std::size_t number) {
  std::filesystem::path name(path);
  name.replace_filename(name.stem().string() + "-" + std::to_string(number) + name.extension().string());
  return name.string();
}

// One packing each.
void packBodies(const Solid& solid, const Arguments& arguments, const std::vector<std::string>& notes) {
  const std::vector<Mesh> bodies = splitBodies(solid.surface());
  std::vector<PackingOutput> outputs(bodies.size(), arguments.output);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    outputs[i].path = numbered(arguments.output.path, i + 1);
    checkOutputOf(arguments, outputs[i]);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::string name =
        arguments.solid.source + ", body " + std::to_string(i + 1) + " of " + std::to_string(bodies.size());
    packInto(outputs[i], true, *makeSolid(bodies[i], name, arguments.solid.mesh), arguments, notes);
  }
}

// What belongs together, and how many spheres where that was not said.
void settle(Arguments& arguments) {
  PackOptions& options = arguments.pack;
  const bool unsaid = options.spheres == kUnsaid;
  if (unsaid) options.spheres = arguments.clump ? kCoveringSpheres : 0;
  if (!arguments.clump && arguments.outside_weight != 1)
    throw Error(ErrorCode::bad_argument, "--outside-weight is for --clump");
  if (!arguments.clump) return;
  if (arguments.cover) {
    throw Error(ErrorCode::bad_argument,
                "--cover contains the solid, --clump comes near to it: give one of them");
  }
  if (options.density > 0 || options.gap > 0 || options.min_radius > 0 || arguments.order != Order::unsaid) {
    throw Error(
        ErrorCode::bad_argument,
        "a clump is found by its number of spheres; leave out --density, --gap, --min-radius and --order");
  }
}

void run(Arguments& arguments) {
  settle(arguments);
  PackingOutput& output = arguments.output;
  const bool named = !output.path.empty();
  if (!named) output.path = stemOf(arguments.solid.source) + (areCovering(arguments) ? ".json" : ".cbor");
  if (arguments.split && isStream(output.path)) {
    throw Error(ErrorCode::bad_argument,
                "--split writes a file for each body; give -o a name, not " + output.path);
  }
  if (!arguments.split) checkOutputOf(arguments, output);
  std::vector<std::string> notes;
  const auto solid = loadSolid(arguments.solid, &notes);
  if (arguments.split) return packBodies(*solid, arguments, notes);
  packInto(output, !named, *solid, arguments, notes);
}

}  // namespace

Command packCommand() {
  Command command("pack", "Fill a solid with spheres");
  auto arguments = std::make_shared<Arguments>();
  PackOptions& options = arguments->pack;
  command
      .argument("SOLID", arguments->solid.source,
                "Mesh file (OBJ, STL, PLY, ...), name of a solid, or - for a mesh from stdin")
      .withFile()
      .withSuggestions(namedSolids());
  command
      .text("-o,--output", arguments->output.path,
            "Packing file to write: .json, .cbor, .ply or .xyzr; -: to stdout")
      .withFile()
      .withDefault("SOLID.cbor in this folder");
  options.spheres = kUnsaid;
  command.count("--spheres", options.spheres, kNotNegative, "Stop at exactly this many spheres; 0: no limit")
      .withDefault("as --accuracy asks for; 64 with --cover and --clump");
  command.number(
      "--accuracy", arguments->accuracy, {0, 1, true},
      "Without --spheres, --density and --gap: the fewest spheres of which one is within this part of "
      "the diagonal of every one of 50,000 points spread over the surface");
  command.number("--min-radius", options.min_radius, kNotNegative,
                 "Place no smaller sphere [m]; 0: 1e-4 of the diagonal");
  command.number("--density", options.density, {0, 1},
                 "Stop when this fraction of the volume is filled; 0: no limit");
  command.number(
      "--gap", options.gap, kNotNegative,
      "Stop when none of 50,000 points spread over the surface is farther from a sphere [m]; 0: no "
      "limit");
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
  command.flag(
      "--clump", arguments->clump,
      "Write --spheres spheres that overlap each other and of which the union is as near to the solid "
      "as can be, for grains and haptics: a multi-sphere particle, no packing; to the same files");
  command.number(
      "--outside-weight", arguments->outside_weight, {1, 100},
      "With --clump: how much volume outside of the solid counts against volume of it that is left "
      "out; with more, spheres reach out less and fill less");
  addPackingOutputOptions(command, arguments->output);
  command.flag("--json", arguments->json, "Print the summary as JSON");
  command.notes = "The first limit that is reached ends the packing.";
  command.examples = {"innersphere pack bunny.obj --spheres 4000 -o bunny.cbor",
                      "innersphere pack bracket.stl --scale 0.001 --spheres 0 --density 0.85 -o bracket.json",
                      "innersphere pack torus", "innersphere pack link.stl --cover --spheres 32 -o link.json",
                      "innersphere pack grain.obj --clump --spheres 16 -o grain.json"};
  command.run = [arguments] {
    run(*arguments);
    return kOk;
  };
  return command;
}

}  // namespace innersphere::tool
