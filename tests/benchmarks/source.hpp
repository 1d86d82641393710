// What a benchmark measures with: a user's mesh, a packing file or one of the project's own solids.
#pragma once

#include <memory>
#include <string>

#include "innersphere/packing.hpp"
#include "innersphere/solid.hpp"

namespace innersphere::benchmarks {

/// The name of a file without folders and ending; other names as they are.
std::string plainName(const std::string& source);

/// Reads a mesh file, or makes the named solid, or a box around a closed void:
/// "hollow:LENGTHxWIDTHxHEIGHTxWALL", in any unit.
std::unique_ptr<Solid> solidFrom(const std::string& source);

/// Reads a packing file (.cbor, .json), or packs a mesh file or named solid with `spheres` spheres.
std::shared_ptr<const Packing> packingFrom(const std::string& source, std::size_t spheres);

/// Of the surface, or of the spheres where the packing has none; in the packing's frame.
Bounds boxOf(const Packing& packing);

}  // namespace innersphere::benchmarks
