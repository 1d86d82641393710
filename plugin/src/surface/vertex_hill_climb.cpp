#include "surface/vertex_hill_climb.hpp"

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Edges that rise less are level [rad].
constexpr btScalar kLevelEdge = btScalar(5e-3);

}  // namespace

VertexHillClimb::VertexHillClimb(const Surface& surface)
    : surface_(surface), first_(surface.vertices.size() + 1), around_(3 * surface.triangles.size()) {
  for (const auto& triangle : surface.triangles) {
    for (std::uint32_t v : triangle) ++first_[v + 1];
  }
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) first_[v + 1] += first_[v];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    for (std::uint32_t v : surface.triangles[t]) around_[next[v]++] = t;
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
  // Inner edges come twice, which does not matter.
  const auto forNeighbours = [&](std::uint32_t v, const auto& look) {
    for (const std::uint32_t t : around(v)) {
      for (const std::uint32_t other : surface_.triangles[t])
        if (other != v) look(other);
    }
  };
  for (std::uint32_t before = kNone; before != top;) {
    before = top;
    forNeighbours(before, climb);
  }
  vertices.push_back(top);
  bool is_peak = true;
  forNeighbours(top, [&](std::uint32_t v) {
    const btVector3 edge = at(v) - at(top);
    const btScalar rise = edge.dot(direction), level = kLevelEdge * edge.length();
    if (btFabs(rise) < level) vertices.push_back(v);
    is_peak = is_peak && !(rise > level);
  });
  return is_peak;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
