#include "narrow_phase/manifold_reduction.hpp"

#include <algorithm>
#include <functional>

#include "narrow_phase/deepest_points.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Whether there is a better way out than the one that `point` is pushed, by `other`.
bool isFreedBy(const WeightedPoint& other, const WeightedPoint& point, btScalar spacing) {
  using Kind = WeightedPoint::Kind;
  const bool crossing = point.kind == Kind::crossing;
  if (!crossing && (other.kind != Kind::crossing || point.kind == Kind::faces)) return false;
  if (other.kind == Kind::edge || other.kind == Kind::line) return false;
  // What was seen askew is near the way that the crossing knows.
  if (point.kind != Kind::line && point.point.normal.dot(other.point.normal) > kSameManifoldCosine)
    return false;
  const auto middle = [](const ContactPoint& p) { return p.on_b + p.normal * (p.depth / 2); };
  const btScalar depth = crossing ? point.point.depth : other.point.depth;
  const btScalar around = kSunkAround * btMax(depth, btScalar(0)) + spacing;
  if (middle(point.point).distance2(middle(other.point)) > around * around) return false;
  return point.kind == Kind::edge || point.kind == Kind::line || point.point.depth > other.point.depth;
}

bool isDeeper(const WeightedPoint& a, const WeightedPoint& b) {
  return a.point.depth != b.point.depth ? a.point.depth > b.point.depth : a.point.id < b.point.id;
}

/// Chooses up to four of the points with one normal.
class FourPoints {
 public:
  /// `worth`: room for a number of each point.
  FourPoints(const std::vector<ContactPoint>& found, const std::vector<std::uint64_t>& old_ids,
             btScalar spacing, const StepAhead& step, ContactPatch& patch, std::vector<btScalar>& worth)
      : found_(found), old_ids_(old_ids), spacing_(spacing), step_(step), patch_(patch), worth_(worth) {}

  void choose() {
    patch_.count = 0;
    // Flat faces are as deep everywhere; at their rim a point bears them best.
    const btScalar rim = rimRadius();
    const auto deepest = [&](std::size_t i) {
      const ContactPoint& point = found_[i];
      const int steps = point.id == kDeepestId ? 2 : isOld(point) ? 1 : 0;
      const btScalar outwards = rim > 0 ? kPreferRim * point.on_b.distance(patch_.centre) / rim : btScalar(0);
      return point.depth + (btScalar(steps) + outwards) * kKeepDepth * spacing_;
    };
    const auto farthest = [&](std::size_t i) { return worth_[i] * found_[i].on_b.distance(at(0)); };
    const auto largest = [&](std::size_t i) {
      return worth_[i] * btFabs(area(at(0), at(1), found_[i].on_b));
    };
    // The fourth widens the triangle across one of its sides.
    const auto widest = [&](std::size_t k) {
      const btScalar turn = area(at(0), at(1), at(2)) < 0 ? btScalar(-1) : btScalar(1);
      btScalar most = 0;
      for (int i = 0; i < 3; ++i) most = btMax(most, -turn * area(at(i), at((i + 1) % 3), found_[k].on_b));
      return worth_[k] * most;
    };
    if (!take(deepest)) return;
    findWorths();
    if (take(farthest) && take(largest)) take(widest);
  }

 private:
  template <typename Score>
  bool take(const Score& score) {
    const ContactPoint* best = nullptr;
    btScalar best_score = 0;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      if (!isApart(found_[i])) continue;
      const btScalar s = score(i);
      if (best == nullptr || s > best_score) {
        best = &found_[i];
        best_score = s;
      }
    }
    if (best == nullptr) return false;
    patch_.points[patch_.count++] = *best;
    return true;
  }
  /// From those that were chosen.
  bool isApart(const ContactPoint& point) const {
    for (int i = 0; i < patch_.count; ++i) {
      if (point.on_b.distance2(at(i)) <= spacing_ * spacing_) return false;
    }
    return true;
  }
  /// Distance of the farthest point from the centre of the patch.
  btScalar rimRadius() const {
    btScalar most = 0;
    for (const ContactPoint& point : found_) most = btMax(most, point.on_b.distance2(patch_.centre));
    return btSqrt(most);
  }
  bool isOld(const ContactPoint& point) const {
    return std::find(old_ids_.begin(), old_ids_.end(), point.id) != old_ids_.end();
  }
  /// Of points that widen the patch: less the farther they are from touching, compared with the deepest. What
  /// the step alone would drive into the other body has to be held in it, so depths are those at its end, and
  /// where bodies have sunk in, or will, all that has counts. But a place on a hill is not another one than
  /// the top of that hill, unless bodies are so fast that all of it might sink in, or it is driven in itself.
  void findWorths() {
    worth_.clear();
    btScalar deepest = -BT_LARGE_FLOAT;
    for (const ContactPoint& point : found_) {
      worth_.push_back(step_.depthAtEnd(point.on_b, point.normal, point.depth));
      deepest = btMax(deepest, worth_.back());
    }
    const btScalar falls = btMax(kWorthFalls * spacing_, deepest);
    const btScalar hill = step_.motion.isSwept() ? btMax(spacing_, step_.needed) : spacing_;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const btScalar driven = worth_[i] > kDrivenIn * step_.size ? worth_[i] : btScalar(0);
      const btScalar below =
          (deepest - worth_[i]) / falls + found_[i].below_top / btMax(kWorthFalls * hill, driven);
      worth_[i] = (isOld(found_[i]) ? kKeepSpan : btScalar(1)) * btExp(-below);
    }
  }
  const btVector3& at(int i) const { return patch_.points[i].on_b; }
  btScalar area(const btVector3& p, const btVector3& q, const btVector3& r) const {
    return (q - p).cross(r - p).dot(patch_.normal);
  }

  const std::vector<ContactPoint>& found_;
  const std::vector<std::uint64_t>& old_ids_;
  btScalar spacing_;
  const StepAhead& step_;
  ContactPatch& patch_;
  std::vector<btScalar>& worth_;
};

/// How far the area of a group is spread from its centre: sums over the patches of spheres in it.
struct Spread {
  btScalar area = 0;
  btVector3 centre{0, 0, 0};
  btScalar square = 0;

  void add(const WeightedPoint& p) {
    area += p.area;
    centre += p.centre * p.area;
    square += (p.radius * p.radius + p.centre.length2()) * p.area;
  }
  btScalar radius() const { return btSqrt(btMax(btScalar(0), square / area - (centre / area).length2())); }
};

/// The group whose normal is nearest, `count` if a new one is to begin.
std::size_t groupFor(const ContactPoint& point, const ReductionScratch& scratch, std::size_t count) {
  std::size_t best = count;
  btScalar cosine = count < kMaxManifolds ? kSameManifoldCosine : btScalar(-2);
  for (std::size_t g = 0; g < count; ++g) {
    const btScalar c = scratch.groups[g].front().normal.dot(point.normal);
    if (c > cosine) {
      cosine = c;
      best = g;
    }
  }
  return best;
}

/// The hill of a top. If it is a straight ridge, it goes on as far as there are tops on its crest. Not in a
/// hollow, whose sides are touched as soon as what lies in it moves.
class TopHill {
 public:
  TopHill(const WeightedPoint& top, btScalar separation, const std::vector<WeightedPoint>& found)
      : top_(top.point.on_b),
        hill_(top.point.bend_a, top.point.bend_b, top.point.depth, Across(top.point.normal)),
        separation_(separation),
        has_sides_(hill_.isStraightRidge() && !top.point.bend_a.isHollow() && !top.point.bend_b.isHollow()) {
    for (std::size_t i = 0; i < found.size() && found[i].is_top && has_sides_; ++i) {
      const btVector3 way = found[i].point.on_b - found[i].moved - top_;
      const btScalar along = way.dot(hill_.axis(1));
      if (!isOnCrest(way)) continue;
      begin_ = btMin(begin_, along);
      end_ = btMax(end_, along);
    }
  }

  bool includes(const WeightedPoint& p) const {
    const btVector3 way = p.point.on_b - p.moved - top_;
    return p.bends && (isOnHill(way, p.slope, hill_, separation_) || isOnSideOfRidge(way, p.slope));
  }

 private:
  bool isOnCrest(const btVector3& way) const {
    return btFabs(way.dot(hill_.axis(0))) < kSameTop * separation_;
  }
  bool isOnSideOfRidge(const btVector3& way, const btVector3& slope) const {
    if (!has_sides_ || isOnCrest(way)) return false;
    const btScalar along = way.dot(hill_.axis(1)), across = btFabs(way.dot(hill_.axis(0)));
    return along > begin_ - across && along < end_ + across &&
           isOnHill(way - hill_.axis(1) * along, slope, hill_, separation_);
  }

  btVector3 top_;
  Hill hill_;
  btScalar separation_;
  bool has_sides_;
  btScalar begin_ = 0, end_ = 0;  ///< of the crest, from the top [m]
};

}  // namespace

ReductionScratch::ReductionScratch() {
  constexpr std::size_t kUsualPoints = 64;
  for (std::vector<ContactPoint>& group : groups) group.reserve(kUsualPoints);
}

void keepLeastWaysOut(btScalar spacing, ReductionScratch& scratch, std::vector<WeightedPoint>& found) {
  const auto isCrossing = [](const WeightedPoint& p) { return p.kind == WeightedPoint::Kind::crossing; };
  if (std::none_of(found.begin(), found.end(), isCrossing)) return;
  const std::vector<WeightedPoint>& all = scratch.all = found;
  const auto isFreed = [&](const WeightedPoint& p) {
    return std::any_of(all.begin(), all.end(),
                       [&](const WeightedPoint& other) { return isFreedBy(other, p, spacing); });
  };
  found.erase(std::remove_if(found.begin(), found.end(), isFreed), found.end());
}

void dropBeyondEnds(std::vector<WeightedPoint>& found) {
  const auto bearsInstead = [](const WeightedPoint& other, const WeightedPoint& p) {
    return other.beyond_end == 0 && other.point.depth > p.point.depth &&
           other.point.on_b.distance(p.point.on_b) < p.beyond_end;
  };
  const auto ends = [](const WeightedPoint& p) { return p.beyond_end > 0; };
  const auto first = std::partition(found.begin(), found.end(), std::not_fn(ends));
  const auto kept = std::remove_if(first, found.end(), [&](const WeightedPoint& p) {
    return std::any_of(found.begin(), first,
                       [&](const WeightedPoint& other) { return bearsInstead(other, p); });
  });
  found.erase(kept, found.end());
}

void keepTops(btScalar separation, const StepAhead& step, std::vector<WeightedPoint>& found) {
  if (step.motion.isSwept()) return;
  // Deeper tops come first: each drops what is on its hill, other tops too.
  std::sort(found.begin(), found.end(), [](const WeightedPoint& a, const WeightedPoint& b) {
    return a.is_top != b.is_top ? a.is_top : isDeeper(a, b);
  });
  for (std::size_t i = 0; i < found.size() && found[i].is_top; ++i) {
    const ContactPoint top = found[i].point;
    const TopHill hill(found[i], separation, found);
    const auto isBeside = [&](const WeightedPoint& p) { return hill.includes(p); };
    const bool alone = i == 0 && std::all_of(found.begin() + 1, found.end(), isBeside);
    const bool sunk_in = alone ? step.depthAtEnd(top.on_b, top.normal, top.depth) > kDrivenIn * step.size
                               : top.depth > kSunkIn * step.size;
    if (sunk_in) continue;
    found.erase(std::remove_if(found.begin() + std::ptrdiff_t(i) + 1, found.end(), isBeside), found.end());
  }
}

void reduceToManifolds(std::vector<WeightedPoint>& found, const std::vector<std::uint64_t>& old_ids,
                       btScalar spacing, const StepAhead& step, ReductionScratch& scratch,
                       std::vector<ContactPatch>& patches) {
  std::array<Spread, kMaxManifolds> spreads;
  for (std::vector<ContactPoint>& group : scratch.groups) group.clear();
  patches.clear();
  std::sort(found.begin(), found.end(), isDeeper);
  for (const WeightedPoint& p : found) {
    const std::size_t g = groupFor(p.point, scratch, patches.size());
    if (g == patches.size()) patches.emplace_back();
    scratch.groups[g].push_back(p.point);
    spreads[g].add(p);
    ContactPatch& patch = patches[g];
    patch.area += p.area;
    patch.normal += p.point.normal * p.area;
    patch.centre += p.point.on_b * p.area;
  }
  for (std::size_t g = 0; g < patches.size(); ++g) {
    patches[g].normal.normalize();
    patches[g].centre /= patches[g].area;
    patches[g].radius = spreads[g].radius();
    FourPoints(scratch.groups[g], old_ids, spacing, step, patches[g], scratch.worth).choose();
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
