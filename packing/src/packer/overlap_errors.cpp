#include "packer/overlap_errors.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/steady_math.hpp"
#include "packer/ball_trees.hpp"
#include "packer/overlap_trials.hpp"

namespace innersphere {
namespace {

constexpr double kVoxels = 1 << 20;

// Enough for 15 depths.
constexpr std::size_t kTrials = 15 * kOverlapErrorPoses;

// Student's t of 95 %, one-sided, with kOverlapErrorPoses - 1 degrees of freedom.
constexpr double kStudent = 1.734;
static_assert(kOverlapErrorPoses == 19);

/// What two balls share, by the closed form of the lens.
double lens(double r1, double r2, double d) {
  const double s = r1 + r2 - d;
  if (s <= 0) return 0;
  if (d <= std::abs(r1 - r2)) return Ball{Point::Zero(), std::min(r1, r2)}.volume();
  return std::numbers::pi * s * s * (d * d + 2 * d * (r1 + r2) - 3 * (r1 - r2) * (r1 - r2)) / (12 * d);
}

/// What two balls share, summed over all pairs.
struct Found {
  double volume = 0;
  Point area = Point::Zero();  // as of Overlap

  /// Adds two balls whose centres are `way` apart, which is d long.
  void add(double r1, double r2, const Point& way, double d) {
    volume += lens(r1, r2, d);
    if (d <= std::abs(r1 - r2) || d >= r1 + r2) return;
    const double along = (d * d + r1 * r1 - r2 * r2) / (2 * d);
    area += std::numbers::pi * (r1 * r1 - along * along) / d * way;
  }
};

/// The first spheres of a packing, with their own and with volume-true radii.
class Prefix {
 public:
  Prefix(std::span<const Ball> balls, const VolumeTrueRadii& radii, double side)
      : balls_(balls), volume_true_(withRadii(balls, radii, side)), trees_(volume_true_) {}

  struct Sums {
    Found raw, volume_true;
  };

  Sums overlap(const Pose& pose) const {
    Sums sums;
    trees_.forMeeting(pose, [&](std::uint32_t i, std::uint32_t j, const Point& way, double d) {
      sums.volume_true.add(volume_true_[i].radius, volume_true_[j].radius, way, d);
      sums.raw.add(balls_[i].radius, balls_[j].radius, way, d);
    });
    return sums;
  }

 private:
  static std::vector<Ball> withRadii(std::span<const Ball> balls, const VolumeTrueRadii& radii, double side) {
    std::vector<Ball> larger;
    for (std::size_t i = 0; i < radii.radii.size(); ++i) {
      // Rounding may have made a volume-true radius the smaller one.
      larger.push_back({balls[i].centre, std::max<double>(radii.radii[i] / side, balls[i].radius)});
    }
    return larger;
  }

  std::span<const Ball> balls_;
  std::vector<Ball> volume_true_;
  BallTrees trees_;  // of these
};

/// What was found in one pose.
OverlapErrors::AtDepth findingOf(const Found& found, double truth, double volume) {
  const double error = std::abs(found.volume - truth) / std::max(found.volume, truth);
  const double depth =
      found.volume > 0 ? overlapDepth(found.volume, {found.area[0], found.area[1], found.area[2]}) : 0;
  return {depth / steady::pow(volume, 1.0 / 3), {error, error}};
}

/// Summarises findings that are next to each other in depth.
OverlapErrors::AtDepth summaryOf(std::span<const OverlapErrors::AtDepth> findings) {
  const auto count = static_cast<double>(findings.size());
  double sum = 0, squares = 0, largest = 0, logarithms = 0;
  for (const OverlapErrors::AtDepth& one : findings) {
    const double error = one.error.mean;
    sum += error;
    squares += error * error;
    largest = std::max(largest, error);
    logarithms += steady::log2(one.depth);
  }
  const double mean = sum / count;
  const double variance = std::max(0.0, squares - count * mean * mean) / (count - 1);
  const double margin = kStudent * std::sqrt(2 * variance / count);  // the others' scatter, too
  return {steady::pow(2, logarithms / count), {std::min(mean + margin, 1.0), largest}};
}

/// Cuts findings into runs of kOverlapErrorPoses by depth, as evenly spread as they are.
OverlapErrors::Estimate estimateFrom(std::vector<OverlapErrors::AtDepth> findings) {
  std::erase_if(findings, [](const OverlapErrors::AtDepth& one) { return !(one.depth > 0); });
  std::sort(findings.begin(), findings.end(),
            [](const OverlapErrors::AtDepth& a, const OverlapErrors::AtDepth& b) {
              return a.depth != b.depth ? a.depth < b.depth : a.error.mean < b.error.mean;
            });
  const std::size_t runs = findings.size() / kOverlapErrorPoses;
  OverlapErrors::Estimate estimate;
  for (std::size_t i = 0; i < runs; ++i) {
    const auto run = std::span(findings).subspan(i * findings.size() / runs, kOverlapErrorPoses);
    const OverlapErrors::AtDepth summary = summaryOf(run);
    // All may be equally deep, as where one sphere is inside another.
    if (estimate.empty() || summary.depth > estimate.back().depth) estimate.push_back(summary);
  }
  return estimate;
}

}  // namespace

OverlapErrors findOverlapErrors(const Container& container, const Surface& surface,
                                const SurfaceSamples& samples, std::span<const Ball> balls,
                                const std::vector<VolumeTrueRadii>& radii, double volume) {
  const Voxels voxels(container, volume, kVoxels);
  const auto [trials, shallowest] = makeOverlapTrials(container, surface, samples, voxels, volume, kTrials);
  if (trials.size() < kOverlapErrorPoses) return {};
  OverlapErrors errors;
  errors.poses = static_cast<std::uint32_t>(trials.size());
  errors.shallowest = shallowest;
  double squares = 0;
  for (const OverlapTrial& trial : trials) {
    const double relative = trial.truth.error / trial.truth.fraction;
    squares += relative * relative;
  }
  errors.sampling_error = std::sqrt(squares / static_cast<double>(trials.size()));
  for (const VolumeTrueRadii& prefix : radii) {
    const Prefix spheres(balls, prefix, container.side());
    std::vector<Prefix::Sums> sums(trials.size());
    tbb::parallel_for(std::size_t{0}, trials.size(),
                      [&](std::size_t i) { sums[i] = spheres.overlap(trials[i].pose); });
    const auto estimate = [&](Found Prefix::Sums::*sum) {
      std::vector<OverlapErrors::AtDepth> findings;
      for (std::size_t i = 0; i < trials.size(); ++i)
        findings.push_back(findingOf(sums[i].*sum, trials[i].truth.fraction * volume, volume));
      return estimateFrom(std::move(findings));
    };
    errors.prefixes.push_back(
        {prefix.count, estimate(&Prefix::Sums::raw), estimate(&Prefix::Sums::volume_true)});
  }
  return errors;
}

}  // namespace innersphere
