#include "mesh/import/whole_glb.hpp"

#include <cstdint>

#include "innersphere/error.hpp"
#include "mesh/import/byte_cursor.hpp"

namespace innersphere {
namespace {

constexpr std::string_view kMagic = "glTF";
constexpr std::uint32_t kWithChunks = 2;  // the version
constexpr std::size_t kChunkHeader = 8;   // bytes

std::string sizes(std::uint32_t by_header, std::size_t there) {
  return " has " + std::to_string(by_header) + " bytes by its header, but " + std::to_string(there) +
         " are there; the file was cut or is damaged, copy or export it again";
}

}  // namespace

void requireWholeGlb(std::string_view bytes, const std::string& path) {
  if (bytes.substr(0, kMagic.size()) != kMagic.substr(0, bytes.size())) return;
  ByteCursor file(bytes, path);
  file.skip(kMagic.size());
  const auto version = file.take<std::uint32_t>(), size = file.take<std::uint32_t>();
  if (size > bytes.size()) file.fail("the file" + sizes(size, bytes.size()));
  if (version != kWithChunks) return;
  while (file.place() < size && file.left() >= kChunkHeader) {
    const auto chunk = file.take<std::uint32_t>();
    file.skip(sizeof(std::uint32_t));  // its type
    if (chunk > file.left()) file.fail("a part" + sizes(chunk, file.left()));
    file.skip(chunk);
  }
}

}  // namespace innersphere
