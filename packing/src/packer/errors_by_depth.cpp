#include "packer/errors_by_depth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "common/steady_math.hpp"

namespace innersphere {
namespace {

// Student's t of 95 %, one-sided, with kOverlapErrorPoses - 1 degrees of freedom.
constexpr double kStudent = 1.734;
static_assert(kOverlapErrorPoses == 19);

constexpr std::size_t kKinds = 3;  // of OverlapKind

// Runs on either side that tell how errors fall with the volume, too: 19 poses tell little of that.
constexpr std::size_t kNeighbours = 2;

// Errors of parts that know nothing of each other fall as the root of their number: none fall faster.
constexpr double kMostPower = 0.5;

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

/// The mean error of a run and what makes it uncertain: an analysis of variance with kinds as random effects.
/// Walls that lie along walls err alike, and otherwise than walls that cross, at the same depth.
struct Variances {
  double mean = 0, within = 0;
  double between = 0;  // unbiased, so it may be less than zero
  double same = 0;     // the probability that two poses are of one kind

  explicit Variances(Run run) {
    const auto count = static_cast<double>(run.size());
    struct Group {
      double count = 0, sum = 0;
    };
    std::array<Group, kKinds> groups;
    double squares = 0;
    for (const Finding& one : run) {
      Group& group = groups[static_cast<std::size_t>(one.kind)];
      ++group.count;
      group.sum += one.error;
      squares += one.error * one.error;
      mean += one.error / count;
    }
    double kinds = 0, explained = 0;
    for (const Group& group : groups) {
      if (group.count == 0) continue;
      ++kinds;
      explained += group.sum * group.sum / group.count;
      same += group.count / count * (group.count / count);
    }
    within = std::max(0.0, squares - explained) / (count - kinds);
    if (kinds > 1) between = (explained - count * mean * mean - (kinds - 1) * within) / (count * (1 - same));
  }
};

/// How the errors of a run go with the logarithms of volumes: sums of squares about the means, errors as
/// parts of their mean.
struct Trend {
  double volumes = 0, errors = 0, both = 0;

  Trend() = default;
  Trend(Run run, double mean_error) {
    const auto count = static_cast<double>(run.size());
    double mean = 0;
    for (const Finding& one : run) mean += logOf(one) / count;
    for (const Finding& one : run) {
      const double volume = logOf(one) - mean, error = one.error / mean_error - 1;
      volumes += volume * volume;
      errors += error * error;
      both += volume * error;
    }
  }

  static double logOf(const Finding& one) { return std::numbers::ln2 * steady::log2(one.volume); }
};

/// The power of the volume with which errors fall near a run, a lower limit of 95 %.
double fallingPower(std::span<const Trend> trends, std::size_t run) {
  const std::size_t first = run - std::min(run, kNeighbours),
                    last = std::min(run + kNeighbours, trends.size() - 1);
  Trend sum;
  for (std::size_t i = first; i <= last; ++i) {
    sum.volumes += trends[i].volumes;
    sum.errors += trends[i].errors;
    sum.both += trends[i].both;
  }
  if (!(sum.volumes > 0)) return 0;
  const auto freedom = static_cast<double>((last - first + 1) * (kOverlapErrorPoses - 1) - 1);
  const double power = -sum.both / sum.volumes;
  const double variance = std::max(0.0, sum.errors / sum.volumes - power * power) / freedom;
  return std::clamp(power - kStudent * std::sqrt(variance), 0.0, kMostPower);
}

}  // namespace

std::vector<OverlapErrors::AtDepth> errorsByDepth(std::vector<Finding> findings) {
  const std::vector<Run> runs = runsOf(findings);
  std::vector<Variances> variances;
  std::vector<Trend> trends;
  // Three kinds tell little of how kinds differ, but they do so in all runs.
  double between = 0;
  for (const Run& run : runs) {
    const Variances& one = variances.emplace_back(run);
    if (one.mean > 0) between += one.between / (one.mean * one.mean) / static_cast<double>(runs.size());
    trends.push_back(one.mean > 0 ? Trend(run, one.mean) : Trend());
  }
  between = std::max(0.0, between);

  std::vector<OverlapErrors::AtDepth> rows;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    double largest = 0, depths = 0, volumes = 0;  // the sums of logarithms
    for (const Finding& one : runs[i]) {
      largest = std::max(largest, one.error);
      depths += steady::log2(one.depth);
      volumes += steady::log2(one.volume);
    }
    const auto count = static_cast<double>(runs[i].size());
    const Variances& of = variances[i];
    // The scatter of as many others counts, too, and that they are of one kind.
    const double variance = 2 * of.within / count + between * of.mean * of.mean * (1 + of.same);
    const double depth = steady::pow(2, depths / count);
    // All may be equally deep, as where one sphere is inside another.
    if (rows.empty() || depth > rows.back().depth)
      rows.push_back({depth,
                      {std::min(of.mean + kStudent * std::sqrt(variance), 1.0), largest},
                      steady::pow(2, volumes / count),
                      fallingPower(trends, i)});
  }
  return rows;
}

}  // namespace innersphere
