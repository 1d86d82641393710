#include "surface/vertex_hill_climb.hpp"

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Edges that rise less are level [rad].
constexpr btScalar kLevelEdge = btScalar(5e-3);

}  // namespace

VertexHillClimb::VertexHillClimb(const Surface& surface)
    : surface_(surface), first_(surface.vertices.size() + 1), neighbours_(6 * surface.triangles.size()) {
  // Each corner of a triangle has two neighbours in it; inner edges come twice, which does not matter.
  for (const auto& triangle : surface.triangles) {
    for (std::uint32_t v : triangle) first_[v + 1] += 2;
  }
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) first_[v + 1] += first_[v];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const auto& triangle : surface.triangles) {
    for (int k = 0; k < 3; ++k) {
      neighbours_[next[triangle[k]]++] = triangle[(k + 1) % 3];
      neighbours_[next[triangle[k]]++] = triangle[(k + 2) % 3];
    }
  }
}

bool VertexHillClimb::from(std::size_t triangle, const btVector3& direction, const btVector3& start,
                           btScalar max_distance, std::vector<std::uint32_t>& vertices) const {
  const auto at = [&](std::uint32_t v) { return toBullet(surface_.vertices[v]); };
  constexpr std::uint32_t kNone = ~std::uint32_t(0);
  std::uint32_t top = kNone;
  btScalar highest = -BT_LARGE_FLOAT;
  const auto climb = [&](std::uint32_t v) {
    const btScalar height = at(v).dot(direction);
    if (!(height > highest) || !(at(v).distance2(start) < max_distance * max_distance)) return;
    top = v;
    highest = height;
  };
  for (std::uint32_t v : surface_.triangles[triangle]) climb(v);
  if (top == kNone) return false;
  for (std::uint32_t before = kNone; before != top;) {
    before = top;
    for (std::uint32_t i = first_[before]; i < first_[before + 1]; ++i) climb(neighbours_[i]);
  }
  vertices.push_back(top);
  bool is_peak = true;
  for (std::uint32_t i = first_[top]; i < first_[top + 1]; ++i) {
    const btVector3 edge = at(neighbours_[i]) - at(top);
    const btScalar rise = edge.dot(direction), level = kLevelEdge * edge.length();
    if (btFabs(rise) < level) vertices.push_back(neighbours_[i]);
    is_peak = is_peak && !(rise > level);
  }
  return is_peak;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
