#include "shapes.hpp"

#include <cmath>
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

}  // namespace innersphere::demo
