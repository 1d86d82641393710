#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "exit_codes.hpp"
#include "innersphere/check.hpp"
#include "innersphere/solids.hpp"
#include "inputs.hpp"
#include "report.hpp"

namespace innersphere::tool {
namespace {

struct Arguments {
  std::string file;
  SolidArguments solid;
  bool json = false;
};

Report describe(const CheckReport& result, bool with_solid) {
  Report report;
  report.add("valid", "valid", result.valid(), result.valid() ? "yes" : "NO");
  const std::string pair =
      "spheres " + std::to_string(result.overlap_i) + " and " + std::to_string(result.overlap_j);
  report.add("worst_overlap", "overlap", result.worst_overlap,
             result.worst_overlap > 0
                 ? "NO: " + pair + " overlap by " + number(result.worst_overlap, "m")
                 : "none; nearest: " + pair + ", " + number(-result.worst_overlap, "m") + " apart");
  report.add("overlap_spheres", "", {result.overlap_i, result.overlap_j}, "");
  if (with_solid) {
    const std::string sphere = "sphere " + std::to_string(result.protruding);
    report.add("worst_protrusion", "outside the solid", result.worst_protrusion,
               result.worst_protrusion > 0
                   ? "NO: " + sphere + " reaches out by " + number(result.worst_protrusion, "m")
                   : "none; nearest: " + sphere + ", " + number(-result.worst_protrusion, "m") + " inside");
    report.add("protruding_sphere", "", result.protruding, "");
  }
  report.add("sorted", "sorted by radius", result.sorted, result.sorted ? "yes" : "NO");
  report.add("density", "density", result.density, percent(result.density));
  return report;
}

}  // namespace

Command checkCommand() {
  Command command("check", "Judge a packing: no overlaps, nothing outside, sorted");
  auto arguments = std::make_shared<Arguments>();
  addPackingArgument(command, "FILE", arguments->file);
  command.text("--mesh", arguments->solid.source, "Solid that the spheres must be inside: mesh file or name")
      .withFile()
      .withSuggestions(namedSolids());
  addScaleOption(command, arguments->solid.mesh);
  addRepairOption(command, arguments->solid.mesh);
  command.flag("--json", arguments->json, "Print JSON, lengths in metres");
  command.exit_status = "The exit status is 1 if the packing is not valid.";
  command.examples = {"innersphere check bunny.cbor --mesh bunny.obj"};
  command.run = [arguments] {
    const Packing packing = loadPacking(arguments->file);
    const bool with_solid = !arguments->solid.source.empty();
    const auto solid = with_solid ? loadSolid(arguments->solid) : nullptr;
    const CheckReport result = check(packing, solid.get());
    describe(result, with_solid).print(arguments->json);
    return result.valid() ? kOk : kCheckFailed;
  };
  return command;
}

}  // namespace innersphere::tool
