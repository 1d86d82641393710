// innersphere: packs solids, shows and checks packings, measures overlaps and runs scenes.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "commands.hpp"
#include "exit_codes.hpp"
#include "innersphere/error.hpp"
#include "terminal.hpp"

namespace innersphere::tool {
namespace {

int fail(int exit_code, const std::string& message) {
  clearProgressBar();
  std::fprintf(stderr, "innersphere: %s\n", message.c_str());
  return exit_code;
}

int run(int argc, char** argv) {
  CLI::App app("Collision detection for moving non-convex solids, by inner-sphere packings.", "innersphere");
  app.set_version_flag("--version", "innersphere " INNERSPHERE_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  app.get_formatter()->column_width(34);
  app.footer(
      std::string(
          "Examples:\n"
          "  innersphere pack bunny.obj --spheres 4000 -o bunny.cbor\n"
          "  innersphere view bunny.cbor --html bunny.html\n"
          "  innersphere scene run pile --mesh bunny.obj --png pile.png --html pile.html\n\n"
          "innersphere COMMAND --help tells more. Results go to stdout, notes and progress to stderr.\n") +
      exitCodeHelp());
  app.add_flag_function(
         "-q,--quiet", [](std::int64_t) { setQuiet(true); }, "No notes and no progress")
      ->trigger_on_parse();

  Session session;
  addPackCommand(app, session);
  addInfoCommand(app, session);
  addCheckCommand(app, session);
  addConvertCommand(app, session);
  addViewCommand(app, session);
  addOverlapCommand(app, session);
  addSceneCommand(app, session);
  addSolidsCommand(app, session);

  catchInterrupts();
  try {
    app.parse(argc, argv);
    return session.exit_code;
  } catch (const CLI::RequiredError& error) {
    // CLI11 only says that a command is missing, not that the one given is unknown.
    const auto unknown = app.remaining();
    if (unknown.empty()) return app.exit(error), kBadUsage;
    return fail(kBadUsage, "there is no command \"" + unknown.front() + "\"; innersphere --help lists them");
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kOk : kBadUsage;
  } catch (const Error& error) {
    return fail(exitCodeOf(error.code()), std::string(error.what()) + " [" + toString(error.code()) + "]");
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
  return innersphere::tool::run(argc, argv);
}
