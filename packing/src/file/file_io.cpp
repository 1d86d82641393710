#include "file/file_io.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "innersphere/error.hpp"
#include "innersphere/replace_file.hpp"

namespace innersphere {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargest = std::size_t{2} << 30;

struct Close {
  void operator()(FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<FILE, Close>;

bool exists(const std::string& path) {
  std::error_code error;
  return fs::exists(fs::symlink_status(path, error));
}

[[noreturn]] void failToWrite(const std::string& path, int code) {
  throw Error(ErrorCode::write_failed, "cannot write " + path + " (" + std::strerror(code) +
                                           "); check the folder and the free space");
}

// Gives a new file the permissions of the one that it will replace.
bool keepMode(const std::string& replaced, const std::string& file) {
  struct stat old {};
  return stat(replaced.c_str(), &old) != 0 || chmod(file.c_str(), old.st_mode & 07777) == 0;
}

}  // namespace

std::string endingOf(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  if (!ending.empty()) ending.erase(0, 1);
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

std::string readFile(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    throw Error(ErrorCode::file_not_found, path + " is a folder; name a file in it");
  }
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) {
    throw Error(ErrorCode::file_not_found,
                "cannot open " + path + " (" + std::strerror(errno) + "); check the path");
  }
  std::string bytes;
  char block[1 << 16];
  while (const std::size_t n = std::fread(block, 1, sizeof block, file.get())) {
    bytes.append(block, n);
    if (bytes.size() > kLargest)
      throw Error(ErrorCode::bad_format, path + " is over 2 GiB, too large to be read");
  }
  if (std::ferror(file.get())) {
    throw Error(ErrorCode::bad_format, path + " could not be read to its end (" + std::strerror(errno) + ")");
  }
  return bytes;
}

std::string linkTarget(const std::string& path) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  fs::path target = path;
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(fs::symlink_status(target, error)); ++i) {
    target = target.parent_path() / fs::read_symlink(target, error);
  }
  return target.string();
}

void replaceFile(const std::string& path, bool overwrite,
                 const std::function<void(const std::string& temporary)>& write) {
  if (!overwrite && exists(path)) {
    throw Error(ErrorCode::file_exists, path + " exists already; choose another name or ask for overwriting");
  }
  static std::atomic<unsigned> counter{0};
  const std::string target = linkTarget(path);
  const std::string temporary =
      target + "." + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".tmp";
  try {
    write(temporary);
    if (!keepMode(target, temporary) || std::rename(temporary.c_str(), target.c_str()) != 0) {
      failToWrite(path, errno);
    }
  } catch (...) {
    std::remove(temporary.c_str());
    throw;
  }
}

void writeFile(const std::string& path, const std::string& bytes, bool overwrite) {
  replaceFile(path, overwrite, [&](const std::string& temporary) {
    FILE* file = std::fopen(temporary.c_str(), "wbx");
    if (!file) failToWrite(path, errno);
    errno = 0;
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    const bool closed = std::fclose(file) == 0;
    if (!written || !closed) failToWrite(path, errno);
  });
}

}  // namespace innersphere
