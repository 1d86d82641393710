#include "packer/overlap_errors.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/steady_math.hpp"
#include "packer/sphere_grid.hpp"
#include "packer/voxels.hpp"

namespace innersphere {
namespace {

constexpr double kVoxels = 1 << 20;
constexpr std::size_t kBins = kOverlapBins.size() - 1;
constexpr std::size_t kPosesPerBin = 8;

// Poses are searched for with fewer samples.
constexpr std::size_t kStride = 16;

// Overlaps, as fractions of the solid, that are looked for.
constexpr double kLeastOverlap = 0.002;
constexpr double kMostOverlap = 0.45;

struct Trial {
  Pose pose;
  Voxels::Shared truth;
};

/// Number i of a sequence that fills [0, 1)^3 evenly (Roberts' R3: powers of 1/p, where p^4 = p + 1).
Point evenly(std::size_t i) {
  constexpr double kStep[] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  Point u;
  for (int k = 0; k < 3; ++k) u[k] = std::fmod(0.5 + static_cast<double>(i + 1) * kStep[k], 1.0);
  return u;
}

Eigen::Quaterniond rotation(const Point& u) {
  // Uniform in the space of rotations (Shoemake 1992).
  const double a = 2 * std::numbers::pi * u[1], b = 2 * std::numbers::pi * u[2];
  const double s = std::sqrt(1 - u[0]), c = std::sqrt(u[0]);
  return {c * steady::cos(b), s * steady::sin(a), s * steady::cos(a), c * steady::sin(b)};
}

Point direction(const Point& u) {
  const double z = 2 * u[0] - 1, a = 2 * std::numbers::pi * u[1], s = std::sqrt(1 - z * z);
  return {s * steady::cos(a), s * steady::sin(a), z};
}

/// Turns the copy about `centre` and moves it away until the solids share the fraction `target`.
Trial findTrial(const Voxels& voxels, const Point& centre, std::size_t number, double target) {
  Eigen::Quaterniond turn = rotation(evenly(2 * number));
  if (turn.w() < 0) turn.coeffs() *= -1;
  const Point way = direction(evenly(2 * number + 1));
  const auto at = [&](double distance) {
    const Eigen::Matrix3d r = turn.toRotationMatrix();
    return Pose{r, centre - r * centre + distance * way};
  };
  // A thin solid and its turned copy may share less than that wherever the copy is: turn it half as far.
  while (turn.vec().norm() > 5e-4 && voxels.shared(at(0), kStride).fraction < 1.2 * target) {
    turn.w() += 1;
    turn.normalize();
  }
  double near = 0, far = std::numbers::sqrt3;
  for (int step = 0; step < 12; ++step) {
    const double middle = (near + far) / 2;
    (voxels.shared(at(middle), kStride).fraction > target ? near : far) = middle;
  }
  const Pose pose = at((near + far) / 2);
  return {pose, voxels.shared(pose)};
}

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

std::size_t binOf(double fraction) {
  std::size_t bin = 0;
  while (bin + 1 < kBins && fraction >= kOverlapBins[bin + 1]) ++bin;
  return bin;
}

}  // namespace

OverlapErrors findOverlapErrors(const Container& container, std::span<const Ball> balls,
                                const std::vector<VolumeTrueRadii>& radii, double volume,
                                const Point& centre_of_mass) {
  const Voxels voxels(container, volume, kVoxels);
  std::vector<Trial> trials(kBins * kPosesPerBin);
  tbb::parallel_for(std::size_t{0}, trials.size(), [&](std::size_t i) {
    const std::size_t bin = i / kPosesPerBin;
    const double low = std::max(kOverlapBins[bin], kLeastOverlap),
                 high = std::min(kOverlapBins[bin + 1], kMostOverlap);
    const double part = (static_cast<double>(i % kPosesPerBin) + 0.5) / kPosesPerBin;
    trials[i] = findTrial(voxels, centre_of_mass, i, low * steady::pow(high / low, part));
  });

  OverlapErrors errors;
  std::array<double, kBins> squared{};
  for (const Trial& trial : trials) {
    if (trial.truth.fraction <= 0) continue;
    const std::size_t bin = binOf(trial.truth.fraction);
    ++errors.poses[bin];
    squared[bin] += std::pow(trial.truth.error / trial.truth.fraction, 2);
  }
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    if (errors.poses[bin] > 0) errors.sampling_error[bin] = std::sqrt(squared[bin] / errors.poses[bin]);
  }
  for (const VolumeTrueRadii& prefix : radii) {
    const Prefix spheres(balls, prefix, container.side());
    std::vector<Prefix::Sums> sums(trials.size());
    tbb::parallel_for(std::size_t{0}, trials.size(),
                      [&](std::size_t i) { sums[i] = spheres.overlap(trials[i].pose, voxels); });
    OverlapErrors::Prefix& row = errors.prefixes.emplace_back();
    row.count = prefix.count;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      if (trials[i].truth.fraction <= 0) continue;
      const std::size_t bin = binOf(trials[i].truth.fraction);
      const double exact = trials[i].truth.fraction * volume;
      row.raw[bin] += std::abs(sums[i].raw / exact - 1) / errors.poses[bin];
      row.volume_true[bin] += std::abs(sums[i].volume_true / exact - 1) / errors.poses[bin];
    }
  }
  return errors;
}

}  // namespace innersphere
