// Reads whole files with a limit, and writes them all or nothing.
#pragma once

#include <string>

namespace innersphere {

/// Returns the ending of a path in lower case, without the dot.
std::string endingOf(const std::string& path);

/// Returns the bytes of a file. Throws Error: file_not_found, bad_format (over 2 GiB, or not readable).
std::string readFile(const std::string& path);

/// Writes to a temporary name in the same folder and renames that, so that nobody ever sees half a file. A
/// symbolic link stays, and what it leads to is replaced; a file that is replaced leaves its permissions to
/// the new one. Throws Error: file_exists, write_failed; then the folder is as it was.
void writeFile(const std::string& path, const std::string& bytes, bool overwrite);

}  // namespace innersphere
