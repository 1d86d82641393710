// What commands work on: solids and packings.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "innersphere/mesh.hpp"
#include "innersphere/packing.hpp"
#include "innersphere/solid.hpp"

namespace innersphere::tool {

/// A mesh file or the name of one of the project's solids.
struct SolidArguments {
  std::string source;
  MeshOptions mesh;
};

void addScaleOption(CLI::App& command, MeshOptions& options);
void addRepairOption(CLI::App& command, MeshOptions& options);

/// Reads the mesh or makes the solid; says what was mended or looks suspicious. Throws Error.
std::shared_ptr<const Solid> loadSolid(const SolidArguments& arguments);

/// Reads a packing file (.json, .cbor, .xyzr); packs anything else, which is then a mesh or a solid's name,
/// with this many spheres. Throws Error.
Packing loadOrPack(const std::string& source, std::size_t spheres);

}  // namespace innersphere::tool
