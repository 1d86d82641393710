// The tool's commands. Each function adds one with its options; it runs when the command line was parsed.
#pragma once

#include <CLI/CLI.hpp>

namespace innersphere::tool {

/// What commands share.
struct Session {
  int exit_code = 0;  ///< set by a command that worked and whose answer is no
};

void addPackCommand(CLI::App& app, Session& session);
void addInfoCommand(CLI::App& app, Session& session);
void addCheckCommand(CLI::App& app, Session& session);
void addConvertCommand(CLI::App& app, Session& session);
void addViewCommand(CLI::App& app, Session& session);
void addOverlapCommand(CLI::App& app, Session& session);
void addSceneCommand(CLI::App& app, Session& session);
void addSolidsCommand(CLI::App& app, Session& session);

}  // namespace innersphere::tool
