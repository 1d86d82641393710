// Chazelle's polyhedron (1984): a cube with wedges cut from below and above that nearly meet along the
// rulings of a saddle, so that every decomposition into convex parts needs many of them.
#include "solids/generators.hpp"
#include "solids/named_meshes.hpp"

namespace innersphere {
namespace {

constexpr double kHalf = 0.5;
constexpr double kSaddle = 1.2;  // the saddle is z = kSaddle x y
constexpr double kApart = 0.04;  // from the saddle to the edge of a wedge
constexpr double kSlope = 0.36;  // half width of a wedge over its height, times the number of wedges

// The border of the notched bottom at y, from low to high x, as (x, z).
Polygon border(double y, int wedges) {
  Polygon edge{{-kHalf, -kHalf}};
  for (int i = 0; i < wedges; ++i) {
    const double x = (2 * i + 1 - wedges) / (2.5 * wedges);
    const double top = kSaddle * x * y - kApart;
    const double width = kSlope / wedges * (top + kHalf);
    edge.push_back({x - width, -kHalf});
    edge.push_back({x, top});
    edge.push_back({x + width, -kHalf});
  }
  edge.push_back({kHalf, -kHalf});
  return edge;
}

// The bottom with its wedges, and the walls at low and high y.
Mesh lowerHalf(int wedges) {
  Mesh mesh;
  const Polygon low = border(-kHalf, wedges), high = border(kHalf, wedges);
  const auto n = static_cast<std::uint32_t>(low.size());
  for (const auto& p : low) mesh.vertices.push_back({p[0], -kHalf, p[1]});
  for (const auto& p : high) mesh.vertices.push_back({p[0], kHalf, p[1]});
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    mesh.triangles.push_back({i, n + i, n + i + 1});
    mesh.triangles.push_back({i, n + i + 1, i + 1});
  }
  for (const bool at_high : {false, true}) {
    Polygon wall = at_high ? high : low;
    wall.push_back({kHalf, kHalf});
    wall.push_back({-kHalf, kHalf});
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& p : wall) mesh.vertices.push_back({p[0], at_high ? kHalf : -kHalf, p[1]});
    for (const auto& t : triangulate(wall)) {
      mesh.triangles.push_back({first + t[0], first + t[at_high ? 2 : 1], first + t[at_high ? 1 : 2]});
    }
  }
  return mesh;
}

}  // namespace

// The upper half is the lower one under (x, y, z) -> (y, -x, -z), which maps the saddle to itself.
Mesh wedgedCube(int wedges) {
  Mesh mesh = lowerHalf(wedges);
  const Mesh upper = turned(mesh);
  const auto shift = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3d& v : upper.vertices) mesh.vertices.push_back({v[1], -v[0], -v[2]});
  for (const auto& t : upper.triangles) mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return mesh;
}

Mesh chazelleMesh() {
  return wedgedCube(4);
}

}  // namespace innersphere
