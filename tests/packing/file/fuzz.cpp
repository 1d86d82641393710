// libFuzzer target for the readers of packing files. The first byte chooses the format, the rest is the file.
// What is accepted has to be writable and readable again.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "file/packing_json.hpp"
#include "file/packing_text.hpp"
#include "innersphere/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace innersphere;
  if (size == 0) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  Packing packing;
  try {
    packing = data[0] == 'j' ? fromJson(bytes) : data[0] == 'c' ? fromCbor(bytes) : fromXyzr(bytes);
    validate(packing);
  } catch (const Error&) {
    return 0;
  }
  const std::size_t n = packing.spheres.size();
  if (fromCbor(toCbor(packing)).spheres.size() != n || fromJson(toJson(packing)).spheres.size() != n)
    std::abort();
  return 0;
}
