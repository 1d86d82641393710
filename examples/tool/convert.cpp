#include <memory>

#include "commands.hpp"
#include "exit_codes.hpp"
#include "innersphere/error.hpp"
#include "innersphere/solids.hpp"
#include "inputs.hpp"
#include "outputs.hpp"
#include "surface_file.hpp"

namespace innersphere::tool {
namespace {

struct Arguments {
  std::string input;
  PackingOutput output;
};

void run(const Arguments& arguments) {
  const PackingOutput& output = arguments.output;
  if (!isSurfaceFile(output.path)) {
    checkPackingOutput(output);
    if (isSolid(arguments.input)) {
      throw Error(ErrorCode::bad_format,
                  arguments.input + " is no packing, and a surface is written to .obj or .stl, not to " +
                      output.path + "; `innersphere pack` makes a packing");
    }
    return writePackingOutput(loadPacking(arguments.input), output);
  }
  checkOutput(output.path, output.force);
  const Mesh surface = isPacking(arguments.input) ? surfaceOf(loadPacking(arguments.input))
                                                  : loadSolid({arguments.input, {}})->surface();
  writeSurface(surface, output.path, output.force);
}

}  // namespace

Command convertCommand() {
  Command command("convert", "Write a packing in another format, or the surface of a solid");
  auto arguments = std::make_shared<Arguments>();
  command
      .argument("INPUT", arguments->input,
                "Packing file: .json, .cbor or .xyzr; -: stdin; for a surface also a mesh or a solid's name")
      .withFile()
      .withSuggestions(namedSolids());
  command
      .argument("OUTPUT", arguments->output.path,
                "File to write: .json, .cbor, .ply or .xyzr (spheres only), .obj or .stl (the surface); -: "
                "to stdout")
      .withFile();
  addPackingOutputOptions(command, arguments->output);
  command.examples = {"innersphere convert bunny.cbor bunny.ply", "innersphere convert torus torus.obj",
                      "innersphere convert bunny.cbor - --format xyzr"};
  command.run = [arguments] {
    run(*arguments);
    return kOk;
  };
  return command;
}

}  // namespace innersphere::tool
