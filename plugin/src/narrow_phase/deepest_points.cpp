#include "narrow_phase/deepest_points.hpp"

#include <algorithm>
#include <array>

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
  sample.below_top = 0;
  if (fitTogether(sample.points.curvature_a, sample.points.curvature_b)) return;
  const Hillside here = hillsideAt(sample.points, sample.direction);
  if (here.slope.length() > kSteepSlope) return;
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

btVector3 middleOf(const OpposedPoints& points) {
  return (points.on_a + points.on_b) / 2;
}

/// From a sphere to the line through `place`.
btVector3 shiftTo(const btVector3& place, const btVector3& direction, const SurfaceProbe& probe,
                  std::size_t index) {
  const btVector3 way = place - probe.lineStart(index);
  return way - direction * way.dot(direction);
}

/// Lets the line of a sample start from the sphere that is nearest to where it goes, and returns the shift
/// from there; nothing if that sphere does not see the same place, but another wall.
std::optional<btVector3> startNearer(const LineStarts& lines, const btVector3& step, ProbedSample& sample) {
  const btVector3 direction = lines.probe.lineDirection(sample), place = middleOf(sample.points);
  const std::optional<std::size_t> nearest = lines.nearest(place + step, direction);
  if (!nearest || *nearest == sample.index) return std::nullopt;
  const btVector3 shift = shiftTo(place, direction, lines.probe, *nearest);
  OpposedPoints points;
  points.triangle_a = sample.points.triangle_a;
  points.triangle_b = sample.points.triangle_b;
  const btScalar same = kReached * lines.probe.reach(*nearest);
  if (!lines.probe.probeLine(*nearest, sample.direction, shift, points) ||
      points.on_a.distance2(sample.points.on_a) > same * same ||
      points.on_b.distance2(sample.points.on_b) > same * same)
    return std::nullopt;
  sample.index = *nearest;
  return shift;
}

/// Moves a sample uphill along lines beside that from `shift` beside its sphere; not where slopes above
/// `steepest` say that the top is far. Notes whether it got there. What is out of reach of its sphere is
/// probed from another one. Over edges the slope may fall suddenly, so a step which loses the surface there
/// is taken again, shorter. What has all but reached a top goes on to it beyond `steps`: as deep as that but
/// for rounding, it would be taken for the top, with a normal that leans.
void climb(const LineStarts& lines, btScalar steepest, int steps, btVector3 shift, ProbedSample& sample) {
  const SurfaceProbe& probe = lines.probe;
  const bool over_edges = probe.hasEdges();
  Hillside here = hillsideAt(sample.points, sample.direction);
  // There is no top where faces are flat, or fit together.
  if (fitTogether(sample.points.curvature_a, sample.points.curvature_b) || here.slope.length() > steepest)
    return;
  const Hill hill = hillAt(probe, sample);
  const btScalar fall = hill.fall(0);
  // Along a straight ridge there is no top: what slope there is, is rounding, and would lead off its end.
  const bool on_ridge = !over_edges && hill.isStraightRidge();
  const auto uphill = [&](const btVector3& slope) {
    return on_ridge ? hill.axis(0) * slope.dot(hill.axis(0)) : slope;
  };
  here.slope = uphill(here.slope);
  Falls falls(sample.direction, fall > 0 ? fall : sample.points.curvature_a + sample.points.curvature_b);
  const auto goesOn = [&](int i) {
    const btScalar slope = here.slope.length();
    return slope > kLevel && (i < steps || (i < kAscentSteps && slope < kReached));
  };
  for (int i = 0; goesOn(i); ++i) {
    OpposedPoints points;
    points.triangle_a = sample.points.triangle_a;
    points.triangle_b = sample.points.triangle_b;
    const btVector3 step = falls.toTop(here.slope);
    if (!probe.probeLine(sample.index, sample.direction, shift + step, points) ||
        !isUsable(points, sample.direction)) {
      if (const auto from_there = startNearer(lines, step, sample)) {
        shift = *from_there;
        continue;
      }
      if (!over_edges) return;
      falls.shorten();
      continue;
    }
    Hillside next = hillsideAt(points, sample.direction);
    next.slope = uphill(next.slope);
    const btScalar gain = next.depth - here.depth, promised = here.slope.dot(step);
    if (gain > kLeaps * promised + kFacets * step.length()) {
      falls.shorten();
      continue;
    }
    const bool climbs = gain > kClimbs * promised, sinks = gain < -kSinks * promised;
    if ((over_edges && next.slope.length() > steepest) ||
        (!climbs && (next.slope.length2() > here.slope.length2() || (over_edges && sinks)))) {
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

/// Moves a sample to the top of its hill, beginning `shift` beside its sphere. Normals agree all along a line
/// over it, for lines of any direction; but both points are opposed only along the normal, so a line that is
/// askew is drawn again along that.
void climbToTop(const LineStarts& lines, const btVector3& shift, ProbedSample& sample) {
  const SurfaceProbe& probe = lines.probe;
  const int steps = probe.hasEdges() ? kAscentStepsOverEdges : kAscentSteps;
  climb(lines, BT_LARGE_FLOAT, steps, shift, sample);
  const OpposedPoints& points = sample.points;
  const btVector3 normal = (points.normal_a + points.normal_b).normalized();
  const btVector3 apart = points.on_a - points.on_b;
  if (!sample.is_top ||
      (apart - normal * apart.dot(normal)).length2() < kReached * kReached * apart.length2())
    return;
  const btVector3 place = middleOf(points);
  ProbedSample again = sample;
  again.direction = normal;
  btVector3 start;
  const auto startFrom = [&](std::size_t index) {
    again.index = index;
    again.points = points;
    start = shiftTo(place, normal, probe, index) + probe.toMiddleOfBend(again);
    return probe.probeLine(index, normal, start, again.points);
  };
  if (!startFrom(sample.index)) {
    // From another sphere, if that does not see another wall.
    const std::optional<std::size_t> nearest = lines.nearest(place, probe.lineDirection(again));
    if (!nearest || !startFrom(*nearest) || middleOf(again.points).distance2(place) > apart.length2()) return;
  }
  climb(lines, BT_LARGE_FLOAT, steps, start, again);
  if (again.is_top) sample = again;
}

void ascend(const LineStarts& lines, ProbedSample& sample) {
  ProbedSample start = sample;
  btVector3 back = lines.probe.toMiddleOfBend(sample);
  if (!back.isZero() && lines.probe.probeLine(sample.index, sample.direction, back, start.points) &&
      isUsable(start)) {
    sample = start;
  } else {
    back.setZero();
  }
  climbToTop(lines, back, sample);
}

/// Whether a top that is guessed from a place is this one.
bool leadsTo(const Top& top, const ProbedSample& sample, btScalar separation) {
  return isOnHill(sample.points.on_b - top.sample.points.on_b,
                  sample.points.normal_b - sample.points.normal_a, top.hill, separation);
}

Top topOf(const ProbedSample& sample, const SurfaceProbe& probe) {
  return {sample, hillAt(probe, sample)};
}

/// The tops of a patch, with those that were reached before.
class Tops {
 public:
  Tops(const std::vector<Top>& known, std::size_t of_patch) : known_(known) {
    for (std::size_t i = 0; i < of_patch && !areAll(); ++i) add(known[i]);
  }
  bool areAll() const { return count_ == kPatchPoints; }
  bool areNone() const { return count_ == 0 && known_.empty(); }

  /// Whether a top that is guessed from a place is one of those that were reached.
  bool include(const ProbedSample& sample, btScalar separation) const {
    const auto isOf = [&](const Top& top) { return leadsTo(top, sample, separation); };
    return std::any_of(known_.begin(), known_.end(), isOf) ||
           std::any_of(tops_.begin(), tops_.begin() + count_, isOf);
  }

  void ascendFrom(const ProbedSample& start, const LineStarts& lines) {
    ProbedSample top = start;
    ascend(lines, top);
    add(topOf(top, lines.probe));
  }

  /// Only those of convex hills: elsewhere the sample itself is as deep.
  void appendTo(std::vector<ProbedSample>& samples) const {
    for (int i = 0; i < count_; ++i) {
      const ProbedSample& top = tops_[i].sample;
      if (top.points.curvature_a + top.points.curvature_b > 0) samples.push_back(top);
    }
  }

 private:
  void add(const Top& top) {
    tops_[count_] = top;
    tops_[count_].sample.id = kDeepestId - static_cast<std::uint64_t>(count_);
    ++count_;
  }

  const std::vector<Top>& known_;
  std::array<Top, kPatchPoints> tops_;
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

std::optional<std::size_t> LineStarts::nearest(const btVector3& place, const btVector3& direction) const {
  if (room_.empty()) {
    for (const std::size_t sphere : spheres_) room_.push_back({probe.lineStart(sphere), probe.reach(sphere)});
  }
  std::optional<std::size_t> nearest;
  btScalar most = 0;
  for (std::size_t i = 0; i < room_.size(); ++i) {
    const btVector3 way = place - room_[i].at;
    const btScalar along = way.dot(direction), reach = room_[i].reach;
    const btScalar spare = reach - (way - direction * along).length();
    if (spare <= most || btFabs(along) > 2 * reach) continue;
    most = spare;
    nearest = spheres_[i];
  }
  return nearest;
}

void ascendAgain(const LineStarts& lines, btScalar separation, const std::vector<ContactPoint>& before,
                 std::vector<Top>& tops) {
  tops.clear();
  for (const ContactPoint& point : before) {
    if (!isDeepest(point.id)) continue;
    const btVector3 place = point.on_b + point.normal * (point.depth / 2);
    ProbedSample top;
    top.direction = point.normal;
    const std::optional<std::size_t> nearest = lines.nearest(place, top.direction);
    if (!nearest) continue;
    top.index = *nearest;
    const btVector3 shift = shiftTo(place, top.direction, lines.probe, top.index);
    if (!lines.probe.probeLine(top.index, top.direction, shift, top.points) || !isUsable(top) ||
        middleOf(top.points).distance2(place) > separation * separation)
      continue;
    const auto isOf = [&](const Top& other) { return leadsTo(other, top, separation); };
    if (std::any_of(tops.begin(), tops.end(), isOf)) continue;
    climbToTop(lines, shift, top);
    if (top.is_top) tops.push_back(topOf(top, lines.probe));
  }
}

void appendDeepestPoints(const LineStarts& lines, btScalar separation, const std::vector<Top>& known,
                         std::size_t of_patch, std::vector<ProbedSample>& samples) {
  for (ProbedSample& sample : samples) {
    if (isUsable(sample)) guessTop(lines.probe, sample);
  }
  Tops tops(known, of_patch);
  while (!tops.areAll()) {
    ProbedSample* start = bestStart(tops, separation, samples);
    if (start == nullptr) break;
    start->starts_ascent = true;
    tops.ascendFrom(*start, lines);
  }
  tops.appendTo(samples);
}

void ascendBeside(const LineStarts& lines, std::size_t count, std::vector<ProbedSample>& samples) {
  for (std::size_t i = 0; i < count; ++i) {
    if (isUsable(samples[i])) climb(lines, kSlopeBeside, kAscentStepsBeside, btVector3(0, 0, 0), samples[i]);
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
