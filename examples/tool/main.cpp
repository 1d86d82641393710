// innersphere: packs solids, shows and checks packings, measures overlaps and runs scenes.
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <utility>

#include "command_line.hpp"
#include "commands.hpp"
#include "documentation.hpp"
#include "exit_codes.hpp"
#include "innersphere/error.hpp"
#include "terminal.hpp"

namespace innersphere::tool {
namespace {

// All commands, and the options of each of them.
struct Tool {
  Command root{"innersphere", "Collision detection for moving non-convex solids, by inner-sphere packings"};
  std::vector<Option> everywhere;
  bool version = false;
  bool help_all = false;
  std::vector<std::string> help_words;
  std::string shell;

  Tool();
  int runRoot() const;
  Command helpCommand();
  Command completionCommand();
  Command manCommand() const;
};

Tool::Tool() {
  Option& quiet = everywhere.emplace_back();
  quiet.name = "-q,--quiet";
  quiet.description = "No notes and no progress";
  quiet.take = [](const std::string&) {
    setQuiet(true);
    return std::string();
  };
  root.flag("--version", version, "Print the version");
  root.flag("--help-all", help_all, "Print the help of all commands");
  root.commands = {packCommand(),   infoCommand(),    checkCommand(),      convertCommand(),
                   viewCommand(),   overlapCommand(), mergeCommand(),      sceneCommand(),
                   solidsCommand(), helpCommand(),    completionCommand(), manCommand()};
  root.notes = "innersphere COMMAND --help tells more. Results go to stdout, notes and progress to stderr.";
  root.exit_status = kExitCodeHelp;
  root.examples = {"innersphere pack bunny.obj --spheres 4000 -o bunny.cbor",
                   "innersphere view bunny.cbor --html bunny.html",
                   "innersphere scene run pile --mesh bunny.obj --png pile.png --html pile.html"};
  root.run = [this] { return runRoot(); };
}

int Tool::runRoot() const {
  if (version) {
    std::printf("innersphere %s\n", INNERSPHERE_VERSION);
    return kOk;
  }
  if (help_all) {
    std::fputs(helpOfAll(root, everywhere).c_str(), stdout);
    return kOk;
  }
  std::fputs(helpOf(root, everywhere, {}).c_str(), stderr);
  return kBadUsage;
}

Command Tool::helpCommand() {
  Command command("help", "Explain a command");
  command.arguments("COMMAND", help_words, "One of the commands; the tool itself if none is given")
      .withSuggestions(root.namesOfCommands());
  command.examples = {"innersphere help scene run"};
  command.run = [this] {
    std::fputs(helpOf(root, everywhere, help_words).c_str(), stdout);
    return kOk;
  };
  return command;
}

Command Tool::completionCommand() {
  Command command("completion", "Print a script that completes command lines in a shell");
  command.argument("SHELL", shell, "bash, zsh or fish").oneOf({"bash", "zsh", "fish"});
  command.examples = {"innersphere completion bash > ~/.local/share/bash-completion/completions/innersphere"};
  command.run = [this] {
    const auto write = shell == "bash" ? bashCompletion : shell == "zsh" ? zshCompletion : fishCompletion;
    std::fputs(write(root, everywhere).c_str(), stdout);
    return kOk;
  };
  return command;
}

Command Tool::manCommand() const {
  Command command("man", "Print the manual page");
  command.examples = {"innersphere man | man -l -"};
  command.run = [this] {
    std::fputs(manualPage(root, everywhere, INNERSPHERE_VERSION).c_str(), stdout);
    return kOk;
  };
  return command;
}

// What the library tells a program to ask for is an option here, of one command.
std::string inWordsOfTool(std::string message) {
  const std::pair<const char*, const char*> words[] = {
      {"ask for repair", "give `innersphere pack` --repair"},
      {"ask for a smaller min_radius", "give `innersphere pack` a smaller --min-radius"},
      {"ask for a larger min_radius", "give `innersphere pack` a larger --min-radius"}};
  for (const auto& [of_library, of_tool] : words) {
    const std::size_t at = message.find(of_library);
    if (at != std::string::npos) message.replace(at, std::strlen(of_library), of_tool);
  }
  return message;
}

int fail(int exit_code, const std::string& message) {
  clearProgressBar();
  std::fprintf(stderr, "innersphere: %s\n", message.c_str());
  return exit_code;
}

// What was printed may still wait in a buffer, and the disk behind it may be full.
int finishOutput(int exit_code) {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  const char* reason = errno != 0 ? std::strerror(errno) : "what was printed is lost";
  return fail(kBadOutput, std::string("cannot write to stdout (") + reason + ") [" +
                              toString(ErrorCode::write_failed) + "]");
}

int run(const std::vector<std::string>& words) {
  catchInterrupts();
  // A file over the limit of sizes is then a write that fails, as on a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    const Tool tool;
    return finishOutput(runCommandLine(tool.root, tool.everywhere, words));
  } catch (const UsageError& error) {
    return fail(kBadUsage, error.what());
  } catch (const Error& error) {
    return fail(exitCodeOf(error.code()), inWordsOfTool(error.what()) + " [" + toString(error.code()) + "]");
  } catch (const std::bad_alloc&) {
    return fail(kInternalError, "out of memory");
  } catch (const std::exception& error) {
    return fail(kInternalError,
                std::string("unexpected: ") + error.what() + " (this is a defect, please report it)");
  }
}

}  // namespace
}  // namespace innersphere::tool

int main(int argc, char** argv) {
  return innersphere::tool::run({argv + 1, argv + argc});
}
