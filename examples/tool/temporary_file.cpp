#include "temporary_file.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "innersphere/error.hpp"

namespace innersphere::tool {
namespace fs = std::filesystem;

TemporaryFile::TemporaryFile(const std::string& ending) {
  std::error_code ignored;
  folder_ = (fs::temp_directory_path(ignored) / "innersphere-XXXXXX").string();
  if (!mkdtemp(folder_.data())) {
    throw Error(ErrorCode::write_failed, "cannot make the folder " + folder_ + ": " + std::strerror(errno));
  }
  path_ = folder_ + "/file" + ending;
}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

}  // namespace innersphere::tool
