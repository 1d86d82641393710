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
  // A line towards a shape is askew to the direction where its surface turns.
  return {std::copysign(points.on_a.distance(points.on_b), points.depthAlong(direction)), slope};
}

bool isUsable(const OpposedPoints& points, const btVector3& direction) {
  return points.normal_a.dot(direction) > kUsableCosine && points.normal_b.dot(direction) > kUsableCosine;
}

Hill hillAt(const SurfaceProbe& probe, const ProbedSample& sample) {
  const Across axes(sample.direction);
  const SurfaceProbe::Bends bends = probe.bends(sample.points, axes);
  return Hill(bends.a, bends.b, sample.points.depthAlong(sample.direction), axes);
}

bool isUsable(const ProbedSample& sample) {
  return isUsable(sample.points, sample.direction);
}

/// Guesses how much deeper it is at the top by the slope and by how the surfaces bend. That is worth nothing
/// where it is steep.
void guessTop(const SurfaceProbe& probe, ProbedSample& sample) {
  const Hillside here = hillsideAt(sample.points, sample.direction);
  sample.below_top = 0;
  if (fitTogether(sample.points.curvature_a, sample.points.curvature_b) || here.slope.length() > kSteepSlope)
    return;
  sample.below_top = here.slope.dot(hillAt(probe, sample).toTop(here.slope)) / 2;
}

/// How fast the slope falls in each direction across the line, as far as the steps have shown: a quasi-Newton
/// method (Broyden, Fletcher, Goldfarb, Shanno) in two dimensions, for hills are seldom round.
class Falls {
 public:
  /// Starts as if it fell by `fastest` [1/m] everywhere.
  Falls(const btVector3& direction, btScalar fastest) : xx_(fastest), yy_(fastest) {
    btPlaneSpace1(direction, x_, y_);
  }
  /// From a place with this slope to the top.
  btVector3 toTop(const btVector3& slope) const {
    const btScalar x = slope.dot(x_), y = slope.dot(y_), det = xx_ * yy_ - xy_ * xy_;
    return (x_ * (yy_ * x - xy_ * y) + y_ * (xx_ * y - xy_ * x)) / det;
  }
  /// Takes note that the slope fell by so much in a step.
  void learn(const btVector3& step, const btVector3& fell) {
    const btScalar x = step.dot(x_), y = step.dot(y_);
    const btScalar was_x = xx_ * x + xy_ * y, was_y = xy_ * x + yy_ * y, was = x * was_x + y * was_y;
    btScalar fell_x = fell.dot(x_), fell_y = fell.dot(y_), is = x * fell_x + y * fell_y;
    if (is < kSlowestFall * was) {
      // Powell's damping: not all of it is believed at once.
      const btScalar believed = (1 - kSlowestFall) * was / (was - is);
      fell_x = believed * fell_x + (1 - believed) * was_x;
      fell_y = believed * fell_y + (1 - believed) * was_y;
      is = kSlowestFall * was;
    }
    xx_ += fell_x * fell_x / is - was_x * was_x / was;
    xy_ += fell_x * fell_y / is - was_x * was_y / was;
    yy_ += fell_y * fell_y / is - was_y * was_y / was;
  }
  void shorten() {
    xx_ *= kShorter;
    xy_ *= kShorter;
    yy_ *= kShorter;
  }

 private:
  btVector3 x_, y_;
  btScalar xx_, xy_ = 0, yy_;
};

/// Moves a sample uphill along lines beside that from `shift` beside its sphere; not where slopes above
/// `steepest` say that the top is far. Notes whether it got there. Over edges the slope may fall suddenly, so
/// a step which loses the surface there is taken again, shorter.
void climb(const SurfaceProbe& probe, btScalar steepest, int steps, btVector3 shift, ProbedSample& sample) {
  const bool over_edges = probe.hasEdges();
  Hillside here = hillsideAt(sample.points, sample.direction);
  // There is no top where faces are flat, or fit together.
  if (fitTogether(sample.points.curvature_a, sample.points.curvature_b) || here.slope.length() > steepest)
    return;
  const btScalar fall = hillAt(probe, sample).fall(0);
  Falls falls(sample.direction, fall > 0 ? fall : sample.points.curvature_a + sample.points.curvature_b);
  for (int i = 0; i < steps && here.slope.length2() > kLevel * kLevel; ++i) {
    OpposedPoints points;
    points.triangle_a = sample.points.triangle_a;
    points.triangle_b = sample.points.triangle_b;
    const btVector3 step = falls.toTop(here.slope);
    if (!probe.probeLine(sample.index, sample.direction, shift + step, points) ||
        !isUsable(points, sample.direction)) {
      if (!over_edges) return;
      falls.shorten();
      continue;
    }
    const Hillside next = hillsideAt(points, sample.direction);
    const bool climbs = next.depth - here.depth > kClimbs * here.slope.dot(step);
    if ((over_edges && next.slope.length() > steepest) ||
        (!climbs && next.slope.length2() > here.slope.length2())) {
      if (over_edges && next.slope.dot(step) < 0)
        falls.learn(step, here.slope - next.slope);  // the top is between
      else
        falls.shorten();
      continue;
    }
    falls.learn(step, here.slope - next.slope);
    shift += step;
    sample.points = points;
    here = next;
  }
  sample.is_top = here.slope.length2() < kReached * kReached;
}

/// Moves a sample to the top of its hill. Normals agree all along a line over it, for lines of any direction;
/// but both points are opposed only along the normal, so a line that is askew is drawn again along that.
void ascend(const SurfaceProbe& probe, ProbedSample& sample) {
  ProbedSample start = sample;
  btVector3 back = probe.toMiddleOfBend(sample);
  if (!back.isZero() && probe.probeLine(sample.index, sample.direction, back, start.points) &&
      isUsable(start)) {
    sample = start;
  } else {
    back.setZero();
  }
  const int steps = probe.hasEdges() ? kAscentStepsOverEdges : kAscentSteps;
  climb(probe, BT_LARGE_FLOAT, steps, back, sample);
  const OpposedPoints& points = sample.points;
  const btVector3 normal = (points.normal_a + points.normal_b).normalized();
  const btVector3 apart = points.on_a - points.on_b;
  if (!sample.is_top ||
      (apart - normal * apart.dot(normal)).length2() < kReached * kReached * apart.length2())
    return;
  ProbedSample again = sample;
  again.direction = normal;
  const btVector3 middle = (points.on_a + points.on_b) / 2 - probe.lineStart(sample.index);
  const btVector3 shift = middle - normal * middle.dot(normal) + probe.toMiddleOfBend(again);
  if (!probe.probeLine(sample.index, normal, shift, again.points)) return;
  climb(probe, BT_LARGE_FLOAT, steps, shift, again);
  if (again.is_top) sample = again;
}

/// The tops that were reached.
class Tops {
 public:
  bool areAll() const { return count_ == kPatchPoints; }
  bool areNone() const { return count_ == 0; }

  /// Whether a top that is guessed from a place is one of those that were reached.
  bool include(const ProbedSample& sample, btScalar separation) const {
    for (int i = 0; i < count_; ++i) {
      const OpposedPoints& top = tops_[i].points;
      if (isOnHill(sample.points.on_b - top.on_b, sample.points.normal_b - sample.points.normal_a, hills_[i],
                   separation))
        return true;
    }
    return false;
  }

  void ascendFrom(const ProbedSample& start, const SurfaceProbe& probe) {
    ProbedSample& top = tops_[count_];
    top = start;
    top.id = kDeepestId - static_cast<std::uint64_t>(count_++);
    ascend(probe, top);
    hills_[count_ - 1] = hillAt(probe, top);
  }

  /// Only those of convex hills: elsewhere the sample itself is as deep.
  void appendTo(std::vector<ProbedSample>& samples) const {
    std::copy_if(tops_.begin(), tops_.begin() + count_, std::back_inserter(samples),
                 [](const ProbedSample& top) { return top.points.curvature_a + top.points.curvature_b > 0; });
  }

 private:
  std::array<ProbedSample, kPatchPoints> tops_;
  std::array<Hill, kPatchPoints> hills_;
  int count_ = 0;
};

/// The sample with the deepest top that was not reached yet; null if there is none.
ProbedSample* bestStart(const Tops& tops, btScalar separation, std::vector<ProbedSample>& samples) {
  ProbedSample* best = nullptr;
  btScalar most = tops.areNone() ? -BT_LARGE_FLOAT : -separation;
  for (ProbedSample& sample : samples) {
    if (sample.starts_ascent || !isUsable(sample)) continue;
    // The first is sure to be there.
    const btScalar rise = tops.areNone() ? btScalar(0) : sample.below_top;
    const btScalar depth = sample.points.depthAlong(sample.direction) + rise;
    if (depth > most && !tops.include(sample, separation)) {
      most = depth;
      best = &sample;
    }
  }
  return best;
}

}  // namespace

bool isOnHill(const btVector3& from_top, const btVector3& slope, const Hill& hill, btScalar separation) {
  btVector3 way(0, 0, 0);
  for (int i = 0; i < 2; ++i) way -= hill.axis(i) * from_top.dot(hill.axis(i));
  return (way - hill.toTop(slope)).length() < btMax(kSameHill * way.length(), kSameTop * separation);
}

void appendDeepestPoints(const SurfaceProbe& probe, btScalar separation, std::vector<ProbedSample>& samples) {
  for (ProbedSample& sample : samples) {
    if (isUsable(sample)) guessTop(probe, sample);
  }
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
    if (isUsable(samples[i])) climb(probe, kSlopeBeside, kAscentStepsBeside, btVector3(0, 0, 0), samples[i]);
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
