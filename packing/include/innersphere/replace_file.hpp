// Replaces a file all or nothing.
#pragma once

#include <functional>
#include <string>

namespace innersphere {

/// Returns the file that a symbolic link leads to, be it there or not; the path itself if it is no link.
std::string linkTarget(const std::string& path);

/// Has `write` write to a temporary name in the same folder and renames that to `path`, so that nobody ever
/// sees half a file. A symbolic link stays, and what it leads to is replaced. A file that is replaced leaves
/// its permissions to the new one. Throws Error: file_exists (unless `overwrite`), write_failed, and what
/// `write` throws; then the folder is as it was.
void replaceFile(const std::string& path, bool overwrite,
                 const std::function<void(const std::string& temporary)>& write);

}  // namespace innersphere
