// Talk with the person at the terminal: all of it on stderr, data alone goes to stdout.
#pragma once

#include <string>

#include "innersphere/progress.hpp"

namespace innersphere::tool {

/// From now on Ctrl-C and SIGTERM ask running work to stop; a second one ends the program.
void catchInterrupts();

/// While this lives, Ctrl-C and SIGTERM end the program at once, with kCancelled: for work that does not ask
/// whether to stop, and has nothing to clean up. The constructor throws Error cancelled if one came before.
class EndsAtOnce {
 public:
  EndsAtOnce();
  ~EndsAtOnce();
  EndsAtOnce(const EndsAtOnce&) = delete;
  EndsAtOnce& operator=(const EndsAtOnce&) = delete;
};

/// Keeps notes and progress off stderr.
void setQuiet(bool quiet);
bool isQuiet();

/// A line on stderr, unless quiet.
void say(const std::string& line);

/// Shows a bar on stderr while the work runs, if that is a terminal, and cancels the work after Ctrl-C.
Progress progressBar();

/// Removes the bar, before other output. Does nothing if there is none.
void clearProgressBar();

}  // namespace innersphere::tool
