// Scenes as they are, and in variants that ask more of them, for each backend.
#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "innersphere/query.hpp"
#include "scenes/solver_choice.hpp"

namespace innersphere::test {

struct Variant {
  const char* scene;
  std::size_t spheres = 0;  // 0: the scene's own
  double seconds = 0;       // 0: the scene's own
  double dt = 0;            // 0: the scene's own
  const char* name = "";
  demo::SolverKind solver = demo::SolverKind::bullet;
  /// Motions that roundings decide say little in one run: each run has another seed and, if `spheres` are
  /// given, a tenth of them more than the run before. One of three may miss.
  int runs = 1;

  friend void PrintTo(const Variant& v, std::ostream* out) { *out << v.scene << v.name; }
};

/// Each scene as users get it, long ones shorter, and some with fewer spheres or other steps.
const std::vector<Variant>& variants();

/// As a name for a test.
std::string nameOf(const testing::TestParamInfo<Variant>& info);

/// Plays it, and expects that it shows its truths, of several runs in two of three. What a scene is known to
/// miss must not get worse.
void expectTruths(const Variant& variant, Backend backend);

}  // namespace innersphere::test
