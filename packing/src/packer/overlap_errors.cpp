#include "packer/overlap_errors.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "common/steady_math.hpp"
#include "packer/ball_tree.hpp"
#include "packer/errors_by_depth.hpp"
#include "packer/overlap_trials.hpp"

namespace innersphere {
namespace {

// Enough for 14 depths.
constexpr std::size_t kTrials = 14 * kOverlapErrorPoses;

// Copies nearly upon the solid: errors of these fall to nothing within 5 % of the volume, or rise.
constexpr std::size_t kDeepTrials = 2 * kOverlapErrorPoses;

/// What two balls share, by the closed form of the lens.
double lens(double r1, double r2, double d) {
  const double s = r1 + r2 - d;
  if (s <= 0) return 0;
  if (d <= std::abs(r1 - r2)) return Ball{Point::Zero(), std::min(r1, r2)}.volume();
  return std::numbers::pi * s * s * (d * d + 2 * d * (r1 + r2) - 3 * (r1 - r2) * (r1 - r2)) / (12 * d);
}

/// What two balls share, summed over all pairs, or what a plane cuts off.
struct Found {
  double volume = 0, stiffness = 0;
  Point area = Point::Zero();  // these as of Overlap

  /// Adds two balls whose centres are `way` apart, which is d long.
  void add(double r1, double r2, const Point& way, double d) {
    volume += lens(r1, r2, d);
    if (d <= std::abs(r1 - r2) || d >= r1 + r2) return;
    const double along = (d * d + r1 * r1 - r2 * r2) / (2 * d);
    const double rim = std::numbers::pi * (r1 * r1 - along * along);
    stiffness += rim;
    area += rim / d * way;
  }

  /// Adds what a plane cuts off from a ball whose centre is `depth` below it.
  void addCap(double radius, double depth, const Point& normal) {
    if (depth <= -radius) return;
    const double height = std::min(radius + depth, 2 * radius);
    volume += std::numbers::pi / 3 * height * height * (3 * radius - height);
    const double rim = std::numbers::pi * std::max(0.0, radius * radius - depth * depth);
    stiffness += rim;
    area += rim * normal;
  }
};

/// The first spheres of a packing, with their own and with volume-true radii.
class Prefix {
 public:
  Prefix(std::span<const Ball> balls, const VolumeTrueRadii& radii, double side)
      : balls_(balls), volume_true_(withRadii(balls, radii, side)), tree_(volume_true_) {}

  struct Sums {
    Found raw, volume_true;
  };

  Sums overlap(const Pose& pose) const {
    Sums sums;
    tree_.forMeeting(pose, [&](std::uint32_t i, std::uint32_t j, const Point& way, double d) {
      sums.volume_true.add(volume_true_[i].radius, volume_true_[j].radius, way, d);
      sums.raw.add(balls_[i].radius, balls_[j].radius, way, d);
    });
    return sums;
  }

  /// The volume with volume-true radii.
  double volume(const Pose& pose) const {
    double sum = 0;
    tree_.forMeeting(pose, [&](std::uint32_t i, std::uint32_t j, const Point&, double d) {
      sum += lens(volume_true_[i].radius, volume_true_[j].radius, d);
    });
    return sum;
  }

  /// What a ball shares with volume-true ones.
  double shared(const Ball& ball) const {
    double sum = 0;
    for (const Ball& one : volume_true_)
      sum += lens(one.radius, ball.radius, (one.centre - ball.centre).norm());
    return sum;
  }

  Sums below(const PlaneCut& plane) const {
    Sums sums;
    for (std::size_t i = 0; i < volume_true_.size(); ++i) {
      const double depth = plane.height - plane.normal.dot(balls_[i].centre);
      sums.volume_true.addCap(volume_true_[i].radius, depth, plane.normal);
      sums.raw.addCap(balls_[i].radius, depth, plane.normal);
    }
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
  BallTree tree_;  // of these
};

/// The mean of the largest kOverlapErrorPoses numbers: one pose of a few lenses, spheres inside spheres, says
/// little.
double meanOfLargest(std::vector<double> numbers) {
  const std::size_t count = std::min(numbers.size(), kOverlapErrorPoses);
  std::sort(numbers.begin(), numbers.end(), std::greater<>());
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += numbers[i];
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

double errorOf(double found, double truth) {
  return std::abs(found - truth) / std::max(found, truth);
}

/// What counts of an error that is of one body only, as planes have none: the other may err as much.
double ofOne(double error) {
  return std::min(std::numbers::sqrt2 * error, 1.0);
}

/// What was found in one pose.
Finding findingOf(const Found& found, double truth, double volume) {
  const double depth =
      found.volume > 0 ? overlapDepth(found.volume, {found.area[0], found.area[1], found.area[2]}) : 0;
  return {depth / steady::pow(volume, 1.0 / 3), errorOf(found.volume, truth), found.volume / volume};
}

}  // namespace

OverlapErrors findOverlapErrors(const Container& container, const Surface& surface,
                                const SurfaceSamples& samples, std::span<const Ball> balls,
                                const std::vector<VolumeTrueRadii>& radii, double volume) {
  const OverlapTrials made = makeOverlapTrials(container, surface, samples, volume, kTrials, kDeepTrials);
  const std::vector<OverlapTrial>& trials = made.trials;
  const std::vector<PlaneCut>& planes = made.planes;
  if (trials.size() < kOverlapErrorPoses) return {};
  OverlapErrors errors;
  errors.poses = static_cast<std::uint32_t>(trials.size() + made.deep.size());
  errors.shallowest = made.shallowest;
  double squares = 0;
  for (const OverlapTrial& trial : trials) {
    const double relative = trial.truth.error / trial.truth.fraction;
    squares += relative * relative;
  }
  errors.sampling_error = std::sqrt(squares / static_cast<double>(trials.size()));
  for (const VolumeTrueRadii& prefix : radii) {
    const Prefix spheres(balls, prefix, container.side());
    std::vector<Prefix::Sums> copies(trials.size()), cuts(planes.size());
    std::vector<Finding> deep(made.deep.size()), inside(made.inside.size());
    tbb::parallel_for(std::size_t{0}, trials.size(), [&](std::size_t i) {
      container.goOn();
      copies[i] = spheres.overlap(trials[i].pose);
    });
    // The sum may be more than the solid has. A query tells no more, and errs most where the sum has just
    // come down to that, so it is looked up there.
    const auto deepFinding = [](double found, double truth) {
      return Finding{found, errorOf(found, truth), found};
    };
    tbb::parallel_for(std::size_t{0}, deep.size(), [&](std::size_t i) {
      container.goOn();
      deep[i] = deepFinding(spheres.volume(made.deep[i].pose) / volume, made.deep[i].truth.fraction);
    });
    // Spheres that reach out of thin walls find as much where far less is shared.
    for (std::size_t i = 0; i < trials.size(); ++i) {
      const double found = copies[i].volume_true.volume / volume;
      if (found > kDeepOverlap) deep.push_back(deepFinding(found, trials[i].truth.fraction));
    }
    tbb::parallel_for(std::size_t{0}, planes.size(),
                      [&](std::size_t i) { cuts[i] = spheres.below(planes[i]); });
    tbb::parallel_for(std::size_t{0}, inside.size(), [&](std::size_t i) {
      const double truth = made.inside[i].volume(), found = spheres.shared(made.inside[i]);
      inside[i] = {truth / volume, ofOne(errorOf(found, truth)), truth / volume};
    });
    const auto estimate = [&](Found Prefix::Sums::*sum) {
      OverlapErrors::Estimate result;
      std::vector<Finding> findings;
      std::vector<double> thicknesses;
      for (std::size_t i = 0; i < trials.size(); ++i) {
        const Found& found = copies[i].*sum;
        findings.push_back(findingOf(found, trials[i].truth.fraction * volume, volume));
        if (found.stiffness > 0)
          thicknesses.push_back(found.volume / found.stiffness / steady::pow(volume, 1.0 / 3));
      }
      result.thickest = meanOfLargest(std::move(thicknesses));
      result.copies = errorsByDepth(std::move(findings));
      findings = {};
      for (std::size_t i = 0; i < planes.size(); ++i) {
        Finding one = findingOf(cuts[i].*sum, planes[i].truth * volume, volume);
        one.error = ofOne(one.error);
        findings.push_back(one);
      }
      result.planes = errorsByDepth(std::move(findings));
      return result;
    };
    errors.prefixes.push_back(
        {prefix.count, estimate(&Prefix::Sums::raw), estimate(&Prefix::Sums::volume_true)});
    errors.prefixes.back().volume_true.deep = errorsOfDeep(std::move(deep));
    errors.prefixes.back().volume_true.inside = errorsOfInside(std::move(inside));
  }
  return errors;
}

}  // namespace innersphere
