#include "innersphere/solids.hpp"

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "exit_codes.hpp"
#include "report.hpp"

namespace innersphere::tool {
namespace {

int list(bool as_json) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const std::string& name : namedSolids()) {
    const auto solid = makeNamedSolid(name);
    const Bounds b = solid->bounds();
    const Vec3d size{b.max[0] - b.min[0], b.max[1] - b.min[1], b.max[2] - b.min[2]};
    const double volume = solid->massProperties().volume;
    rows.push_back({{"name", name}, {"size", size}, {"volume", volume}});
    if (!as_json) {
      std::printf("%-12s %s, %s\n", name.c_str(), vector(size, "m").c_str(), number(volume, "m^3").c_str());
    }
  }
  if (as_json) std::printf("%s\n", rows.dump(2).c_str());
  return kOk;
}

}  // namespace

Command solidsCommand() {
  Command command("solids", "List the project's own solids");
  auto as_json = std::make_shared<bool>(false);
  command.flag("--json", *as_json, "Print JSON, lengths in metres");
  command.notes = "Each line: the name, the size along x, y and z, and the volume.";
  command.examples = {"innersphere solids", "innersphere convert torus torus.obj"};
  command.run = [as_json] { return list(*as_json); };
  return command;
}

}  // namespace innersphere::tool
