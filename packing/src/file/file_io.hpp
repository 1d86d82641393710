// Reads whole files with a limit, and writes them all or nothing.
#pragma once

#include <string>

namespace innersphere {

/// Returns the ending of a path in lower case, without the dot.
std::string endingOf(const std::string& path);

/// Returns the bytes of a file. Throws Error: file_not_found, bad_format (over 2 GiB, or not readable).
std::string readFile(const std::string& path);

/// Writes a file by replaceFile(), which see for errors.
void writeFile(const std::string& path, const std::string& bytes, bool overwrite);

}  // namespace innersphere
