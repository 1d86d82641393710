#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "common/bounds.hpp"
#include "file/file_io.hpp"
#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "mesh/import/gunzip.hpp"
#include "mesh/import/read_apart.hpp"
#include "mesh/import/read_assimp.hpp"
#include "mesh/import/readers.hpp"
#include "mesh/import/unit_3mf.hpp"
#include "mesh/import/whole_glb.hpp"
#include "mesh/mesh_clean.hpp"
#include "mesh/mesh_report.hpp"

namespace innersphere {
namespace {

void requireReadableFile(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw Error(ErrorCode::file_not_found, "there is no file " + path + "; check the path");
  }
  if (std::filesystem::is_directory(status)) {
    throw Error(ErrorCode::file_not_found, path + " is a folder; name a mesh file in it");
  }
  if (std::filesystem::is_regular_file(status) && std::filesystem::file_size(path, error) == 0 && !error) {
    throw Error(ErrorCode::empty_input, path + " is empty (0 bytes); export the mesh again");
  }
}

using Reader = Mesh (*)(std::string_view bytes, const std::string& path);

// The project's own reader of a format without notes, null if there is none.
Reader readerOf(const std::string& ending) {
  if (ending == "obj") return readObj;
  if (ending == "off") return readOff;
  if (ending == "ply") return readPly;
  return nullptr;
}

void scaleBy(double scale, Mesh& mesh, const std::string& path) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    Vec3d& v = mesh.vertices[i];
    const Vec3d before = v;
    v = scale * v;
    if (isFinite(v)) continue;
    throw Error(ErrorCode::not_finite, "vertex " + std::to_string(i) + " of " + path + ", " + text(before) +
                                           ", is too far away for the scale " + text(scale));
  }
}

// assimp applies the unit of COLLADA files, but not that of 3MF files.
void toMetres(Mesh& mesh, const std::string& path, std::vector<std::string>& notes) {
  const std::optional<LengthUnit> unit = unitOf3mf(readFile(path));
  if (!unit) {
    notes.push_back("the unit of the file is not known; its numbers are taken for metres");
  } else if (unit->metres != 1) {
    notes.push_back("the file is in the unit " + unit->name + ": its numbers are multiplied by " +
                    text(unit->metres));
    scaleBy(unit->metres, mesh, path);
  }
}

Mesh readAny(const std::string& path, bool own_process, std::vector<std::string>& notes) {
  const bool compressed = endingOf(path) == "gz";
  const std::string ending = endingOf(compressed ? path.substr(0, path.size() - 3) : path);
  const auto bytes = [&] { return compressed ? gunzip(readFile(path), path) : readFile(path); };
  if (ending == "stl") return readStl(bytes(), path, notes);
  if (const Reader reader = readerOf(ending)) return reader(bytes(), path);
  if (compressed) {
    throw Error(ErrorCode::bad_format,
                path + " cannot be read: only .obj, .stl, .ply and .off may be compressed; unpack it");
  }
  if (ending == "glb") requireWholeGlb(readFile(path), path);
  Mesh mesh = own_process ? readApart(readAssimp, path) : readAssimp(path);
  if (ending == "3mf") toMetres(mesh, path, notes);
  return mesh;
}

}  // namespace

Mesh readMesh(const std::string& path, const MeshOptions& options, std::vector<std::string>* notes) {
  if (!(options.scale > 0) || !std::isfinite(options.scale)) {
    throw Error(ErrorCode::bad_argument,
                "the scale of a mesh has to be a number over 0, not " + text(options.scale));
  }
  requireReadableFile(path);
  std::vector<std::string> found;
  Mesh mesh = readAny(path, options.own_process, found);
  if (notes) notes->insert(notes->end(), found.begin(), found.end());
  if (mesh.triangles.empty()) {
    throw Error(ErrorCode::empty_input, path + " has no triangles; export the surface, not points or curves");
  }
  scaleBy(options.scale, mesh, path);
  weldEqual(mesh);
  return mesh;
}

}  // namespace innersphere
