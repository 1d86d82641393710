#include "measured_points.hpp"

#include <algorithm>

#include "vec.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Directions in which the outermost contacts of a patch are measured, and how many of the deepest and of the
/// others.
constexpr int kDirections = 8;
constexpr std::size_t kDeepest = 6;
constexpr std::size_t kOthers = 6;
/// Surfaces whose normals differ by less than 20 degrees lie on each other.
constexpr btScalar kOpposed = btScalar(0.94);
/// Else an edge or a corner lies on a face, if there is one within 30 degrees of the direction of the
/// overlap.
constexpr btScalar kFace = btScalar(0.866);
/// A point of the step before is kept until another one spans this much more, or is this fraction of the
/// spacing deeper.
constexpr btScalar kKeepSpan = btScalar(1.3);
constexpr btScalar kKeepDepth = btScalar(0.05);

bool isOld(const PatchContacts& from, std::uint64_t id) {
  return std::find(from.old_ids.begin(), from.old_ids.end(), id) != from.old_ids.end();
}

/// Those of the step before, those that span the patch, the deepest, and some of the others.
void pick(const PatchContacts& from, std::vector<std::size_t>& picked) {
  const std::vector<std::size_t>& indices = from.indices;
  picked = indices;
  if (indices.size() <= kDirections + kDeepest + kOthers) return;
  picked.clear();
  for (std::size_t i : indices) {
    if (isOld(from, from.gauge.id(i))) picked.push_back(i);
  }
  for (int k = 0; k < kDirections; ++k) {
    const btScalar angle = btScalar(k) * SIMD_2_PI / kDirections;
    const btVector3 direction =
        from.moments.tangent[0] * btCos(angle) + from.moments.tangent[1] * btSin(angle);
    const auto along = [&](std::size_t i) { return direction.dot(toBullet(from.contacts[i].centroid)); };
    picked.push_back(*std::max_element(indices.begin(), indices.end(),
                                       [&](std::size_t i, std::size_t j) { return along(i) < along(j); }));
  }
  static thread_local std::vector<std::size_t> by_depth;
  by_depth = indices;
  const auto depth = [&](std::size_t i) {
    return from.contacts[i].volume /
           (toBullet(from.contacts[i].area).length() + SIMD_EPSILON * from.moments.area);
  };
  std::partial_sort(by_depth.begin(), by_depth.begin() + kDeepest, by_depth.end(),
                    [&](std::size_t i, std::size_t j) { return depth(i) > depth(j); });
  picked.insert(picked.end(), by_depth.begin(), by_depth.begin() + kDeepest);
  for (std::size_t k = 0; k < kOthers; ++k) picked.push_back(indices[k * indices.size() / kOthers]);
  std::sort(picked.begin(), picked.end());
  picked.erase(std::unique(picked.begin(), picked.end()), picked.end());
}

struct Measured {
  Gap gap;
  std::uint64_t id;
};

bool opposed(const Gap& gap) {
  return gap.normal_a.dot(gap.normal_b) > kOpposed;
}

/// How much the normal of A counts against that of B. Beside the deepest point both lean away from the normal
/// of contact, each in proportion to its curvature, so the flatter surface counts for more; a flat one counts
/// alone.
class NormalWeights {
 public:
  explicit NormalWeights(const std::vector<Measured>& measured, bool trust_b) {
    btVector3 mean_a(0, 0, 0), mean_b(0, 0, 0);
    int count = 0;
    for (const Measured& m : measured) {
      if (!opposed(m.gap)) continue;
      mean_a += m.gap.normal_a;
      mean_b += m.gap.normal_b;
      ++count;
    }
    if (count < 3) {  // too few to see a curvature
      a_ = trust_b ? btScalar(0) : btScalar(0.5);
      return;
    }
    btScalar bend_a = 0, bend_b = 0;
    for (const Measured& m : measured) {
      if (!opposed(m.gap)) continue;
      bend_a += m.gap.normal_a.distance2(mean_a / btScalar(count));
      bend_b += m.gap.normal_b.distance2(mean_b / btScalar(count));
    }
    bend_a = btSqrt(bend_a) + kFlat;
    bend_b = btSqrt(bend_b) + kFlat;
    a_ = bend_b / (bend_a + bend_b);
  }

  /// The normal of contact at a gap; `direction` is that of the overlap around.
  btVector3 normal(const Gap& gap, const btVector3& direction) const {
    if (opposed(gap)) return (gap.normal_a * a_ + gap.normal_b * (1 - a_)).normalized();
    const btScalar a = gap.normal_a.dot(direction), b = gap.normal_b.dot(direction);
    if (btMax(a, b) < kFace) return direction;
    return a > b ? gap.normal_a : gap.normal_b;
  }

 private:
  static constexpr btScalar kFlat = btScalar(1e-4);  ///< [rad]
  btScalar a_;
};

/// Up to four points: the deepest, then those that span the largest area with it.
class Selection {
 public:
  Selection(const PatchContacts& from, const std::vector<ContactPoint>& found, ContactPatch& patch)
      : from_(from), found_(found), patch_(patch) {}

  void run() {
    patch_.count = 0;
    const auto deepest = [&](const ContactPoint& point) {
      return point.depth + (isOld(from_, point.id) ? kKeepDepth * from_.spacing : btScalar(0));
    };
    const auto farthest = [&](const ContactPoint& point) { return keep(point) * point.on_b.distance(at(0)); };
    const auto largest = [&](const ContactPoint& point) {
      return keep(point) * btFabs(area(at(0), at(1), point.on_b));
    };
    // The fourth widens the triangle across one of its sides.
    const auto widest = [&](const ContactPoint& point) {
      const btScalar turn = area(at(0), at(1), at(2)) < 0 ? btScalar(-1) : btScalar(1);
      btScalar most = 0;
      for (int i = 0; i < 3; ++i) most = btMax(most, -turn * area(at(i), at((i + 1) % 3), point.on_b));
      return keep(point) * most;
    };
    if (take(deepest) && take(farthest) && take(largest)) take(widest);
  }

 private:
  template <typename Score>
  bool take(const Score& score) {
    const ContactPoint* best = nullptr;
    btScalar best_score = 0;
    for (const ContactPoint& point : found_) {
      if (!apart(point)) continue;
      const btScalar s = score(point);
      if (best == nullptr || s > best_score) {
        best = &point;
        best_score = s;
      }
    }
    if (best == nullptr) return false;
    patch_.points[patch_.count++] = *best;
    return true;
  }
  bool apart(const ContactPoint& point) const {
    for (int i = 0; i < patch_.count; ++i) {
      if (point.on_b.distance2(at(i)) <= from_.spacing * from_.spacing) return false;
    }
    return true;
  }
  btScalar keep(const ContactPoint& point) const { return isOld(from_, point.id) ? kKeepSpan : btScalar(1); }
  const btVector3& at(int i) const { return patch_.points[i].on_b; }
  btScalar area(const btVector3& p, const btVector3& q, const btVector3& r) const {
    return (q - p).cross(r - p).dot(patch_.normal);
  }

  const PatchContacts& from_;
  const std::vector<ContactPoint>& found_;
  ContactPatch& patch_;
};

}  // namespace

void measuredPoints(const PatchContacts& from, ContactPatch& patch) {
  static thread_local std::vector<std::size_t> picked;
  static thread_local std::vector<Measured> measured;
  static thread_local std::vector<ContactPoint> found;
  pick(from, picked);
  measured.clear();
  for (std::size_t i : picked) {
    Measured m{{}, from.gauge.id(i)};
    if (from.gauge.measure(i, from.moments.normal, m.gap)) measured.push_back(m);
  }
  const NormalWeights weights(measured, from.gauge.exactB());
  found.clear();
  for (const Measured& m : measured) {
    const btVector3 normal = weights.normal(m.gap, from.moments.normal);
    const btScalar depth = (m.gap.on_a - m.gap.on_b).dot(normal);
    if (depth > -from.spacing) found.push_back({m.gap.on_b, normal, depth, m.id});
  }
  Selection(from, found, patch).run();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
