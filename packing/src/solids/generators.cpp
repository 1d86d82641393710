#include "solids/generators.hpp"

#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

#include "common/steady_math.hpp"
#include "mesh/mesh_clean.hpp"

namespace innersphere {
namespace {

using PlanePoint = std::array<double, 2>;

double turn(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool isEar(const Polygon& polygon, const std::vector<std::uint32_t>& left, std::size_t i) {
  const std::size_t n = left.size();
  const PlanePoint &a = polygon[left[(i + n - 1) % n]], &b = polygon[left[i]],
                   &c = polygon[left[(i + 1) % n]];
  if (turn(a, b, c) <= 0) return false;
  for (std::uint32_t v : left) {
    const PlanePoint& p = polygon[v];
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

// The shortest new diagonal makes the better triangles.
std::size_t bestEar(const Polygon& polygon, const std::vector<std::uint32_t>& left) {
  const std::size_t n = left.size();
  std::size_t best = n;
  double shortest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const PlanePoint &a = polygon[left[(i + n - 1) % n]], &c = polygon[left[(i + 1) % n]];
    const double length = std::hypot(c[0] - a[0], c[1] - a[1]);
    if ((best == n || length < shortest) && isEar(polygon, left, i)) {
      best = i;
      shortest = length;
    }
  }
  assert(best < n);
  return best;
}

}  // namespace

Ring circle(double radius, double z, int n) {
  Ring ring;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    ring.push_back({radius * steady::cos(angle), radius * steady::sin(angle), z});
  }
  return ring;
}

Ring lifted(const Polygon& polygon, double z) {
  Ring ring;
  for (const PlanePoint& p : polygon) ring.push_back({p[0], p[1], z});
  return ring;
}

std::vector<std::array<std::uint32_t, 3>> triangulate(const Polygon& polygon) {
  std::vector<std::uint32_t> left(polygon.size());
  std::iota(left.begin(), left.end(), 0u);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  while (left.size() > 3) {
    const std::size_t n = left.size();
    const std::size_t i = bestEar(polygon, left);
    triangles.push_back({left[(i + n - 1) % n], left[i], left[(i + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

Mesh loft(const std::vector<Ring>& rings, bool closed) {
  Mesh mesh;
  std::vector<std::uint32_t> first;
  for (const Ring& ring : rings) {
    first.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.insert(mesh.vertices.end(), ring.begin(), ring.end());
  }
  const auto join = [&](std::size_t a, std::size_t b) {
    const auto na = static_cast<std::uint32_t>(rings[a].size());
    const auto nb = static_cast<std::uint32_t>(rings[b].size());
    for (std::uint32_t i = 0; i < std::max(na, nb); ++i) {
      const std::uint32_t a0 = first[a] + i % na, a1 = first[a] + (i + 1) % na;
      const std::uint32_t b0 = first[b] + i % nb, b1 = first[b] + (i + 1) % nb;
      if (na > 1) mesh.triangles.push_back({a0, a1, b1});
      if (nb > 1) mesh.triangles.push_back({a0, b1, b0});
    }
  };
  for (std::size_t r = 0; r + 1 < rings.size(); ++r) join(r, r + 1);
  if (closed) {
    join(rings.size() - 1, 0);
    return mesh;
  }
  const auto close = [&](std::size_t r, bool upwards) {
    if (rings[r].size() == 1) return;
    Polygon polygon;
    for (const Vec3d& p : rings[r]) polygon.push_back({p[0], p[1]});
    for (auto t : triangulate(polygon)) {
      if (!upwards) flip(t);
      mesh.triangles.push_back({first[r] + t[0], first[r] + t[1], first[r] + t[2]});
    }
  };
  close(0, false);
  close(rings.size() - 1, true);
  return mesh;
}

Mesh turned(Mesh mesh) {
  for (auto& t : mesh.triangles) flip(t);
  return mesh;
}

}  // namespace innersphere
