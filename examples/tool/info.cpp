#include <memory>

#include "commands.hpp"
#include "innersphere/packing_file.hpp"
#include "packing_report.hpp"

namespace innersphere::tool {

void addInfoCommand(CLI::App& app, Session&) {
  struct Arguments {
    std::string file;
    bool json = false;
  };
  CLI::App* command = app.add_subcommand("info", "Say what a packing file holds and how good it is");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("FILE", arguments->file, "Packing file: .json, .cbor or .xyzr")->required();
  command->add_flag("--json", arguments->json, "Print JSON, lengths in metres");
  command->footer("Example:\n  innersphere info bunny.cbor --json");
  command->callback([arguments] { describe(readPacking(arguments->file)).print(arguments->json); });
}

}  // namespace innersphere::tool
