// What is written from the description of the commands: a manual page, and completion for shells.
#pragma once

#include <string>
#include <vector>

#include "command.hpp"

namespace innersphere::tool {

/// A page for man, section 1.
std::string manualPage(const Command& root, const std::vector<Option>& everywhere,
                       const std::string& version);

/// Scripts that make a shell complete commands, options and the names of what they take.
std::string bashCompletion(const Command& root, const std::vector<Option>& everywhere);
std::string zshCompletion(const Command& root, const std::vector<Option>& everywhere);
std::string fishCompletion(const Command& root, const std::vector<Option>& everywhere);

}  // namespace innersphere::tool
