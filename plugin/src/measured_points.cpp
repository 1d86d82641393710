#include "measured_points.hpp"

#include <algorithm>
#include <array>

#include "contact_normal.hpp"
#include "deepest_point.hpp"
#include "vec.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Directions in which the outermost contacts of a patch are measured, sectors in which those that stand out
/// most of each solid are, and how many of the most facing and of the others.
constexpr int kDirections = 8;
constexpr int kSectors = 8;
constexpr std::size_t kFacing = 6;
constexpr std::size_t kOthers = 6;
/// In units of the spacing: how much less deep than the deepest a contact may be.
constexpr btScalar kBelow = 2;
/// The nearest point counts if it lies within 60 degrees of the patch's direction.
constexpr btScalar kOwnDirection = btScalar(0.5);
/// A line within 5 degrees of the normal is not drawn again where flat faces meet, which it does not matter
/// to; else one within 0.5 degrees.
constexpr btScalar kAligned = btScalar(0.996);
constexpr btScalar kParallel = btScalar(0.99996);
/// A face that leans more than this does not lie flat on the other: a corner is deeper [rad].
constexpr btScalar kLeans = btScalar(5e-3);

bool isOld(const PatchContacts& from, std::uint64_t id) {
  return std::find(from.old_ids.begin(), from.old_ids.end(), id) != from.old_ids.end();
}

/// Contacts far less deep than the deepest only touch because they were enlarged. A cap's depth is about
/// twice its volume over its area; a sphere that is inside as a whole has no area, and stays.
void dropFar(const PatchContacts& from, std::vector<std::size_t>& near) {
  const auto depth = [&](std::size_t i) {
    const btScalar area = toBullet(from.contacts[i].area).length();
    return area > 0 ? 2 * from.contacts[i].volume / area : btScalar(0);
  };
  btScalar deepest = 0;
  for (std::size_t i : near) deepest = btMax(deepest, depth(i));
  near.erase(std::remove_if(near.begin(), near.end(),
                            [&](std::size_t i) {
                              const btScalar d = depth(i);
                              return d > 0 && d < deepest - kBelow * from.measure.spacing;
                            }),
             near.end());
}

/// Where solids are bumpy, a corner or a foot stands out, and small spheres in it.
void pickForward(const PatchContacts& from, const std::vector<std::size_t>& near,
                 std::vector<std::size_t>& picked) {
  struct Best {
    std::size_t index = 0;
    btScalar distance = -BT_LARGE_FLOAT;
  };
  std::array<Best, 2 * kSectors> best;
  for (std::size_t i : near) {
    const btVector3 side = toBullet(from.contacts[i].centroid) - from.moments.centre;
    const btScalar angle = btAtan2(side.dot(from.moments.tangent[1]), side.dot(from.moments.tangent[0]));
    const int sector = static_cast<int>((angle + SIMD_PI) / SIMD_2_PI * kSectors) % kSectors;
    const Gauge::Forward forward = from.gauge.forward(i, from.moments.normal);
    Best& b = best[2 * sector + (forward.of_a ? 0 : 1)];
    if (forward.distance > b.distance) b = {i, forward.distance};
  }
  for (const Best& b : best) {
    if (b.distance > -BT_LARGE_FLOAT) picked.push_back(b.index);
  }
}

/// Those of the step before, those that span the patch, those that stand out or face the other body most, and
/// some of the others.
void pick(const PatchContacts& from, std::vector<std::size_t>& picked) {
  static thread_local std::vector<std::size_t> near;
  near = from.indices;
  if (from.gauge.exactB()) dropFar(from, near);
  picked = near;
  if (near.size() <= kDirections + kFacing + kOthers) return;
  picked.clear();
  for (std::size_t i : near) {
    if (isOld(from, from.gauge.id(i))) picked.push_back(i);
  }
  for (int k = 0; k < kDirections; ++k) {
    const btScalar angle = btScalar(k) * SIMD_2_PI / kDirections;
    const btVector3 direction =
        from.moments.tangent[0] * btCos(angle) + from.moments.tangent[1] * btSin(angle);
    const auto along = [&](std::size_t i) { return direction.dot(toBullet(from.contacts[i].centroid)); };
    picked.push_back(*std::max_element(near.begin(), near.end(),
                                       [&](std::size_t i, std::size_t j) { return along(i) < along(j); }));
  }
  for (std::size_t k = 0; k < kOthers; ++k) picked.push_back(near[k * near.size() / kOthers]);
  pickForward(from, near, picked);
  const auto facing = [&](std::size_t i) { return from.moments.normal.dot(toBullet(from.contacts[i].area)); };
  std::partial_sort(near.begin(), near.begin() + kFacing, near.end(),
                    [&](std::size_t i, std::size_t j) { return facing(i) > facing(j); });
  picked.insert(picked.end(), near.begin(), near.begin() + kFacing);
  std::sort(picked.begin(), picked.end());
  picked.erase(std::unique(picked.begin(), picked.end()), picked.end());
}

/// Along a line through the sphere's centre.
bool measureAlong(const PatchContacts& from, std::size_t i, const btVector3& direction, Measured& m) {
  m.direction = direction;
  return from.gauge.measure(i, direction, btVector3(0, 0, 0), m.gap);
}

/// Towards the nearest point of the other surface, or, where the surfaces do not oppose each other there, in
/// the direction of the patch; then along the normal that the surfaces show.
bool measure(const PatchContacts& from, std::size_t i, Measured& m) {
  m.index = i;
  m.id = from.gauge.id(i);
  btVector3 nearest;
  bool found = from.gauge.nearest(i, nearest) && measureAlong(from, i, nearest, m);
  if (from.gauge.exactB()) return found;
  const bool own = found && opposed(m.gap) && nearest.dot(from.moments.normal) > kOwnDirection;
  if (!own) found = measureAlong(from, i, from.moments.normal, m);
  if (!found) return false;
  const btVector3 normal = normalAlone(m.gap, m.direction);
  Gap gap;
  const bool parallel = m.gap.normal_a.dot(m.gap.normal_b) > kParallel;
  const bool aligned = normal.dot(m.direction) > (parallel ? kAligned : kParallel);
  if (!aligned && from.gauge.measure(i, normal, btVector3(0, 0, 0), gap)) {
    m.direction = normal;
    m.gap = gap;
  }
  return true;
}

/// Whether a corner of a surface is deeper than the place where it was measured.
bool rises(const btVector3& face, btScalar curvature, const btVector3& normal) {
  return curvature == 0 && face.distance2(normal) > kLeans * kLeans;
}

}  // namespace

void measurePoints(const PatchContacts& from, std::vector<MeasuredPoint>& found) {
  static thread_local std::vector<std::size_t> picked;
  static thread_local std::vector<Measured> measured;
  static thread_local std::vector<Gauge::Corner> corners;
  pick(from, picked);
  measured.clear();
  for (std::size_t i : picked) {
    Measured m;
    if (measure(from, i, m)) measured.push_back(m);
  }
  climb(from.gauge, measured);
  const ContactNormal normals(measured, from.gauge);
  const std::size_t first = found.size();
  const auto add = [&](const btVector3& on_b, const btVector3& normal, btScalar depth, std::uint64_t id) {
    if (depth > -from.measure.separation) found.push_back({{on_b, normal, depth, id}, 0});
  };
  const auto isFound = [&](std::uint64_t id) {
    return std::any_of(found.begin(), found.end(), [&](const MeasuredPoint& f) { return f.point.id == id; });
  };
  for (const Measured& m : measured) {
    const btVector3 normal = normals.at(m);
    add(m.gap.on_b, normal, (m.gap.on_a - m.gap.on_b).dot(normal), m.id);
    const bool edge_a = rises(m.gap.normal_a, m.gap.curvature_a, normal),
               edge_b = rises(m.gap.normal_b, m.gap.curvature_b, normal);
    if (edge_a == edge_b) continue;
    corners.clear();
    from.gauge.corners(m.index, m.gap, normal, edge_a, corners);
    for (const Gauge::Corner& corner : corners) {
      if (isFound(corner.id)) continue;
      const btScalar depth =
          edge_a ? (corner.at - m.gap.on_b).dot(normal) : (m.gap.on_a - corner.at).dot(normal);
      add(edge_a ? corner.at - normal * depth : corner.at, normal, depth, corner.id);
    }
  }
  for (std::size_t i = first; i < found.size(); ++i) {
    found[i].area = from.moments.area / btScalar(found.size() - first);
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
