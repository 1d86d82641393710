// Reads and writes the schema of packing files, the same for JSON and CBOR.
#pragma once

#include <string>

#include "innersphere/packing.hpp"

namespace innersphere {

/// Returns JSON text with a line for each top-level entry.
std::string toJson(const Packing& packing);

/// Returns the same as CBOR, where arrays of floats and indices are byte strings of little-endian 32-bit
/// numbers.
std::string toCbor(const Packing& packing);

/// Reads what toJson() writes. Any bytes are safe: memory is bounded by a small multiple of their number.
/// Throws Error: bad_format, unsupported_version.
Packing fromJson(const std::string& text);
/// Reads what toCbor() writes, as safely and with the same errors.
Packing fromCbor(const std::string& bytes);

}  // namespace innersphere
