#include "inputs.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>

#include "file_names.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing_file.hpp"
#include "innersphere/solids.hpp"
#include "scenes/scaled_solid.hpp"
#include "suggestion.hpp"
#include "temporary_file.hpp"
#include "terminal.hpp"

namespace innersphere::tool {
namespace {

bool isNamedSolid(const std::string& source) {
  const std::vector<std::string> names = namedSolids();
  return std::find(names.begin(), names.end(), source) != names.end();
}

std::string readAll(const std::string& source) {
  FILE* file = source == "-" ? stdin : std::fopen(source.c_str(), "rb");
  std::string bytes;
  if (file) {
    char block[1 << 16];
    while (const std::size_t n = std::fread(block, 1, sizeof block, file)) bytes.append(block, n);
  }
  const bool good = file && std::ferror(file) == 0;
  const int code = errno;
  if (file && file != stdin) std::fclose(file);
  if (!good) throw Error(ErrorCode::file_not_found, "cannot read " + source + ": " + std::strerror(code));
  return bytes;
}

// JSON begins with a brace, a map in CBOR with a byte from a0 to bf, and what is left is a table of spheres.
std::string endingFor(const std::string& bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  const auto byte = static_cast<unsigned char>(first == std::string::npos ? 0 : bytes[first]);
  if (byte == '{') return ".json";
  return byte >= 0xa0 && byte <= 0xbf ? ".cbor" : ".xyzr";
}

Packing readStream(const std::string& source) {
  const std::string name = source == "-" ? "stdin" : source;
  const std::string bytes = readAll(source);
  const TemporaryFile file(endingFor(bytes));
  std::ofstream stream(file.path(), std::ios::binary);
  stream << bytes;
  stream.close();
  if (!stream)
    throw Error(ErrorCode::write_failed, "cannot keep what was read from " + name + " in " + file.path());
  try {
    Packing packing = readPacking(file.path());
    if (packing.provenance.source == file.path()) packing.provenance.source = name;
    return packing;
  } catch (const Error& error) {
    std::string message = error.what();
    const std::size_t at = message.find(file.path());
    if (at != std::string::npos) message.replace(at, file.path().size(), name);
    throw Error(error.code(), message);
  }
}

}  // namespace

void addPackingArgument(Command& command, const std::string& name, std::string& source) {
  command.argument(name, source, "Packing file: .json, .cbor or .xyzr; -: stdin").withFile();
}

void addScaleOption(Command& command, MeshOptions& options) {
  command.number("--scale", options.scale, kPositive,
                 "Multiplies all coordinates: 0.001 for a mesh in millimetres");
}

void addRepairOption(Command& command, MeshOptions& options) {
  command.flag(
      "--repair", options.repair,
      "Take a mesh that does not bound a volume anyway: holes are closed with flat fans, ends of pipes "
      "with rings, inside is where its winding number exceeds 1/2");
}

std::shared_ptr<const Solid> loadSolid(const SolidArguments& arguments) {
  const EndsAtOnce at_once;
  if (isNamedSolid(arguments.source)) {
    return demo::scaledSolid(makeNamedSolid(arguments.source), arguments.mesh.scale);
  }
  if (isStream(arguments.source)) {
    throw Error(ErrorCode::bad_argument, "a mesh is not read from " + arguments.source +
                                             ": its format is known by the ending of a file; name one");
  }
  if (!std::filesystem::exists(arguments.source)) {
    throw Error(ErrorCode::file_not_found,
                "there is neither a file nor a solid named \"" + arguments.source + "\"" +
                    didYouMean(arguments.source, namedSolids(), "; `innersphere solids` lists the solids"));
  }
  const auto tell = [&](const std::string& note) { say(arguments.source + ": " + note); };
  std::vector<std::string> notes;
  Mesh mesh = readMesh(arguments.source, arguments.mesh, &notes);
  for (const std::string& note : notes) tell(note);
  MeshReport report;
  auto solid = makeSolid(std::move(mesh), arguments.source, arguments.mesh, &report);
  for (const std::string& note : report.notes) tell(note);
  return solid;
}

bool isPacking(const std::string& source) {
  const std::string ending = endingOf(source);
  return isStream(source) || ending == ".json" || ending == ".cbor" || ending == ".xyzr";
}

bool isSolid(const std::string& source) {
  return !isPacking(source) && (std::filesystem::exists(source) || isNamedSolid(source));
}

Packing loadPacking(const std::string& source) {
  if (isStream(source)) return readStream(source);
  if (!isSolid(source)) return readPacking(source);
  throw Error(
      ErrorCode::bad_format,
      source + " is no packing: that is read from .json, .cbor or .xyzr; `innersphere pack` makes one");
}

std::variant<Packing, Covering> loadSpheres(const std::string& source) {
  // Packings first: they may be large, and are not to be read twice.
  try {
    return loadPacking(source);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_format || isStream(source) || endingOf(source) != ".json") throw;
    std::optional<Covering> covering = readCovering(source);
    if (!covering) throw;
    return *std::move(covering);
  }
}

Packing loadOrPack(const std::string& source, std::size_t spheres) {
  if (isPacking(source)) return loadPacking(source);
  PackOptions options;
  options.spheres = spheres;
  return pack(*loadSolid({source, {}}), options, progressBar());
}

std::string stemOf(const std::string& source) {
  if (source == "-") return "stdin";
  std::filesystem::path stem = std::filesystem::path(source).stem();
  if (endingOf(source) == ".gz") stem = stem.stem();
  return stem.string();
}

}  // namespace innersphere::tool
