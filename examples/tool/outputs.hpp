// Files that appear under their name only when they are complete.
#pragma once

#include <functional>
#include <string>

namespace innersphere::tool {

/// Says early, before any work, that an output cannot be written. Throws Error file_exists or write_failed.
/// An empty path means that this output is not wanted.
void checkOutput(const std::string& path, bool force);

/// The same for a packing file, whose ending must be one of those that can be written. Throws Error
/// bad_argument, too.
void checkPackingOutput(const std::string& path, bool force);

/// Calls `write` with a temporary name in the same folder, then renames. Throws Error as above, and removes
/// what was written if something fails.
void writeOutput(const std::string& path, bool force, const std::function<void(const std::string&)>& write);

/// Writes a text file in that way.
void writeTextOutput(const std::string& path, bool force, const std::string& text);

}  // namespace innersphere::tool
