// What a clean closed mesh has to satisfy, judged by brute force.
#pragma once

#include <algorithm>
#include <map>
#include <set>

#include "innersphere/mesh.hpp"

namespace innersphere::test {

/// True if each directed edge is used once and its opposite once.
inline bool isClosedManifold(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [edge, count] : uses) {
    if (count != 1 || !uses.count({edge.second, edge.first})) return false;
  }
  return true;
}

/// True if each directed edge is used as often as its opposite: sheets may touch along edges.
inline bool isClosed(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> surplus;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t i = t[k], j = t[(k + 1) % 3];
      surplus[std::minmax(i, j)] += i < j ? 1 : -1;
    }
  }
  return std::all_of(surplus.begin(), surplus.end(), [](const auto& edge) { return edge.second == 0; });
}

/// Vertices - edges + triangles: 2 for a ball, 0 for a torus.
inline long eulerCharacteristic(const Mesh& mesh) {
  std::set<std::uint32_t> vertices;
  for (const auto& t : mesh.triangles) vertices.insert(t.begin(), t.end());
  const auto triangles = static_cast<long>(mesh.triangles.size());
  return static_cast<long>(vertices.size()) - 3 * triangles / 2 + triangles;
}

/// Volume by summing tetrahedra, in long double.
inline double volumeOf(const Mesh& mesh) {
  long double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    using L = long double;
    sum += L(a[0]) * (L(b[1]) * c[2] - L(b[2]) * c[1]) + L(a[1]) * (L(b[2]) * c[0] - L(b[0]) * c[2]) +
           L(a[2]) * (L(b[0]) * c[1] - L(b[1]) * c[0]);
  }
  return static_cast<double>(sum / 6);
}

/// Pairs of triangles that cut each other: an edge of one passes through the other, away from common corners.
inline std::size_t selfIntersections(const Mesh& mesh) {
  const auto minus = [](const Vec3d& a, const Vec3d& b) {
    return Vec3d{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  };
  const auto det = [](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  };
  const auto& v = mesh.vertices;
  const auto pierces = [&](const auto& s, const auto& t) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t i = s[k], j = s[(k + 1) % 3];
      if (std::count(t.begin(), t.end(), i) || std::count(t.begin(), t.end(), j)) continue;
      const Vec3d d = minus(v[j], v[i]);
      const Vec3d a = minus(v[t[0]], v[i]), b = minus(v[t[1]], v[i]), c = minus(v[t[2]], v[i]);
      const double from = det(a, b, c);
      const double to = det(minus(a, d), minus(b, d), minus(c, d));
      const double u = det(d, a, b), w = det(d, b, c), x = det(d, c, a);
      constexpr double tiny = 1e-12;
      const bool through = (from > tiny && to < -tiny) || (from < -tiny && to > tiny);
      const bool within = (u > tiny && w > tiny && x > tiny) || (u < -tiny && w < -tiny && x < -tiny);
      if (through && within) return true;
    }
    return false;
  };
  struct Span {
    double low, high;
    std::size_t triangle;
  };
  std::vector<std::array<std::array<double, 2>, 3>> box;
  std::vector<Span> spans;
  for (const auto& t : mesh.triangles) {
    std::array<std::array<double, 2>, 3> range;
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({v[t[0]][k], v[t[1]][k], v[t[2]][k]});
      range[k] = {low, high};
    }
    spans.push_back({range[0][0], range[0][1], box.size()});
    box.push_back(range);
  }
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.low < b.low; });
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    for (std::size_t j = i + 1; j < spans.size() && spans[j].low <= spans[i].high; ++j) {
      const auto &p = box[spans[i].triangle], &q = box[spans[j].triangle];
      if (p[1][0] > q[1][1] || q[1][0] > p[1][1] || p[2][0] > q[2][1] || q[2][0] > p[2][1]) continue;
      const auto &s = mesh.triangles[spans[i].triangle], &t = mesh.triangles[spans[j].triangle];
      pairs += pierces(s, t) || pierces(t, s);
    }
  }
  return pairs;
}

}  // namespace innersphere::test
