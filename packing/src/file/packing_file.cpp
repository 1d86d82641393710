#include "innersphere/packing_file.hpp"

#include <sstream>

#include "file/file_io.hpp"
#include "file/packing_json.hpp"
#include "file/packing_text.hpp"
#include "innersphere/check.hpp"
#include "innersphere/error.hpp"

namespace innersphere {
namespace {

[[noreturn]] void rethrowNaming(const std::string& path, const Error& error) {
  // A packing that fails validate() was no bad argument of the caller: the file says so.
  const ErrorCode code = error.code() == ErrorCode::bad_argument ? ErrorCode::bad_format : error.code();
  throw Error(code, path + ": " + error.what());
}

// Spheres of other programs may overlap, and a user should know.
void flagOverlaps(Packing& packing) {
  const CheckReport found = check(packing);
  const double rounding = 1e-6 * packing.spheres[found.overlap_j].radius;
  if (found.worst_overlap <= rounding) return;
  std::ostringstream sentence;
  sentence << "spheres overlap, worst spheres " << found.overlap_i << " and " << found.overlap_j << " by "
           << found.worst_overlap << " m: what they share counts twice in overlap volumes";
  packing.warnings.push_back(sentence.str());
}

}  // namespace

Packing readPacking(const std::string& path) {
  const std::string bytes = readFile(path);
  const std::string ending = endingOf(path);
  try {
    Packing packing;
    if (ending == "json") {
      packing = fromJson(bytes);
    } else if (ending == "cbor") {
      packing = fromCbor(bytes);
    } else if (ending == "xyzr") {
      packing = fromXyzr(bytes);
      packing.provenance.source = path;
    } else {
      throw Error(ErrorCode::bad_format, "a packing is read from .json, .cbor or .xyzr, not from ." + ending);
    }
    validate(packing);
    if (ending == "xyzr") flagOverlaps(packing);
    return packing;
  } catch (const Error& error) {
    rethrowNaming(path, error);
  }
}

void writePacking(const Packing& packing, const std::string& path, bool overwrite) {
  validate(packing);
  const std::string ending = endingOf(path);
  if (ending == "json") return writeFile(path, toJson(packing), overwrite);
  if (ending == "cbor") return writeFile(path, toCbor(packing), overwrite);
  if (ending == "ply") return writeFile(path, toPly(packing), overwrite);
  if (ending == "xyzr") return writeFile(path, toXyzr(packing), overwrite);
  throw Error(ErrorCode::bad_argument, "a packing is written to .json, .cbor, .ply or .xyzr, not to " + path);
}

std::string encodePacking(const Packing& packing) {
  validate(packing);
  return toCbor(packing);
}

Packing decodePacking(const std::string& bytes) {
  try {
    Packing packing = fromCbor(bytes);
    validate(packing);
    return packing;
  } catch (const Error& error) {
    rethrowNaming("encoded packing", error);
  }
}

}  // namespace innersphere
