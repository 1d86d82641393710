#include "packer/overlap_errors.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "packer/overlap_trials.hpp"
#include "packer/sphere_grid.hpp"

namespace innersphere {
namespace {

constexpr double kVoxels = 1 << 20;

// About as many for each depth as errors are found from.
constexpr std::size_t kTrials = kOverlapErrorPoses * (kOverlapDepths.size() + 1);

// Student's t of 95 %, one-sided, with kOverlapErrorPoses - 1 degrees of freedom.
constexpr double kStudent = 1.686;
static_assert(kOverlapErrorPoses == 39);

/// What two balls share, by the closed form of the lens.
double lens(double r1, double r2, double d) {
  const double s = r1 + r2 - d;
  if (s <= 0) return 0;
  if (d <= std::abs(r1 - r2)) return Ball{Point::Zero(), std::min(r1, r2)}.volume();
  return std::numbers::pi * s * s * (d * d + 2 * d * (r1 + r2) - 3 * (r1 - r2) * (r1 - r2)) / (12 * d);
}

/// The first spheres of a packing, with their own and with volume-true radii.
class Prefix {
 public:
  Prefix(std::span<const Ball> balls, const VolumeTrueRadii& radii, double side)
      : balls_(balls.first(radii.count)) {
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      // Rounding may have made a volume-true radius the smaller one.
      const double radius = std::max<double>(radii.radii[i] / side, balls_[i].radius);
      grid_.insert({balls_[i].centre, radius});
      overshoot_ = std::max(overshoot_, radius - balls_[i].radius);
    }
  }

  struct Sums {
    double raw = 0, volume_true = 0;
  };

  Sums overlap(const Pose& pose, const Voxels& voxels) const {
    Sums sums;
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      const Point x = pose.apply(balls_[i].centre);
      const double large = grid_.balls()[i].radius;
      if ((x.array() < -large - overshoot_).any() || (x.array() > 1 + large + overshoot_).any()) continue;
      if (voxels.outsideBy(x) > large + overshoot_) continue;
      grid_.visitNear(x, x, large, [&](std::uint32_t j) {
        const double d = (x - balls_[j].centre).norm();
        const double other = grid_.balls()[j].radius;
        if (d >= large + other) return;
        sums.volume_true += lens(large, other, d);
        sums.raw += lens(balls_[i].radius, balls_[j].radius, d);
      });
    }
    return sums;
  }

 private:
  std::span<const Ball> balls_;
  SphereGrid grid_;       // with volume-true radii
  double overshoot_ = 0;  // how far these reach out of the solid, at most
};

/// What was found in one pose.
struct Finding {
  double depth;  ///< found with spheres, or true
  double error;  ///< as in ExpectedError, or of a true depth relative to it
};

/// Calls f(number of a depth, the findings nearest to it) for each of kOverlapDepths.
template <typename F>
void forEachDepth(std::vector<Finding> findings, const F& f) {
  std::erase_if(findings, [](const Finding& one) { return !(one.depth > 0); });
  std::sort(findings.begin(), findings.end(),
            [](const Finding& a, const Finding& b) { return a.depth < b.depth; });
  const std::size_t size = std::min(kOverlapErrorPoses, findings.size());
  for (std::size_t k = 0; k < kOverlapDepths.size(); ++k) {
    const double depth = kOverlapDepths[k];
    std::size_t first = 0;  // the window moves up while the next finding is nearer than its first, as a ratio
    while (first + size < findings.size() &&
           findings[first].depth * findings[first + size].depth < depth * depth)
      ++first;
    f(k, std::span(findings).subspan(first, size));
  }
}

OverlapErrors::Estimate estimateFrom(const std::vector<Finding>& findings) {
  OverlapErrors::Estimate estimate;
  forEachDepth(findings, [&](std::size_t depth, std::span<const Finding> near) {
    estimate.mean[depth] = estimate.bound[depth] = 1;
    if (near.size() < kOverlapErrorPoses) return;  // the spheres find next to nothing
    const auto count = static_cast<double>(near.size());
    double sum = 0, squares = 0;
    std::array<double, 2> largest{};  // the second one first
    for (const Finding& one : near) {
      sum += one.error;
      squares += one.error * one.error;
      largest = {std::max(largest[0], std::min(largest[1], one.error)), std::max(largest[1], one.error)};
    }
    const double mean = sum / count;
    const double variance = std::max(0.0, squares - count * mean * mean) / (count - 1);
    const double margin = kStudent * std::sqrt(2 * variance / count);  // the others' scatter, too
    estimate.mean[depth] = std::min(mean + margin, 1.0);
    estimate.bound[depth] = largest[0];
  });
  return estimate;
}

}  // namespace

OverlapErrors findOverlapErrors(const Container& container, const Surface& surface,
                                std::span<const Ball> balls, const std::vector<VolumeTrueRadii>& radii,
                                double volume) {
  const Voxels voxels(container, volume, kVoxels);
  const auto [trials, shallowest] = makeOverlapTrials(container, surface, voxels, volume, kTrials);
  if (trials.size() < kOverlapErrorPoses) return {};
  OverlapErrors errors;
  errors.poses = static_cast<std::uint32_t>(trials.size());
  errors.shallowest = shallowest;
  std::vector<Finding> findings;
  for (const OverlapTrial& trial : trials)
    findings.push_back({trial.truth.fraction, trial.truth.error / trial.truth.fraction});
  forEachDepth(findings, [&](std::size_t depth, std::span<const Finding> near) {
    double squares = 0;
    for (const Finding& one : near) squares += one.error * one.error;
    errors.sampling_error[depth] = std::sqrt(squares / static_cast<double>(near.size()));
  });
  for (const VolumeTrueRadii& prefix : radii) {
    const Prefix spheres(balls, prefix, container.side());
    std::vector<Prefix::Sums> sums(trials.size());
    tbb::parallel_for(std::size_t{0}, trials.size(),
                      [&](std::size_t i) { sums[i] = spheres.overlap(trials[i].pose, voxels); });
    const auto estimate = [&](double Prefix::Sums::*sum) {
      for (std::size_t i = 0; i < trials.size(); ++i) {
        const double found = sums[i].*sum / volume, exact = trials[i].truth.fraction;
        findings[i] = {found, std::abs(found - exact) / std::max(found, exact)};
      }
      return estimateFrom(findings);
    };
    errors.prefixes.push_back(
        {prefix.count, estimate(&Prefix::Sums::raw), estimate(&Prefix::Sums::volume_true)});
  }
  return errors;
}

}  // namespace innersphere
