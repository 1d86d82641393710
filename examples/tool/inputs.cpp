#include "inputs.hpp"

#include <algorithm>
#include <filesystem>

#include "innersphere/error.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing_file.hpp"
#include "innersphere/solids.hpp"
#include "numbers.hpp"
#include "scenes/scaled_solid.hpp"
#include "terminal.hpp"

namespace innersphere::tool {

void addScaleOption(CLI::App& command, MeshOptions& options) {
  command.add_option("--scale", options.scale, "Multiplies all coordinates: 0.001 for a mesh in millimetres")
      ->check(positive())
      ->capture_default_str();
}

void addRepairOption(CLI::App& command, MeshOptions& options) {
  command.add_flag(
      "--repair", options.repair,
      "Take a mesh that does not bound a volume anyway: holes are closed with flat fans, inside is where its "
      "winding number exceeds 1/2");
}

std::shared_ptr<const Solid> loadSolid(const SolidArguments& arguments) {
  const std::vector<std::string> names = namedSolids();
  if (std::find(names.begin(), names.end(), arguments.source) != names.end()) {
    return demo::scaledSolid(makeNamedSolid(arguments.source), arguments.mesh.scale);
  }
  if (!std::filesystem::exists(arguments.source)) {
    throw Error(ErrorCode::file_not_found, "there is neither a file nor a solid named \"" + arguments.source +
                                               "\"; `innersphere solids` lists the solids");
  }
  MeshReport report;
  auto solid =
      makeSolid(readMesh(arguments.source, arguments.mesh), arguments.source, arguments.mesh, &report);
  for (const std::string& note : report.notes) say(arguments.source + ": " + note);
  return solid;
}

Packing loadOrPack(const std::string& source, std::size_t spheres) {
  const std::string ending = std::filesystem::path(source).extension().string();
  if (ending == ".json" || ending == ".cbor" || ending == ".xyzr") return readPacking(source);
  PackOptions options;
  options.spheres = spheres;
  return pack(*loadSolid({source, {}}), options, progressBar());
}

}  // namespace innersphere::tool
