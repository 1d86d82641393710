// What commands work on: solids and packings.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "command.hpp"
#include "innersphere/covering.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packing.hpp"
#include "innersphere/solid.hpp"

namespace innersphere::tool {

/// A mesh file or the name of one of the project's solids.
struct SolidArguments {
  std::string source;
  MeshOptions mesh;
};

void addPackingArgument(Command& command, const std::string& name, std::string& source);
void addScaleOption(Command& command, MeshOptions& options);
void addRepairOption(Command& command, MeshOptions& options);

/// Reads the mesh, which may come through a pipe or from stdin ("-"), or makes the solid; says what was
/// mended or looks suspicious, and adds it to `notes`, which may be null. Throws Error.
std::shared_ptr<const Solid> loadSolid(const SolidArguments& arguments,
                                       std::vector<std::string>* notes = nullptr);

/// True for what loadPacking() reads: stdin ("-"), a pipe, or a file that ends in .json, .cbor or .xyzr.
bool isPacking(const std::string& source);

/// True for a solid's name, and for a file that is there and no packing by its ending.
bool isSolid(const std::string& source);

/// Reads a packing from a file (.json, .cbor, .xyzr), a pipe or stdin ("-"), whose content shows the format.
/// Throws Error.
Packing loadPacking(const std::string& source);

/// Reads a packing as loadPacking() does, or a covering or clump from a .json file. Throws Error.
std::variant<Packing, Covering> loadSpheres(const std::string& source);

/// Reads a packing; packs what is none, which is then a mesh or a solid's name, with this many spheres.
/// Throws Error.
Packing loadOrPack(const std::string& source, std::size_t spheres);

/// The name of a file without its folder and ending; "stdin" for "-".
std::string stemOf(const std::string& source);

}  // namespace innersphere::tool
