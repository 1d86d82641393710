#include "narrow_phase/deepest_points.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "common/contact_tolerances.hpp"
#include "narrow_phase/contact_point.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// The depth as a function of the place across the direction, at one place.
struct Hillside {
  btScalar depth;   ///< along the direction [m]
  btVector3 slope;  ///< of the depth, across the direction
};

Hillside hillsideAt(const OpposedPoints& points, const btVector3& direction) {
  const btScalar a = points.normal_a.dot(direction), b = points.normal_b.dot(direction);
  const btVector3 slope = points.normal_b / b - points.normal_a / a;
  return {points.depthAlong(direction), slope};
}

bool isUsable(const OpposedPoints& points, const btVector3& direction) {
  return points.normal_a.dot(direction) > kUsableCosine && points.normal_b.dot(direction) > kUsableCosine;
}

bool isUsable(const ProbedSample& sample) {
  return isUsable(sample.points, sample.direction);
}

/// Where the depth is greatest around a sample, going by its slope and curvature: a guess, worth nothing
/// where it is steep.
struct Top {
  btScalar depth;
  btVector3 shift;  ///< from the sample
};

Top guessedTop(const ProbedSample& sample) {
  const Hillside here = hillsideAt(sample.points, sample.direction);
  if (fitTogether(sample.points.curvature_a, sample.points.curvature_b) || here.slope.length() > kSteepSlope)
    return {here.depth, btVector3(0, 0, 0)};
  const btVector3 shift = here.slope / (sample.points.curvature_a + sample.points.curvature_b);
  return {here.depth + here.slope.dot(shift) / 2, shift};
}

/// Moves a sample uphill; not where slopes above `steepest` say that the top is far.
void ascend(const SurfaceProbe& probe, btScalar steepest, int steps, ProbedSample& sample) {
  Hillside here = hillsideAt(sample.points, sample.direction);
  // How fast the slope falls with distance. There is no top where faces are flat, or fit together.
  const btScalar fastest = sample.points.curvature_a + sample.points.curvature_b;
  btScalar fall = fastest;
  if (fitTogether(sample.points.curvature_a, sample.points.curvature_b) || here.slope.length() > steepest)
    return;
  btVector3 shift(0, 0, 0);
  for (int i = 0; i < steps; ++i) {
    OpposedPoints points;
    points.triangle_a = sample.points.triangle_a;
    points.triangle_b = sample.points.triangle_b;
    const btVector3 step = here.slope / fall;
    if (!probe.probeLine(sample.index, sample.direction, shift + step, points) ||
        !isUsable(points, sample.direction))
      return;
    const Hillside next = hillsideAt(points, sample.direction);
    if (next.depth <= here.depth) {
      if (fall >= fastest) return;
      fall = fastest;  // the step was too long
      continue;
    }
    // From here on as fast as it fell along the step: surfaces may be less curved that way.
    const btScalar fell = (here.slope - next.slope).dot(step) / step.length2();
    if (fell > kSlowestFall * fall) fall = fell;
    shift += step;
    sample.points = points;
    here = next;
  }
}

/// The tops that were reached.
class Tops {
 public:
  bool areAll() const { return count_ == kPatchPoints; }
  bool areNone() const { return count_ == 0; }

  /// Whether a top that is guessed from a place is one of those that were reached.
  bool include(const Top& top, const btVector3& from, btScalar separation) const {
    return std::any_of(tops_.begin(), tops_.begin() + count_, [&](const ProbedSample& reached) {
      const btVector3 way = reached.points.on_b - from;
      return (way - top.shift).length() < btMax(kSameHill * way.length(), kSameTop * separation);
    });
  }

  void ascendFrom(const ProbedSample& start, const SurfaceProbe& probe) {
    ProbedSample& top = tops_[count_];
    top = start;
    top.id = kDeepestId - static_cast<std::uint64_t>(count_++);
    ascend(probe, BT_LARGE_FLOAT, kAscentSteps, top);
  }

  /// Only those of convex hills: elsewhere the sample itself is as deep.
  void appendTo(std::vector<ProbedSample>& samples) const {
    std::copy_if(tops_.begin(), tops_.begin() + count_, std::back_inserter(samples),
                 [](const ProbedSample& top) { return top.points.curvature_a + top.points.curvature_b > 0; });
  }

 private:
  std::array<ProbedSample, kPatchPoints> tops_;
  int count_ = 0;
};

/// The sample with the deepest top that was not reached yet; null if there is none.
ProbedSample* bestStart(const Tops& tops, btScalar separation, std::vector<ProbedSample>& samples) {
  ProbedSample* best = nullptr;
  btScalar most = tops.areNone() ? -BT_LARGE_FLOAT : -separation;
  for (ProbedSample& sample : samples) {
    if (sample.starts_ascent || !isUsable(sample)) continue;
    const Top top = guessedTop(sample);
    // The first is sure to be there.
    const btScalar depth = tops.areNone() ? sample.points.depthAlong(sample.direction) : top.depth;
    if (depth > most && !tops.include(top, sample.points.on_b, separation)) {
      most = depth;
      best = &sample;
    }
  }
  return best;
}

}  // namespace

bool fitTogether(btScalar curvature_a, btScalar curvature_b) {
  return !(curvature_a + curvature_b > kConforming * (btFabs(curvature_a) + btFabs(curvature_b)));
}

void appendDeepestPoints(const SurfaceProbe& probe, btScalar separation, std::vector<ProbedSample>& samples) {
  Tops tops;
  while (!tops.areAll()) {
    ProbedSample* start = bestStart(tops, separation, samples);
    if (start == nullptr) break;
    start->starts_ascent = true;
    tops.ascendFrom(*start, probe);
  }
  tops.appendTo(samples);
}

void ascendBeside(const SurfaceProbe& probe, std::size_t count, std::vector<ProbedSample>& samples) {
  for (std::size_t i = 0; i < count; ++i) {
    if (isUsable(samples[i])) ascend(probe, kSlopeBeside, kAscentStepsBeside, samples[i]);
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
