// What physics says that a scene has to show.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace innersphere::demo {

struct Recording;

/// A number that is known before the scene runs: from a formula, or where there is none from Bullet's own
/// convex shapes in finer steps; never from a run of packings.
struct Truth {
  enum class Kind {
    equal,   ///< `tolerance` above or below `expected` at most
    at_most  ///< no more than `expected`
  };

  std::string what;
  std::string unit;  ///< SI; empty: a pure number
  Kind kind = Kind::equal;
  double expected = 0;
  double tolerance = 0;  ///< in the same unit; 0 for Kind::at_most
  std::string source;    ///< the formula and where it comes from
  std::function<double(const Recording&)> measure;
  double needs = 0;  ///< shortest recording [s] that shows it
  /// Where the truth is missed today: by how much more than is allowed, in the same unit; 0: it holds. Tests
  /// see to it that it does not get worse.
  double known_miss = 0;
};

enum class Outcome {
  holds,
  missed,
  not_recorded  ///< the scene ran for too short a time
};

struct Verdict {
  Truth truth;
  Outcome outcome = Outcome::not_recorded;
  double measured = 0;
};

std::vector<Verdict> judge(const std::vector<Truth>& truths, const Recording& recording);

/// How far a value is from what is allowed: 0 if it is allowed; infinity if it is not a number.
double missOf(const Truth& truth, double measured);

}  // namespace innersphere::demo
