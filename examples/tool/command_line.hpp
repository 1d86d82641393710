// Reads a command line, and says how to write one. The only part that knows CLI11.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "command.hpp"

namespace innersphere::tool {

/// A command line that cannot be understood; the message names the part and the way out.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Finds the command, gives its options their values and runs it; --help prints the help instead. The flags
/// of `everywhere` are those of every command. Returns the exit status. Throws UsageError, and what the
/// command throws.
int runCommandLine(const Command& root, const std::vector<Option>& everywhere,
                   const std::vector<std::string>& words);

/// The help of the command that these words lead to, of the whole tool if there are none. Throws UsageError.
std::string helpOf(const Command& root, const std::vector<Option>& everywhere,
                   const std::vector<std::string>& words);

/// That of the tool and of all commands, one after the other.
std::string helpOfAll(const Command& root, const std::vector<Option>& everywhere);

/// The command that these words lead to, with the words on the way: {"scene", "run"}. Words that lead no
/// further are an error, unless the command takes arguments. Throws UsageError.
struct Found {
  const Command* command;
  std::string path;                ///< "innersphere scene run"
  std::vector<std::string> words;  ///< what was not a part of the path: options and arguments
};
Found findCommand(const Command& root, const std::vector<std::string>& words);

}  // namespace innersphere::tool
