// A file for a moment.
#pragma once

#include <string>

namespace innersphere::tool {

/// A name for a file in a new folder of its own in the system's folder for such; both are removed in the end.
class TemporaryFile {
 public:
  /// The name ends in `ending`. Throws Error write_failed.
  explicit TemporaryFile(const std::string& ending);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string folder_;
  std::string path_;
};

}  // namespace innersphere::tool
