// Files that appear under their name only when they are complete.
#pragma once

#include <functional>
#include <string>

#include "command.hpp"
#include "innersphere/packing.hpp"

namespace innersphere::tool {

/// "-", in place of the name of a file to write, means stdout; reports then go to stderr.
bool isStdout(const std::string& path);

/// Says early, before any work, that an output cannot be written. Throws Error file_exists or write_failed.
/// An empty path means that this output is not wanted.
void checkOutput(const std::string& path, bool force);

/// Calls `write` with a temporary name in the same folder, then renames. A symbolic link stays, and what it
/// leads to is replaced; a file that is replaced leaves its permissions to the new one. Pipes, devices and
/// stdout get the bytes when all are there. Throws Error as above, and removes what was written if something
/// fails.
void writeOutput(const std::string& path, bool force, const std::function<void(const std::string&)>& write);

/// Writes a text file in that way.
void writeTextOutput(const std::string& path, bool force, const std::string& text);

/// Where a packing goes.
struct PackingOutput {
  std::string path;
  std::string format = "json";  ///< of what has no name with an ending: stdout, a device
  bool force = false;
};

/// Adds --format and --force.
void addPackingOutputOptions(Command& command, PackingOutput& output);

/// Like checkOutput(), for a packing, whose ending must be one of those that can be written. Throws Error
/// bad_argument, too.
void checkPackingOutput(const PackingOutput& output);

/// Calls write() with a path whose ending names the format, and whether a file there may be replaced.
void writeNamedOutput(const PackingOutput& output,
                      const std::function<void(const std::string&, bool overwrite)>& write);

void writePackingOutput(const Packing& packing, const PackingOutput& output);

}  // namespace innersphere::tool
