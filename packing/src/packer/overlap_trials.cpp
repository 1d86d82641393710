#include "packer/overlap_trials.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "common/steady_math.hpp"
#include "packer/jitter.hpp"
#include "surface/shared_volume.hpp"

namespace innersphere {
namespace {

// Points inside that tell about how much copies share, as long as a pose is looked for. Of shares above this
// they have 30.
constexpr double kFewPoints = 1 << 14, kFewShare = 0.002;

// Points inside that tell what is shared where the surface does not.
constexpr double kManyPoints = 1 << 20;

// A surface does not tell if its volume is off by this part: it encloses a part of the solid twice, or its
// triangles are chords of a curve. Only overlaps of less than kShallowShare are found from it all the same.
constexpr double kOff = 1e-3, kShallowShare = 0.01;

// A pose may share up to so many times what is wanted, and is looked for with so many steps. The aim is near
// the deep side, where the search comes from.
constexpr double kAim = 1.15, kAbout = 1.2;
constexpr int kMostSteps = 24;

// Overlaps, as fractions of the solid, that are looked for.
constexpr double kLeastByTriangles = 1e-5, kLeastBySamples = 0.002, kMostShared = kDeepOverlap;

// From here on their errors are told: enough are shallower.
constexpr double kShallowest = 3e-5;

// Copies that lie upon the solid are turned by 1 to 20 degrees: their logarithms are evenly spread.
constexpr double kLeastTurned = std::numbers::pi / 180, kMostTurned = 20 * kLeastTurned;

// The least ball inside the solid, as a part of the largest about its centre. Others touch the surface.
constexpr double kLeastBall = 0.1;

// A face that touches is pushed in by this, and then so many times as far each time, in units of the cube.
constexpr double kFirstPush = 1e-3, kPushes = 2, kLastPush = 0.3;

/// Three numbers in [0, 1) that look random.
Point random(std::size_t trial, std::uint32_t purpose) {
  const std::array<std::uint32_t, 3> at{static_cast<std::uint32_t>(trial), purpose, 0};
  return {jitter(at, 0), jitter(at, 1), jitter(at, 2)};
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

/// Tells what a solid shares with its copy.
class TrueOverlap {
 public:
  TrueOverlap(const Container& container, const Surface& surface, double volume)
      : few_(container, volume, kFewPoints), volume_(volume), scale_(1 / container.side()) {
    shift_ = container.fromWorld(container.origin());
    tree_ = SurfaceTree::ifClosed(surface);
    if (tree_) {
      for (const auto& v : tree_->vertices()) vertices_.push_back(scale_ * Point(v[0], v[1], v[2]) + shift_);
    }
    if (!tree_ || std::abs(below(Point::UnitZ(), 2) - 1) > kOff)
      many_.emplace(container, volume, kManyPoints);
  }

  bool knowsSurface() const { return tree_.has_value(); }

  /// Returns a point inside the solid; `part` is in [0, 1).
  Point point(double part) const { return few_.point(part); }

  /// The fraction of the solid that is below a plane. The surface must be known.
  double below(const Point& normal, double height) const {
    // Seen from a point of the plane: so the part of the plane in the solid adds nothing.
    const Point from = height * normal;
    std::vector<double> above(vertices_.size());
    for (std::size_t i = 0; i < above.size(); ++i) above[i] = normal.dot(vertices_[i] - from);
    double sum = 0;
    const auto add = [&](const Point& a, const Point& b, const Point& c) { sum += a.dot(b.cross(c)) / 6; };
    for (const SurfaceTree::Triangle& triangle : tree_->triangles()) {
      double heights[3];
      for (int k = 0; k < 3; ++k) heights[k] = above[triangle[k]];
      if (heights[0] >= 0 && heights[1] >= 0 && heights[2] >= 0) continue;
      Point corners[3];
      for (int k = 0; k < 3; ++k) corners[k] = vertices_[triangle[k]] - from;
      if (heights[0] < 0 && heights[1] < 0 && heights[2] < 0) {
        add(corners[0], corners[1], corners[2]);
        continue;
      }
      Point polygon[4];
      int count = 0;
      for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        if (heights[k] < 0) polygon[count++] = corners[k];
        if ((heights[k] < 0) == (heights[next] < 0)) continue;
        const double part = heights[k] / (heights[k] - heights[next]);
        polygon[count++] = corners[k] + part * (corners[next] - corners[k]);
      }
      for (int k = 2; k < count; ++k) add(polygon[0], polygon[k - 1], polygon[k]);
    }
    return sum / volume_;
  }

  /// The fraction of the solid, about `expected`, by its triangles, or by many points.
  Voxels::Shared at(const Pose& pose, double expected) const {
    const bool by_triangles = tree_ && (!many_ || expected < kShallowShare);
    return by_triangles ? Voxels::Shared{byTriangles(pose), 0} : many_->shared(pose);
  }

  /// The fraction by few points: to 0.3 % of the solid, some percent if it is thin. Of a copy nearly upon it
  /// up to one percent is missing, as points are looked up in cells that the surface cuts.
  double sampledAt(const Pose& pose) const { return few_.shared(pose).fraction; }

  /// The fraction by triangles, or `sampled` if these do not tell: many points would take long.
  double deepAt(const Pose& pose, double sampled) const { return many_ ? sampled : byTriangles(pose); }

  struct Found {
    double fraction;
    bool exact;
  };

  /// About the fraction, by few points if these are enough. It is less than `most`.
  Found roughlyAt(const Pose& pose, double most) const {
    if (!tree_ || most > kFewShare) {
      const double fraction = few_.shared(pose).fraction;
      if (!tree_ || fraction > kFewShare) return {fraction, false};
    }
    return {byTriangles(pose), true};
  }

 private:
  double byTriangles(const Pose& pose) const {
    const Eigen::Matrix3d r = scale_ * pose.rotation;
    const PlacedSurface solid{*tree_, {{{scale_, 0, 0, 0, scale_, 0, 0, 0, scale_}}, vectorOf(shift_)}};
    const PlacedSurface copy{
        *tree_,
        {{{r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)}},
         vectorOf(pose.apply(shift_))}};
    return sharedVolume(solid, copy).volume / volume_;
  }

  static Vec3d vectorOf(const Point& x) { return {x[0], x[1], x[2]}; }

  Voxels few_;
  std::optional<Voxels> many_;
  std::optional<SurfaceTree> tree_;
  std::vector<Point> vertices_;  // of the surface, in the cube
  double volume_, scale_;
  Point shift_;  // of the packing's frame
};

/// Says how a copy is turned, where it starts and which way it moves out.
struct Start {
  Eigen::Matrix3d turn;
  Point shift, way;
  bool touches = false;  ///< and no more: it is pushed in first
};

/// The copy is turned at random, and a random point of it lies on one of the solid.
Start anyStart(const TrueOverlap& overlap, std::size_t number) {
  const Point places = random(number, 1);
  const Eigen::Matrix3d turn = rotation(random(number, 2)).toRotationMatrix();
  return {turn, overlap.point(places[0]) - turn * overlap.point(places[1]), direction(random(number, 0))};
}

Eigen::Quaterniond turned(double angle, const Point& axis) {
  const Point v = steady::sin(angle / 2) * axis;
  return {steady::cos(angle / 2), v[0], v[1], v[2]};
}

/// A turn by some degrees about any axis.
Eigen::Quaterniond slightTurn(double part, const Point& axis) {
  return turned(kLeastTurned * steady::pow(kMostTurned / kLeastTurned, part), direction(axis));
}

/// The copy lies upon the solid, but for some degrees about a random point.
Start nestedStart(const TrueOverlap& overlap, std::size_t number) {
  const Point places = random(number, 1), middle = overlap.point(places[0]);
  const Eigen::Matrix3d turn = slightTurn(places[1], random(number, 2)).toRotationMatrix();
  return {turn, middle - turn * middle, direction(random(number, 0))};
}

/// A face of the copy lies flat on a face of the solid.
Start facingStart(const SurfaceSamples& samples, std::size_t number) {
  const Point places = random(number, 1);
  const auto sample = [&](double part) {
    return static_cast<std::size_t>(part * static_cast<double>(samples.points().size()));
  };
  const std::size_t at = sample(places[0]), of = sample(places[1]);
  const Point outwards = -samples.inwards()[at];
  const Eigen::Quaterniond any = rotation(random(number, 2));
  // The shortest turn that takes the copy's normal to the other one; half a turn has no shortest.
  const Point normal = any * -samples.inwards()[of], axis = normal.cross(-outwards);
  const double w = 1 - normal.dot(outwards);
  const Eigen::Quaterniond facing = w > 1e-6 ? Eigen::Quaterniond(w, axis[0], axis[1], axis[2]).normalized()
                                             : Eigen::Quaterniond::Identity();
  const Eigen::Matrix3d turn = (facing * any).toRotationMatrix();
  return {turn, samples.points()[at] - turn * samples.points()[of], outwards, true};
}

/// Moves the copy away until both share about the fraction `target`, or leaves it there if they share less:
/// thin solids do.
OverlapTrial findTrial(const TrueOverlap& overlap, const Start& start, double target) {
  struct Step {
    double distance = 0;
    TrueOverlap::Found share{};
    double root() const { return std::sqrt(share.fraction); }
  };
  const auto poseAt = [&](double distance) { return Pose{start.turn, start.shift + distance * start.way}; };
  // Points are looked up in cells that the surface cuts: faces that touch pass for a layer there.
  const bool thin_layer = start.touches && target < kShallowShare;
  const auto look = [&](double distance, double most) {
    return Step{distance, overlap.roughlyAt(poseAt(distance), thin_layer ? 0 : most)};
  };
  Step near = look(0, 1), far{std::numbers::sqrt3, {}};
  for (double push = kFirstPush; start.touches && near.share.fraction < target && push < kLastPush;
       push *= kPushes) {
    far = near;
    near = look(-push, 1);
  }
  const double aim = std::sqrt(kAim * target);
  Step before = near;  // the last two that are too deep
  bool halve = false;
  for (int i = 0; i < kMostSteps && near.share.fraction > kAbout * target; ++i) {
    const double width = far.distance - near.distance;
    double distance = near.distance + width / 2;
    // Overlaps grow about as the square of their depth.
    const Step& other = far.share.fraction > 0 ? far : before;
    const double guess =
        near.distance + (aim - near.root()) / (other.root() - near.root()) * (other.distance - near.distance);
    if (!halve && guess > near.distance && guess < far.distance) distance = guess;
    const Step now = look(distance, near.share.fraction);
    if (now.share.fraction > target) {
      before = near;
      near = now;
    } else {
      far = now;
    }
    // Clearly more than half is left: of exactly half, rounding would decide.
    halve = far.distance - near.distance > 0.6 * width;
  }
  const double share = near.share.fraction;
  const Pose pose = poseAt(near.distance);
  return {pose, near.share.exact ? Voxels::Shared{share, 0} : overlap.at(pose, share)};
}

/// The copy lies upon the solid, but for a turn, a shift, or both, so small that they share about `target`.
OverlapTrial findDeepTrial(const TrueOverlap& overlap, std::size_t number, double target) {
  const Point places = random(number, 1), middle = overlap.point(places[0]);
  const Point axis = direction(random(number, 2)), way = direction(random(number, 0));
  // Turns of one radian and shifts of the cube's side are about as large.
  const double angle = number % 3 == 0 ? 0 : places[1], shift = number % 3 == 1 ? 0 : places[2];
  double size = 0.1, share = 0;  // most are smaller
  Pose pose;
  for (int i = 0; i < kMostSteps; ++i) {
    const Eigen::Matrix3d turn = turned(size * angle, axis).toRotationMatrix();
    pose = {turn, middle - turn * middle + size * shift * way};
    share = overlap.sampledAt(pose);
    // What they do not share grows about as the size.
    const double times = (1 - share) / (1 - target);
    if (times < kAbout && (size == 1 || times > 1 / kAbout)) break;
    size = std::min(size / std::max(times, 0.1), 1.0);
  }
  return {pose, {overlap.deepAt(pose, share), 0}};
}

/// A plane through a random point of the solid.
PlaneCut cutSolid(const TrueOverlap& overlap, std::size_t number) {
  const Point normal = direction(random(number, 4));
  const double height = normal.dot(overlap.point(random(number, 5)[0]));
  return {normal, height, overlap.below(normal, height)};
}

/// A ball inside the solid, about a random point of it.
Ball ballInside(const Container& container, const TrueOverlap& overlap, std::size_t number) {
  const Point places = random(number, 6), centre = overlap.point(places[0]);
  const double clearance = container.closest(centre, std::numeric_limits<double>::infinity()).distance;
  return {centre, (kLeastBall + places[1] * (1 - kLeastBall)) * clearance};
}

}  // namespace

OverlapTrials makeOverlapTrials(const Container& container, const Surface& surface,
                                const SurfaceSamples& samples, double volume, std::size_t count,
                                std::size_t deep) {
  const TrueOverlap overlap(container, surface, volume);
  const double least = overlap.knowsSurface() ? kLeastByTriangles : kLeastBySamples;
  OverlapTrials result{std::vector<OverlapTrial>(count), std::vector<OverlapTrial>(deep),
                       std::vector<PlaneCut>(count / 3), std::vector<Ball>(count / 3),
                       overlap.knowsSurface() ? kShallowest : least};
  if (!overlap.knowsSurface()) result.planes.clear();
  const auto start = [&](std::size_t i) {
    if (i % 3 == 0) return anyStart(overlap, i);
    return i % 3 == 1 || samples.empty() ? nestedStart(overlap, i) : facingStart(samples, i);
  };
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    container.goOn();
    const double part = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    result.trials[i] = findTrial(overlap, start(i), least * steady::pow(kMostShared / least, part));
  });
  tbb::parallel_for(std::size_t{0}, deep, [&](std::size_t i) {
    container.goOn();
    const double part = (static_cast<double>(i) + 0.5) / static_cast<double>(deep);
    result.deep[i] = findDeepTrial(overlap, count + i, kDeepOverlap + part * (1 - kDeepOverlap));
  });
  tbb::parallel_for(std::size_t{0}, result.planes.size(),
                    [&](std::size_t i) { result.planes[i] = cutSolid(overlap, i); });
  tbb::parallel_for(std::size_t{0}, result.inside.size(),
                    [&](std::size_t i) { result.inside[i] = ballInside(container, overlap, i); });
  std::erase_if(result.trials, [](const OverlapTrial& trial) { return !(trial.truth.fraction > 0); });
  return result;
}

}  // namespace innersphere
