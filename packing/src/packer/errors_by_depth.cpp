#include "packer/errors_by_depth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "common/steady_math.hpp"

namespace innersphere {
namespace {

// What a normal distribution exceeds in 1 of 20 cases.
constexpr double kNormal = 1.645;

// Runs on either side that tell how errors fall with the volume, too: 19 poses tell little of that.
constexpr std::size_t kNeighbours = 2;

// Errors of parts that know nothing of each other fall as the root of their number: none fall faster. Nor
// may they rise faster where walls lie along walls that the spheres leave out.
constexpr double kMostPower = 0.5;

constexpr auto kPoses = static_cast<double>(kOverlapErrorPoses);

using Run = std::span<const Finding>;

/// Cuts findings into runs of kOverlapErrorPoses by depth, as evenly spread as they are.
std::vector<Run> runsOf(std::vector<Finding>& findings) {
  std::erase_if(findings, [](const Finding& one) { return !(one.depth > 0); });
  std::sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
    return a.depth != b.depth ? a.depth < b.depth : a.error < b.error;
  });
  const std::size_t count = findings.size() / kOverlapErrorPoses;
  std::vector<Run> runs;
  for (std::size_t i = 0; i < count; ++i)
    runs.push_back(Run(findings).subspan(i * findings.size() / count, kOverlapErrorPoses));
  return runs;
}

/// How the errors of a run go with the logarithms of volumes: sums of squares about the means, errors as
/// parts of their mean.
struct Trend {
  double mean = 0;  // of the errors
  double volumes = 0, errors = 0, both = 0;

  explicit Trend(Run run) {
    double middle = 0;
    for (const Finding& one : run) {
      mean += one.error / kPoses;
      middle += logOf(one) / kPoses;
    }
    if (!(mean > 0)) return;
    for (const Finding& one : run) {
      const double volume = logOf(one) - middle, error = one.error / mean - 1;
      volumes += volume * volume;
      errors += error * error;
      both += volume * error;
    }
  }

  static double logOf(const Finding& one) { return std::numbers::ln2 * steady::log2(one.volume); }
};

/// The variance of errors as parts of their mean: they scatter about as much at all depths.
double scatterOf(std::span<const Trend> trends) {
  double squares = 0, runs = 0;
  for (const Trend& one : trends) {
    squares += one.errors;
    runs += one.mean > 0;
  }
  return runs > 0 ? squares / (runs * (kPoses - 1)) : 0;
}

/// How many times a mean the mean of as many others may be. Both scatter; where this one is small, so would
/// be a limit that adds to it, so it is one for the logarithm of their ratio.
double limitOf(double scatter) {
  return steady::exp(kNormal * std::sqrt(2 * scatter / kPoses));
}

/// The power of the volume with which errors fall near a run, less its standard error: volumes may be far
/// larger than these.
double fallingPower(std::span<const Trend> trends, std::size_t run, double scatter) {
  const std::size_t first = run - std::min(run, kNeighbours),
                    last = std::min(run + kNeighbours, trends.size() - 1);
  double volumes = 0, both = 0;
  for (std::size_t i = first; i <= last; ++i) {
    volumes += trends[i].volumes;
    both += trends[i].both;
  }
  if (!(volumes > 0)) return 0;
  return std::clamp(-both / volumes - std::sqrt(scatter / volumes), -kMostPower, kMostPower);
}

}  // namespace

std::vector<OverlapErrors::AtDepth> errorsByDepth(std::vector<Finding> findings) {
  const std::vector<Run> runs = runsOf(findings);
  std::vector<Trend> trends;
  for (const Run& run : runs) trends.emplace_back(run);
  const double scatter = scatterOf(trends);
  const double limit = limitOf(scatter);

  std::vector<OverlapErrors::AtDepth> rows;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    double largest = 0, depths = 0, volumes = 0;  // the sums of logarithms
    for (const Finding& one : runs[i]) {
      largest = std::max(largest, one.error);
      depths += steady::log2(one.depth);
      volumes += steady::log2(one.volume);
    }
    const double depth = steady::pow(2, depths / kPoses);
    // All may be equally deep, as where one sphere is inside another.
    if (rows.empty() || depth > rows.back().depth)
      rows.push_back({depth,
                      {std::min(limit * trends[i].mean, largest), largest},
                      steady::pow(2, volumes / kPoses),
                      fallingPower(trends, i, scatter)});
  }
  return rows;
}

std::vector<OverlapErrors::AtDepth> errorsOfDeep(const std::vector<Finding>& findings) {
  double volumes = 0;  // the sum of logarithms
  for (const Finding& one : findings) {
    if (!(one.volume > 0)) return {};
    volumes += steady::log2(one.volume);
  }
  if (findings.size() != kOverlapErrorPoses) return {};
  const double volume = steady::pow(2, volumes / kPoses);
  const Trend trend(findings);
  const double rise = trend.volumes > 0 ? std::max(trend.both / trend.volumes, 0.0) : 0;
  std::vector<Finding> level = findings;  // all as if they had that volume
  double largest = 0;
  for (Finding& one : level) {
    one.error *= steady::pow(volume / one.volume, rise);
    largest = std::max(largest, one.error);
  }
  const Trend others(level);
  const double mean = limitOf(scatterOf({&others, 1})) * others.mean;
  return {{volume, {std::min(mean, largest), largest}, volume, -rise}};
}

}  // namespace innersphere
