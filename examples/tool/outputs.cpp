#include "outputs.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "innersphere/error.hpp"

namespace innersphere::tool {
namespace fs = std::filesystem;

void checkOutput(const std::string& path, bool force) {
  if (path.empty()) return;
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    throw Error(ErrorCode::write_failed, "cannot write " + path + ": it is a folder; name a file in it");
  }
  if (!force && fs::exists(path, ignored)) {
    throw Error(ErrorCode::file_exists, path + " exists; give --force to replace it");
  }
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored)) {
    throw Error(ErrorCode::write_failed, "cannot write " + path + ": there is no folder " + folder.string());
  }
  if (access(folder.c_str(), W_OK) != 0) {
    throw Error(ErrorCode::write_failed, "cannot write " + path + ": " + std::strerror(errno));
  }
}

void checkPackingOutput(const std::string& path, bool force) {
  const std::string ending = fs::path(path).extension().string();
  if (ending != ".json" && ending != ".cbor" && ending != ".ply" && ending != ".xyzr") {
    throw Error(ErrorCode::bad_argument,
                "a packing is written to .json, .cbor, .ply or .xyzr, not to " + path);
  }
  checkOutput(path, force);
}

void writeOutput(const std::string& path, bool force, const std::function<void(const std::string&)>& write) {
  const std::string temporary = path + "." + std::to_string(getpid()) + ".tmp";
  const auto discard = [&temporary] {
    std::error_code ignored;
    fs::remove(temporary, ignored);
  };
  try {
    checkOutput(path, force);
    write(temporary);
    std::error_code failure;
    fs::rename(temporary, path, failure);
    if (failure) throw Error(ErrorCode::write_failed, "cannot write " + path + ": " + failure.message());
  } catch (...) {
    discard();
    throw;
  }
}

void writeTextOutput(const std::string& path, bool force, const std::string& text) {
  writeOutput(path, force, [&](const std::string& temporary) {
    std::ofstream file(temporary, std::ios::binary);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file) throw Error(ErrorCode::write_failed, "cannot write " + path + ": " + std::strerror(errno));
  });
}

}  // namespace innersphere::tool
