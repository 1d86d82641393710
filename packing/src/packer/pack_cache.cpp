#include "packer/pack_cache.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "common/hash.hpp"
#include "file/file_io.hpp"
#include "file/packing_json.hpp"
#include "innersphere/error.hpp"

namespace innersphere {
namespace {

namespace fs = std::filesystem;

std::string digestOf(std::string_view bytes) {
  Hash hash;
  hash.add(std::uint64_t{bytes.size()});
  for (std::size_t i = 0; i < bytes.size(); i += 8) {
    std::uint64_t word = 0;
    for (std::size_t k = i; k < std::min(i + 8, bytes.size()); ++k)
      word = word << 8 | static_cast<unsigned char>(bytes[k]);
    hash.add(word);
  }
  return hash.text();
}

/// First line of the file of an entry.
std::string headOf(const std::string& key, std::string_view bytes) {
  return "InnerSphere cached packing 1 " + key + " " + digestOf(bytes) + "\n";
}

}  // namespace

std::string PackCache::keyOf(const Mesh& mesh, const std::string& options) {
  Hash hash;
  hash.add(std::string(INNERSPHERE_VERSION) + "\n" + options + "\n");
  hash.add(std::uint64_t{mesh.vertices.size()});
  for (const Vec3d& vertex : mesh.vertices) {
    for (double x : vertex) hash.add(x);
  }
  for (const auto& triangle : mesh.triangles) {
    for (std::uint32_t index : triangle) hash.add(std::uint64_t{index});
  }
  return hash.text();
}

PackCache::PackCache(const std::string& folder, const std::string& key)
    : folder_(folder), key_(key), path_((fs::path(folder) / (key + ".packing")).string()) {}

std::optional<Packing> PackCache::read() const {
  std::error_code error;
  if (!fs::exists(path_, error)) return std::nullopt;
  const std::string file = readFile(path_);
  const std::size_t head = file.find('\n') + 1;  // 0 if there is no line
  const std::string_view bytes = std::string_view(file).substr(head);
  if (file.substr(0, head) != headOf(key_, bytes))
    throw Error(ErrorCode::bad_format, path_ + " is damaged, or was kept for something else");
  Packing packing = fromCbor(std::string(bytes));
  validate(packing);
  return packing;
}

void PackCache::write(const Packing& packing) const {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) {
    throw Error(ErrorCode::write_failed,
                "cannot make the folder " + folder_ + " (" + error.message() + "); choose another one");
  }
  const std::string bytes = toCbor(packing);
  writeFile(path_, headOf(key_, bytes) + bytes, true);
}

}  // namespace innersphere
