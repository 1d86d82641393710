// Keeps packings on disk, each in a file named after what it was made from.
#pragma once

#include <optional>
#include <string>

#include "innersphere/geometry.hpp"
#include "innersphere/packing.hpp"

namespace innersphere {

/// This is one entry of a folder. Its file is a line that says what it belongs to and what its bytes add up
/// to, and then the packing as in a .cbor file.
class PackCache {
 public:
  /// Returns the key of a mesh, the options that it is packed with, and this version of InnerSphere; it is
  /// hexadecimal.
  static std::string keyOf(const Mesh& mesh, const std::string& options);

  /// Names an entry; touches no file.
  PackCache(const std::string& folder, const std::string& key);

  /// Returns the packing, or nothing if there is no file. Throws Error: bad_format if the file belongs to
  /// something else or is damaged, file_not_found if it cannot be opened.
  std::optional<Packing> read() const;

  /// Writes the file, and makes the folder where there is none. The file appears only when it is complete.
  /// Throws Error write_failed.
  void write(const Packing& packing) const;

 private:
  const std::string folder_;
  const std::string key_;
  const std::string path_;
};

}  // namespace innersphere
