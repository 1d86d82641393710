#include <memory>

#include "commands.hpp"
#include "exit_codes.hpp"
#include "inputs.hpp"
#include "packing_report.hpp"

namespace innersphere::tool {

Command infoCommand() {
  struct Arguments {
    std::string file;
    bool json = false;
  };
  Command command("info", "Say what a packing file holds, or a covering or clump, and how good it is");
  auto arguments = std::make_shared<Arguments>();
  addPackingArgument(command, "FILE", arguments->file);
  command.flag("--json", arguments->json, "Print JSON, lengths in metres");
  command.examples = {"innersphere info bunny.cbor --json"};
  command.run = [arguments] {
    std::visit([&](const auto& spheres) { describe(spheres).print(arguments->json); },
               loadSpheres(arguments->file));
    return kOk;
  };
  return command;
}

}  // namespace innersphere::tool
