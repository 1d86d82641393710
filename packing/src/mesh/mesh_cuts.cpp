#include "mesh/mesh_cuts.hpp"

#include <algorithm>
#include <numeric>

#include "common/bounds.hpp"

namespace innersphere {
namespace {

using Corners = std::array<std::uint32_t, 3>;

// Sign of the volume of a, b, c and the origin; 0 where rounding could decide it.
int orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, double tolerance) {
  const double volume = dot(a, cross(b, c));
  return volume > tolerance ? 1 : volume < -tolerance ? -1 : 0;
}

bool edgePasses(const Vec3d& from, const Vec3d& to, const std::array<Vec3d, 3>& triangle) {
  const Vec3d edge = to - from;
  const Vec3d a = triangle[0] - from, b = triangle[1] - from, c = triangle[2] - from;
  const double size = std::max({norm(edge), norm(a), norm(b), norm(c)});
  const double tolerance = 1e-14 * size * size * size;
  const int before = orientation(a, b, c, tolerance);
  if (before == 0 || orientation(a - edge, b - edge, c - edge, tolerance) != -before) return false;
  const int side = orientation(edge, a, b, tolerance);
  return side != 0 && orientation(edge, b, c, tolerance) == side &&
         orientation(edge, c, a, tolerance) == side;
}

bool hasEdgeThrough(const Mesh& mesh, const Corners& s, const Corners& t) {
  const auto uses = [&](std::uint32_t v) { return v == t[0] || v == t[1] || v == t[2]; };
  const std::array<Vec3d, 3> target{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t i = s[k], j = s[(k + 1) % 3];
    if (!uses(i) && !uses(j) && edgePasses(mesh.vertices[i], mesh.vertices[j], target)) return true;
  }
  return false;
}

}  // namespace

// Boxes sorted along the longest axis: each meets only those that begin before it ends.
Cuts findCuts(const Mesh& mesh) {
  std::vector<Bounds> boxes;
  Bounds all = emptyBounds();
  for (const Corners& t : mesh.triangles) {
    Bounds box = emptyBounds();
    for (std::uint32_t v : t) extend(box, mesh.vertices[v]);
    extend(all, box.min);
    extend(all, box.max);
    boxes.push_back(box);
  }
  const Vec3d size = all.max - all.min;
  const int axis = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<std::uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t i, std::uint32_t j) { return boxes[i].min[axis] < boxes[j].min[axis]; });

  std::vector<Bounds> sorted;  // side by side as they are looked at
  for (const std::uint32_t i : order) sorted.push_back(boxes[i]);

  Cuts cuts;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Bounds& a = sorted[i];
    for (std::size_t j = i + 1; j < order.size() && sorted[j].min[axis] <= a.max[axis]; ++j) {
      if (!meet(a, sorted[j])) continue;
      const Corners &s = mesh.triangles[order[i]], &t = mesh.triangles[order[j]];
      if (!hasEdgeThrough(mesh, s, t) && !hasEdgeThrough(mesh, t, s)) continue;
      if (cuts.pairs++ == 0) cuts.at = mesh.vertices[s[0]];
    }
  }
  return cuts;
}

}  // namespace innersphere
