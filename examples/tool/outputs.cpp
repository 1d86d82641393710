#include "outputs.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "file_names.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packing_file.hpp"
#include "innersphere/replace_file.hpp"
#include "temporary_file.hpp"

namespace innersphere::tool {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw Error(ErrorCode::write_failed, "cannot write " + path + ": " + reason);
}

void copyTo(const std::string& path, const std::string& from) {
  FILE* file = isStdout(path) ? stdout : std::fopen(path.c_str(), "wb");
  if (!file) fail(path, std::strerror(errno));
  std::ifstream input(from, std::ios::binary);
  char block[1 << 16];
  bool good = true;
  while (good && (input.read(block, sizeof block), input.gcount() > 0)) {
    const auto n = static_cast<std::size_t>(input.gcount());
    good = std::fwrite(block, 1, n, file) == n;
  }
  good = std::fflush(file) == 0 && good;
  const int code = errno;
  if (file != stdout) std::fclose(file);
  if (!good) fail(isStdout(path) ? "to stdout" : path, std::strerror(code));
}

}  // namespace

bool isStdout(const std::string& path) {
  return path == "-";
}

void checkOutput(const std::string& path, bool force) {
  if (path.empty() || isStream(path)) return;
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) fail(path, "it is a folder; name a file in it");
  if (!force && fs::exists(fs::symlink_status(path, ignored))) {
    throw Error(ErrorCode::file_exists, path + " exists; give --force to replace it");
  }
  const fs::path target = linkTarget(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored)) fail(path, "there is no folder " + folder.string());
  if (access(folder.c_str(), W_OK) != 0) fail(path, std::strerror(errno));
}

void writeOutput(const std::string& path, bool force, const std::function<void(const std::string&)>& write) {
  checkOutput(path, force);
  if (isStream(path)) {
    const TemporaryFile file("");
    write(file.path());
    return copyTo(path, file.path());
  }
  replaceFile(path, force, write);
}

void writeTextOutput(const std::string& path, bool force, const std::string& text) {
  writeOutput(path, force, [&](const std::string& temporary) {
    std::ofstream file(temporary, std::ios::binary);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file) fail(path, std::strerror(errno));
  });
}

void addPackingOutputOptions(Command& command, PackingOutput& output) {
  command.choice<std::string>("--format", output.format,
                              {{"json", "json"}, {"cbor", "cbor"}, {"ply", "ply"}, {"xyzr", "xyzr"}},
                              "Of what goes to stdout; that of a file is its ending");
  command.flag("--force", output.force, "Replace an existing output");
}

void checkPackingOutput(const PackingOutput& output) {
  const std::string ending = endingOf(output.path);
  if (!isStream(output.path) && ending != ".json" && ending != ".cbor" && ending != ".ply" &&
      ending != ".xyzr") {
    throw Error(ErrorCode::bad_argument,
                "a packing is written to .json, .cbor, .ply or .xyzr, not to " + output.path);
  }
  checkOutput(output.path, output.force);
}

void writeNamedOutput(const PackingOutput& output,
                      const std::function<void(const std::string&, bool overwrite)>& write) {
  if (!isStream(output.path)) return write(output.path, output.force);
  const TemporaryFile file("." + output.format);
  write(file.path(), false);
  copyTo(output.path, file.path());
}

void writePackingOutput(const Packing& packing, const PackingOutput& output) {
  writeNamedOutput(output, [&](const std::string& path, bool force) { writePacking(packing, path, force); });
}

}  // namespace innersphere::tool
