// Small meshes for tests, made without the code under test.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "innersphere/mesh.hpp"

namespace innersphere::test {

/// An axis-aligned box from `low` to `high`, wound outwards.
inline Mesh boxMesh(const Vec3d& low = {-0.5, -0.5, -0.5}, const Vec3d& high = {0.5, 0.5, 0.5}) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back({i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A torus about the z axis with n x m quads, wound outwards.
inline Mesh torusMesh(double ring, double tube, int n, int m) {
  Mesh mesh;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const double u = 2 * std::numbers::pi * i / n;
      const double v = 2 * std::numbers::pi * j / m;
      const double r = ring + tube * std::cos(v);
      mesh.vertices.push_back({r * std::cos(u), r * std::sin(u), tube * std::sin(v)});
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i % n * m + j % m); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

inline void append(Mesh& mesh, const Mesh& more) {
  const auto shift = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& t : more.triangles) mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
}

inline Mesh inverted(Mesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  return mesh;
}

inline Vec3d randomPoint(std::mt19937& random, const Vec3d& low, const Vec3d& high) {
  Vec3d p;
  for (int k = 0; k < 3; ++k) p[k] = std::uniform_real_distribution<double>(low[k], high[k])(random);
  return p;
}

}  // namespace innersphere::test
