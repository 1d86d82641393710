// Keeps packings on disk: .json (readable), .cbor (the same schema, binary), .ply and .xyzr (spheres only).
#pragma once

#include <string>

#include "innersphere/packing.hpp"

namespace innersphere {

/// Reads a packing; the format follows from the ending (.json, .cbor, .xyzr). No bytes in a file crash it. An
/// .xyzr file has spheres only: they are sorted, the mass properties are those of the balls, nothing is
/// certified, and a warning says so if they overlap. Throws Error: file_not_found, bad_format,
/// unsupported_version, empty_input, not_finite.
Packing readPacking(const std::string& path);

/// Writes a packing; the format follows from the ending (.json, .cbor, .ply, .xyzr; the last two hold spheres
/// only). The file appears under its name only when it is complete. An existing file is replaced only with
/// `overwrite`. Reading .json or .cbor gives the same numbers back, bit for bit. Throws Error: bad_argument
/// (unknown ending), file_exists, write_failed, and what validate() throws.
void writePacking(const Packing& packing, const std::string& path, bool overwrite = false);

/// Returns the bytes of a .cbor file, for sockets, databases and other processes. Throws what validate()
/// throws.
std::string encodePacking(const Packing& packing);

/// Reads what encodePacking() returns, bit for bit. No bytes crash it. Throws Error: bad_format,
/// unsupported_version, empty_input, not_finite.
Packing decodePacking(const std::string& bytes);

}  // namespace innersphere
