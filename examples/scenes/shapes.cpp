#include "shapes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

namespace innersphere::demo {

std::uint32_t Outline::add(const Point2& point) {
  points.push_back(point);
  return static_cast<std::uint32_t>(points.size() - 1);
}

void Outline::addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  triangles.push_back({a, b, c});
  triangles.push_back({a, c, d});
}

Outline ringOutline(const std::vector<Point2>& outer, const std::vector<Point2>& inner) {
  Outline outline;
  const auto n = static_cast<std::uint32_t>(outer.size());
  for (const Point2& p : outer) outline.add(p);
  for (const Point2& p : inner) outline.add(p);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    outline.addQuad(i, next, n + next, n + i);
  }
  return outline;
}

Outline gridOutline(const std::vector<double>& xs, const std::vector<double>& ys,
                    const std::vector<std::string>& cells) {
  Outline outline;
  std::map<std::pair<std::size_t, std::size_t>, std::uint32_t> corners;
  const auto corner = [&](std::size_t x, std::size_t y) {
    const auto [entry, is_new] = corners.try_emplace({x, y}, 0);
    if (is_new) entry->second = outline.add({xs[x], ys[y]});
    return entry->second;
  };
  for (std::size_t row = 0; row < cells.size(); ++row) {
    const std::size_t y = cells.size() - 1 - row;
    for (std::size_t x = 0; x < cells[row].size(); ++x) {
      if (cells[row][x] != '#') continue;
      const std::uint32_t a = corner(x, y), b = corner(x + 1, y), c = corner(x + 1, y + 1);
      outline.addQuad(a, b, c, corner(x, y + 1));
    }
  }
  return outline;
}

std::vector<Point2> circlePoints(double radius, int n) {
  std::vector<Point2> points;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return points;
}

Mesh prism(const Outline& outline, double height) {
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(outline.points.size());
  for (const double z : {0.0, height}) {
    for (const Point2& p : outline.points) mesh.vertices.push_back({p[0], p[1], z});
  }
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : outline.triangles) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({n + t[0], n + t[1], n + t[2]});
    for (int k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
  }
  for (const auto& [a, b] : edges) {
    if (edges.count({b, a}) != 0) continue;  // inside
    mesh.triangles.push_back({a, b, n + b});
    mesh.triangles.push_back({a, n + b, n + a});
  }
  return mesh;
}

Mesh lathe(const std::vector<Point2>& profile, int around) {
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(around);
  const auto inner = static_cast<std::uint32_t>(profile.size() - 2);  // points off the axis
  for (std::uint32_t k = 1; k <= inner; ++k) {
    for (const Point2& p : circlePoints(profile[k][0], around)) {
      mesh.vertices.push_back({p[0], p[1], profile[k][1]});
    }
  }
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({0, 0, profile.front()[1]});
  mesh.vertices.push_back({0, 0, profile.back()[1]});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    mesh.triangles.push_back({first, next, i});
    for (std::uint32_t k = 0; k + 1 < inner; ++k) {
      const std::uint32_t low = k * n, high = (k + 1) * n;
      mesh.triangles.push_back({low + i, low + next, high + next});
      mesh.triangles.push_back({low + i, high + next, high + i});
    }
    const std::uint32_t last = (inner - 1) * n;
    mesh.triangles.push_back({last + i, last + next, first + 1});
  }
  return mesh;
}

Mesh tube(const std::vector<Point2>& path, const std::vector<double>& radii, int around, bool closed) {
  Mesh mesh;
  const std::size_t count = path.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Point2& before = path[k > 0 ? k - 1 : closed ? count - 1 : 0];
    const Point2& after = path[k + 1 < count ? k + 1 : closed ? 0 : k];
    const double length = std::hypot(after[0] - before[0], after[1] - before[1]);
    const Point2 across{(after[1] - before[1]) / length, (before[0] - after[0]) / length};
    for (const Point2& p : circlePoints(radii[k], around)) {
      mesh.vertices.push_back({path[k][0] + p[0] * across[0], path[k][1] + p[0] * across[1], p[1]});
    }
  }
  const auto n = static_cast<std::uint32_t>(around), rings = static_cast<std::uint32_t>(count);
  for (std::uint32_t k = 0; k + (closed ? 0 : 1) < rings; ++k) {
    const std::uint32_t low = k * n, high = (k + 1) % rings * n;
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t next = (i + 1) % n;
      mesh.triangles.push_back({low + i, high + next, low + next});
      mesh.triangles.push_back({low + i, high + i, high + next});
    }
  }
  for (std::uint32_t i = 1; i + 1 < n && !closed; ++i) {
    const std::uint32_t last = (rings - 1) * n;
    mesh.triangles.push_back({0, i, i + 1});
    mesh.triangles.push_back({last, last + i + 1, last + i});
  }
  return mesh;
}

Mesh lump(const std::function<double(const Vec3d&)>& radius, int times) {
  Mesh mesh;
  mesh.vertices = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}};
  for (int cut = 0; cut < times; ++cut) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), 0);
      if (!is_new) return entry->second;
      const Vec3d &p = mesh.vertices[a], &q = mesh.vertices[b];
      const Vec3d sum{p[0] + q[0], p[1] + q[1], p[2] + q[2]};
      const double length = std::hypot(sum[0], sum[1], sum[2]);
      mesh.vertices.push_back({sum[0] / length, sum[1] / length, sum[2] / length});
      return entry->second = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    };
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      triangles.insert(triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(triangles);
  }
  for (Vec3d& v : mesh.vertices) {
    const double r = radius(v);
    v = {r * v[0], r * v[1], r * v[2]};
  }
  return mesh;
}

void append(Mesh& mesh, const Mesh& other, const std::function<Vec3d(const Vec3d&)>& map) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3d& v : other.vertices) mesh.vertices.push_back(map(v));
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
}

}  // namespace innersphere::demo
