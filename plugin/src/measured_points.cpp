#include "measured_points.hpp"

#include <algorithm>

#include "contact_normal.hpp"
#include "deepest_point.hpp"
#include "vec.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Directions in which the outermost contacts of a patch are measured, and how many of the deepest and of the
/// others.
constexpr int kDirections = 8;
constexpr std::size_t kDeepest = 6;
constexpr std::size_t kOthers = 6;

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

}  // namespace

void measurePoints(const PatchContacts& from, std::vector<MeasuredPoint>& found) {
  static thread_local std::vector<std::size_t> picked;
  static thread_local std::vector<Measured> measured;
  const btVector3& direction = from.moments.normal;
  pick(from, picked);
  measured.clear();
  for (std::size_t i : picked) {
    Measured m{{}, i, from.gauge.id(i)};
    if (from.gauge.measure(i, direction, btVector3(0, 0, 0), m.gap)) measured.push_back(m);
  }
  appendDeepest(from.gauge, direction, measured);
  const ContactNormal normals(measured, from.gauge.exactB());
  const std::size_t first = found.size();
  for (const Measured& m : measured) {
    const btVector3 normal = normals.at(m.gap, direction);
    const btScalar depth = (m.gap.on_a - m.gap.on_b).dot(normal);
    if (depth > -from.spacing) found.push_back({{m.gap.on_b, normal, depth, m.id}, 0});
  }
  for (std::size_t i = first; i < found.size(); ++i) {
    found[i].area = from.moments.area / btScalar(found.size() - first);
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
