#include "narrow_phase/manifold_reduction.hpp"

#include <algorithm>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// A point of the step before is kept until another one spans this much more, or is this fraction of the
/// spacing deeper.
constexpr btScalar kKeepSpan = btScalar(1.3);
constexpr btScalar kKeepDepth = btScalar(1e-3);
/// Part of that depth that a point at the rim of the patch may lack.
constexpr btScalar kOutwards = btScalar(0.5);
/// Points that are less deep than the deepest by this fraction of the spacing are worth 1/e of it.
constexpr btScalar kTouching = btScalar(0.1);
/// Normals within 15 degrees of that of a group's deepest point belong to the group.
constexpr btScalar kSameGroup = btScalar(0.966);
/// More groups than this are merged.
constexpr std::size_t kMaxGroups = 8;

/// How far around a crossing edges have sunk in, in units of the depth.
constexpr btScalar kSunkAround = 3;

/// Whether there is a better way out than the one that `point` is pushed, by `other`.
bool isFreedBy(const WeightedPoint& other, const WeightedPoint& point, btScalar spacing) {
  using Kind = WeightedPoint::Kind;
  const bool crossing = point.kind == Kind::crossing;
  if (!crossing && (other.kind != Kind::crossing || point.kind == Kind::faces)) return false;
  if (other.kind == Kind::edge || point.point.normal.dot(other.point.normal) > kSameGroup) return false;
  const auto middle = [](const ContactPoint& p) { return p.on_b + p.normal * (p.depth / 2); };
  const btScalar depth = crossing ? point.point.depth : other.point.depth;
  const btScalar around = kSunkAround * btMax(depth, btScalar(0)) + spacing;
  if (middle(point.point).distance2(middle(other.point)) > around * around) return false;
  return point.kind == Kind::edge || point.point.depth > other.point.depth;
}

class Selection {
 public:
  /// `worth`: room for a number of each point.
  Selection(const std::vector<ContactPoint>& found, const std::vector<std::uint64_t>& old_ids,
            btScalar spacing, ContactPatch& patch, std::vector<btScalar>& worth)
      : found_(found), old_ids_(old_ids), spacing_(spacing), patch_(patch), worth_(worth) {}

  void run() {
    patch_.count = 0;
    // Flat faces are as deep everywhere; at their rim a point bears them best.
    const btScalar rim = reach();
    const auto deepest = [&](std::size_t i) {
      const ContactPoint& point = found_[i];
      const int steps = point.id == kDeepestId ? 2 : isOld(point) ? 1 : 0;
      const btScalar outwards = rim > 0 ? kOutwards * point.on_b.distance(patch_.centre) / rim : btScalar(0);
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
    worth_.clear();
    for (const ContactPoint& point : found_) worth_.push_back(worth(point));
    if (take(farthest) && take(largest)) take(widest);
  }

 private:
  template <typename Score>
  bool take(const Score& score) {
    const ContactPoint* best = nullptr;
    btScalar best_score = 0;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      if (!apart(found_[i])) continue;
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
  bool apart(const ContactPoint& point) const {
    for (int i = 0; i < patch_.count; ++i) {
      if (point.on_b.distance2(at(i)) <= spacing_ * spacing_) return false;
    }
    return true;
  }
  /// Farthest from the centre of the patch.
  btScalar reach() const {
    btScalar most = 0;
    for (const ContactPoint& point : found_) most = btMax(most, point.on_b.distance2(patch_.centre));
    return btSqrt(most);
  }
  bool isOld(const ContactPoint& point) const {
    return std::find(old_ids_.begin(), old_ids_.end(), point.id) != old_ids_.end();
  }
  /// Of a point that widens the patch: less the farther it is from touching, compared with the deepest.
  btScalar worth(const ContactPoint& point) const {
    const btScalar above = (patch_.points[0].depth - point.depth) / (kTouching * spacing_);
    return (isOld(point) ? kKeepSpan : btScalar(1)) * btExp(-above);
  }
  const btVector3& at(int i) const { return patch_.points[i].on_b; }
  btScalar area(const btVector3& p, const btVector3& q, const btVector3& r) const {
    return (q - p).cross(r - p).dot(patch_.normal);
  }

  const std::vector<ContactPoint>& found_;
  const std::vector<std::uint64_t>& old_ids_;
  btScalar spacing_;
  ContactPatch& patch_;
  std::vector<btScalar>& worth_;
};

/// How far the area of a group reaches from its centre: sums over the patches of spheres in it.
struct Reach {
  btScalar area = 0;
  btVector3 centre{0, 0, 0};
  btScalar square = 0;

  void add(const WeightedPoint& m) {
    area += m.area;
    centre += m.centre * m.area;
    square += (m.radius * m.radius + m.centre.length2()) * m.area;
  }
  btScalar radius() const { return btSqrt(btMax(btScalar(0), square / area - (centre / area).length2())); }
};

std::vector<std::vector<ContactPoint>> roomForGroups() {
  constexpr std::size_t kUsualPoints = 64;
  std::vector<std::vector<ContactPoint>> groups(kMaxGroups);
  for (std::vector<ContactPoint>& group : groups) group.reserve(kUsualPoints);
  return groups;
}

}  // namespace

void keepLeastWaysOut(btScalar spacing, std::vector<WeightedPoint>& found) {
  static thread_local std::vector<WeightedPoint> all;
  const auto isCrossing = [](const WeightedPoint& m) { return m.kind == WeightedPoint::Kind::crossing; };
  if (std::none_of(found.begin(), found.end(), isCrossing)) return;
  all = found;
  const auto isFreed = [&](const WeightedPoint& m) {
    return std::any_of(all.begin(), all.end(),
                       [&](const WeightedPoint& other) { return isFreedBy(other, m, spacing); });
  };
  found.erase(std::remove_if(found.begin(), found.end(), isFreed), found.end());
}

void reduceToManifolds(std::vector<WeightedPoint>& found, const std::vector<std::uint64_t>& old_ids,
                       btScalar spacing, std::vector<ContactPatch>& patches) {
  static thread_local std::vector<std::vector<ContactPoint>> groups = roomForGroups();
  static thread_local std::vector<btScalar> worth;
  std::array<Reach, kMaxGroups> reaches;
  for (std::vector<ContactPoint>& group : groups) group.clear();
  patches.clear();
  std::sort(found.begin(), found.end(), [](const WeightedPoint& a, const WeightedPoint& b) {
    return a.point.depth != b.point.depth ? a.point.depth > b.point.depth : a.point.id < b.point.id;
  });
  for (const WeightedPoint& m : found) {
    std::size_t best = patches.size();
    btScalar cosine = patches.size() < kMaxGroups ? kSameGroup : btScalar(-2);
    for (std::size_t g = 0; g < patches.size(); ++g) {
      const btScalar c = groups[g].front().normal.dot(m.point.normal);
      if (c > cosine) {
        cosine = c;
        best = g;
      }
    }
    if (best == patches.size()) patches.emplace_back();
    groups[best].push_back(m.point);
    reaches[best].add(m);
    ContactPatch& patch = patches[best];
    patch.area += m.area;
    patch.normal += m.point.normal * m.area;
    patch.centre += m.point.on_b * m.area;
  }
  for (std::size_t g = 0; g < patches.size(); ++g) {
    patches[g].normal.normalize();
    patches[g].centre /= patches[g].area;
    patches[g].radius = reaches[g].radius();
    Selection(groups[g], old_ids, spacing, patches[g], worth).run();
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
