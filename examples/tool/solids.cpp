#include "innersphere/solids.hpp"
#include "commands.hpp"
#include "report.hpp"
#include "scenes/scaled_solid.hpp"

namespace innersphere::tool {

void addSolidsCommand(CLI::App& app, Session&) {
  CLI::App* command = app.add_subcommand("solids", "List the project's own solids");
  command->callback([] {
    for (const std::string& name : namedSolids()) {
      const auto solid = makeNamedSolid(name);
      const Bounds b = solid->bounds();
      const Vec3d size{b.max[0] - b.min[0], b.max[1] - b.min[1], b.max[2] - b.min[2]};
      std::printf("%-12s %s, %s\n", name.c_str(), vector(size, "m").c_str(),
                  number(solid->massProperties().volume, "m^3").c_str());
    }
  });
}

}  // namespace innersphere::tool
