#include <memory>

#include "commands.hpp"
#include "innersphere/packing_file.hpp"
#include "outputs.hpp"

namespace innersphere::tool {

void addConvertCommand(CLI::App& app, Session&) {
  struct Arguments {
    std::string input;
    std::string output;
    bool force = false;
  };
  CLI::App* command = app.add_subcommand("convert", "Write a packing in another format");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("INPUT", arguments->input, "Packing file: .json, .cbor or .xyzr")->required();
  command
      ->add_option("OUTPUT", arguments->output, "File to write: .json, .cbor, .ply or .xyzr (spheres only)")
      ->required();
  command->add_flag("--force", arguments->force, "Replace an existing output");
  command->footer("Example:\n  innersphere convert bunny.cbor bunny.ply");
  command->callback([arguments] {
    checkPackingOutput(arguments->output, arguments->force);
    writePacking(readPacking(arguments->input), arguments->output, arguments->force);
  });
}

}  // namespace innersphere::tool
