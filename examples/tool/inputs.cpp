#include "inputs.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
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

std::string nameOf(const std::string& source) {
  return source == "-" ? "stdin" : source;
}

// Reads what comes through a stream from a file with this ending, for `read` wants one.
template <class Read>
auto readKept(const std::string& source, const std::string& bytes, const std::string& ending,
              const Read& read) {
  const std::string name = nameOf(source);
  const TemporaryFile file(ending);
  std::ofstream stream(file.path(), std::ios::binary);
  stream << bytes;
  stream.close();
  if (!stream)
    throw Error(ErrorCode::write_failed, "cannot keep what was read from " + name + " in " + file.path());
  try {
    return read(file.path());
  } catch (const Error& error) {
    std::string message = error.what();
    const std::size_t at = message.find(file.path());
    if (at != std::string::npos) message.replace(at, file.path().size(), name);
    throw Error(error.code(), message);
  }
}

Packing readStream(const std::string& source) {
  const std::string bytes = readAll(source);
  return readKept(source, bytes, endingFor(bytes), [&](const std::string& path) {
    Packing packing = readPacking(path);
    if (packing.provenance.source == path) packing.provenance.source = nameOf(source);
    return packing;
  });
}

// Empty for what is known by its content alone, or not known.
std::string meshEndingFor(const std::string& bytes) {
  constexpr std::size_t kStlHead = 84, kStlTriangle = 50;
  const auto begins = [&](const std::string& word) { return bytes.compare(0, word.size(), word) == 0; };
  if (begins("ply\n") || begins("ply\r")) return ".ply";
  if (begins("glTF")) return ".glb";
  if (begins("PK\3\4")) return ".3mf";
  if (begins("{")) return ".gltf";
  if (begins("<")) return "";
  if (bytes.size() >= kStlHead) {
    std::uint32_t triangles = 0;
    std::memcpy(&triangles, bytes.data() + kStlHead - sizeof triangles, sizeof triangles);
    if (bytes.size() == kStlHead + kStlTriangle * triangles) return ".stl";
  }
  std::istringstream lines(bytes);
  std::string line, word;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    if (!(words >> word) || word[0] == '#') continue;
    if (word == "solid") return ".stl";
    if (word.size() <= 6 && word.size() >= 3 && word.compare(word.size() - 3, 3, "OFF") == 0) return ".off";
    for (const char* of_obj : {"v", "vn", "vt", "f", "o", "g", "s", "mtllib", "usemtl"}) {
      if (word == of_obj) return ".obj";
    }
    break;
  }
  return "";
}

Mesh meshFromStream(const SolidArguments& arguments, std::vector<std::string>& notes) {
  const std::string bytes = readAll(arguments.source);
  if (bytes.compare(0, 2, "\x1f\x8b") == 0) {
    throw Error(
        ErrorCode::bad_format,
        nameOf(arguments.source) + " is compressed; unpack it on the way: gunzip -c FILE | innersphere ...");
  }
  return readKept(arguments.source, bytes, meshEndingFor(bytes),
                  [&](const std::string& path) { return readMesh(path, arguments.mesh, &notes); });
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
  command.flag("--repair", options.repair,
               "Take a mesh that does not bound a volume anyway: vertices within 1e-4 of the diagonal are "
               "welded where it is open, holes closed with flat fans, ends of pipes with rings, inside is "
               "where its winding number exceeds 1/2");
}

std::shared_ptr<const Solid> loadSolid(const SolidArguments& arguments, std::vector<std::string>* notes) {
  const EndsAtOnce at_once;
  if (isNamedSolid(arguments.source)) {
    return demo::scaledSolid(makeNamedSolid(arguments.source), arguments.mesh.scale);
  }
  std::vector<std::string> found;
  const std::string name = nameOf(arguments.source);
  const auto solidOf = [&](Mesh mesh, std::vector<std::string>& sentences) {
    const auto tell = [&](std::size_t first) {
      for (std::size_t i = first; i < sentences.size(); ++i) say(name + ": " + sentences[i]);
      return sentences.size();
    };
    const std::size_t told = tell(0);
    MeshReport report;
    auto solid = makeSolid(std::move(mesh), name, arguments.mesh, &report);
    sentences.insert(sentences.end(), report.notes.begin(), report.notes.end());
    tell(told);
    if (notes) *notes = sentences;
    return solid;
  };
  if (isStream(arguments.source)) return solidOf(meshFromStream(arguments, found), found);
  if (!std::filesystem::exists(arguments.source)) {
    throw Error(ErrorCode::file_not_found,
                "there is neither a file nor a solid named \"" + arguments.source + "\"" +
                    didYouMean(arguments.source, namedSolids(), "; `innersphere solids` lists the solids"));
  }
  return solidOf(readMesh(arguments.source, arguments.mesh, &found), found);
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
