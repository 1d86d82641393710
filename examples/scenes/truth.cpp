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
  for (const Truth& truth : truths) {
    Verdict& verdict = verdicts.emplace_back(Verdict{truth});
    if (recording.seconds() < truth.needs - 1e-9) continue;
    verdict.measured = truth.measure(recording);
    verdict.outcome = missOf(truth, verdict.measured) > 0 ? Outcome::missed : Outcome::holds;
  }
  return verdicts;
}

}  // namespace innersphere::demo
