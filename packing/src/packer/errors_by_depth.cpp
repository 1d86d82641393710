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

// Errors of copies that lie nearly upon the solid go up and down with the volume, and scatter less at one:
// few poses tell them, and a run begins at every second one.
constexpr std::size_t kDeepRun = 5, kDeepStep = 2;

// What is next to all of a solid.
constexpr double kJustAll = 1 - 1e-6;

using Run = std::span<const Finding>;

void sortByDepth(std::vector<Finding>& findings) {
  std::erase_if(findings, [](const Finding& one) { return !(one.depth > 0); });
  std::sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
    return a.depth != b.depth ? a.depth < b.depth : a.error < b.error;
  });
}

/// Cuts findings into runs of kOverlapErrorPoses by depth, as evenly spread as they are.
std::vector<Run> runsOf(std::vector<Finding>& findings) {
  sortByDepth(findings);
  const std::size_t count = findings.size() / kOverlapErrorPoses;
  std::vector<Run> runs;
  for (std::size_t i = 0; i < count; ++i)
    runs.push_back(Run(findings).subspan(i * findings.size() / count, kOverlapErrorPoses));
  return runs;
}

/// Runs of kDeepRun that overlap.
std::vector<Run> deepRunsOf(std::vector<Finding>& findings) {
  sortByDepth(findings);
  std::vector<Run> runs;
  if (findings.size() < 2 * kDeepRun) return runs;
  const std::size_t rest = findings.size() - kDeepRun, steps = rest / kDeepStep;
  for (std::size_t i = 0; i <= steps; ++i) runs.push_back(Run(findings).subspan(i * rest / steps, kDeepRun));
  return runs;
}

/// The geometric mean of depths or volumes.
double middleOf(Run run, double Finding::*number) {
  double sum = 0;
  for (const Finding& one : run) sum += steady::log2(one.*number);
  return steady::pow(2, sum / static_cast<double>(run.size()));
}

double largestErrorOf(Run run) {
  double largest = 0;
  for (const Finding& one : run) largest = std::max(largest, one.error);
  return largest;
}

/// How the errors of a run go with the logarithms of volumes: sums of squares about the means, errors as
/// parts of their mean.
struct Trend {
  double poses, mean = 0;  // of the errors
  double volumes = 0, errors = 0, both = 0;

  explicit Trend(Run run) : poses(static_cast<double>(run.size())) {
    double middle = 0;
    for (const Finding& one : run) {
      mean += one.error / poses;
      middle += logOf(one) / poses;
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
  double squares = 0, free = 0;
  for (const Trend& one : trends) {
    squares += one.errors;
    if (one.mean > 0) free += one.poses - 1;
  }
  return free > 0 ? squares / free : 0;
}

/// How many times a mean of this many the mean of kOverlapErrorPoses others may be. Both scatter; where this
/// one is small, so would be a limit that adds to it, so it is one for the logarithm of their ratio.
double limitOf(double scatter, std::size_t poses) {
  return steady::exp(kNormal * std::sqrt(scatter / static_cast<double>(poses) + scatter / kPoses));
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
  const double limit = limitOf(scatter, kOverlapErrorPoses);

  std::vector<OverlapErrors::AtDepth> rows;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const double depth = middleOf(runs[i], &Finding::depth), largest = largestErrorOf(runs[i]);
    // All may be equally deep, as where one sphere is inside another.
    if (rows.empty() || depth > rows.back().depth)
      rows.push_back({depth,
                      {std::min(limit * trends[i].mean, largest), largest},
                      middleOf(runs[i], &Finding::volume),
                      fallingPower(trends, i, scatter)});
  }
  return rows;
}

std::vector<OverlapErrors::AtDepth> errorsOfInside(std::vector<Finding> findings) {
  std::vector<OverlapErrors::AtDepth> rows = errorsByDepth(std::move(findings));
  for (OverlapErrors::AtDepth& at : rows) at.power = kMostPower;  // within a run volumes tell less
  return rows;
}

std::vector<OverlapErrors::AtDepth> errorsOfDeep(std::vector<Finding> findings) {
  const std::vector<Run> runs = deepRunsOf(findings);
  std::vector<Trend> trends;
  double largest = 1;  // as many times the mean of its run
  for (const Run& run : runs) {
    const double mean = trends.emplace_back(run).mean;
    if (mean > 0) largest = std::max(largest, largestErrorOf(run) / mean);
  }
  const double limit = std::min(limitOf(scatterOf(trends), kDeepRun), largest);
  std::vector<OverlapErrors::AtDepth> rows;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const double depth = middleOf(runs[i], &Finding::depth), mean = trends[i].mean;
    if (rows.empty() || depth > rows.back().depth)
      rows.push_back({depth, {std::min(limit * mean, 1.0), std::min(largest * mean, 1.0)}, depth, 0});
  }
  if (rows.empty() || findings.back().depth < 1) return rows;
  // A query finds no more than all. Then the sum has just come down to that, or is more and the error any
  // less.
  const ExpectedError all = expectedError({{}, 0, {}, rows, {}}, 0, 0, 1, 1);
  std::erase_if(rows, [](const OverlapErrors::AtDepth& at) { return at.depth >= kJustAll; });
  rows.push_back({kJustAll, all, 1, 0});
  rows.push_back({1, {all.mean / 2, all.bound}, 1, 0});
  return rows;
}

}  // namespace innersphere
