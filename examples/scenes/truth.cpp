#include "truth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "recording.hpp"

namespace innersphere::demo {

double missOf(const Truth& truth, double measured) {
  if (std::isnan(measured)) return std::numeric_limits<double>::infinity();
  const double off = measured - truth.expected;
  return std::max(0.0, truth.kind == Truth::Kind::equal ? std::abs(off) - truth.tolerance : off);
}

std::vector<Verdict> judge(const std::vector<Truth>& truths, const Recording& recording) {
  std::vector<Verdict> verdicts;
  // The last step may end a hair before a time that it is the nearest to: 1200 steps of 0.00833333 s are not
  // 10 s.
  const double half_a_step =
      recording.seconds() / double(std::max<std::size_t>(2, 2 * recording.steps.size() - 2));
  for (const Truth& truth : truths) {
    Verdict& verdict = verdicts.emplace_back(Verdict{truth});
    if (recording.seconds() < truth.needs - half_a_step) continue;
    verdict.measured = truth.measure(recording);
    verdict.outcome = missOf(truth, verdict.measured) > 0 ? Outcome::missed : Outcome::holds;
  }
  return verdicts;
}

}  // namespace innersphere::demo
