#include "outline_meshes.hpp"

#include <cmath>

#include <BulletCollision/CollisionShapes/btTriangleMesh.h>

namespace innersphere::test {

Mesh turnedMesh(const std::vector<std::array<double, 2>>& profile, std::uint32_t around) {
  const auto rings = static_cast<std::uint32_t>(profile.size() - 2);
  Mesh mesh;
  for (std::uint32_t k = 1; k <= rings; ++k) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const double angle = 2 * M_PI * i / around;
      mesh.vertices.push_back(
          {profile[k][0] * std::cos(angle), profile[k][0] * std::sin(angle), profile[k][1]});
    }
  }
  mesh.vertices.push_back({0, 0, profile.front()[1]});
  mesh.vertices.push_back({0, 0, profile.back()[1]});
  const std::uint32_t first = rings * around, last = first - around;
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t next = (i + 1) % around;
    mesh.triangles.push_back({first, next, i});
    mesh.triangles.push_back({last + i, last + next, first + 1});
    for (std::uint32_t low = 0; low < last; low += around) {
      mesh.triangles.push_back({low + i, low + next, low + around + next});
      mesh.triangles.push_back({low + i, low + around + next, low + around + i});
    }
  }
  return mesh;
}

Mesh ringMesh(const std::vector<std::array<double, 2>>& section, std::uint32_t around) {
  Mesh mesh;
  const auto rings = static_cast<std::uint32_t>(section.size());
  for (const auto& place : section) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const double angle = 2 * M_PI * i / around;
      mesh.vertices.push_back({place[0] * std::cos(angle), place[0] * std::sin(angle), place[1]});
    }
  }
  for (std::uint32_t k = 0; k < rings; ++k) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t next = (i + 1) % around, low = k * around, high = (k + 1) % rings * around;
      mesh.triangles.push_back({low + i, low + next, high + next});
      mesh.triangles.push_back({low + i, high + next, high + i});
    }
  }
  return mesh;
}

Mesh prismMesh(const std::vector<std::array<double, 2>>& outline) {
  Mesh mesh;
  for (const double y : {-0.5, 0.5}) {
    for (const auto& p : outline) mesh.vertices.push_back({p[0], y, p[1]});
  }
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, n + j, j});
    mesh.triangles.push_back({i, n + i, n + j});
  }
  for (std::uint32_t i = 1; i + 1 < n; ++i) {
    mesh.triangles.push_back({0, i, i + 1});
    mesh.triangles.push_back({n, n + i + 1, n + i});
  }
  return mesh;
}

Mesh prismBetween(const std::vector<std::array<double, 2>>& outer,
                  const std::vector<std::array<double, 2>>& inner, bool closed) {
  Mesh mesh;
  for (const double y : {-0.5, 0.5}) {
    for (const auto* outline : {&outer, &inner}) {
      for (const auto& p : *outline) mesh.vertices.push_back({p[0], y, p[1]});
    }
  }
  const auto n = static_cast<std::uint32_t>(outer.size()), back = 2 * n;
  const auto addQuad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t i = 0; i < (closed ? n : n - 1); ++i) {
    const std::uint32_t j = (i + 1) % n;
    addQuad(i, j, n + j, n + i);
    addQuad(back + i, back + n + i, back + n + j, back + j);
    addQuad(i, back + i, back + j, j);
    addQuad(n + i, n + j, back + n + j, back + n + i);
  }
  if (!closed) {
    addQuad(0, n, back + n, back);
    addQuad(n - 1, back + n - 1, back + 2 * n - 1, 2 * n - 1);
  }
  return mesh;
}

Surface surfaceOf(const Mesh& mesh) {
  Surface surface;
  for (const Vec3d& v : mesh.vertices)
    surface.vertices.push_back(
        {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])});
  surface.triangles = mesh.triangles;
  return surface;
}

void addTriangles(const Mesh& mesh, btTriangleMesh& triangles) {
  const auto corner = [&](std::uint32_t i) {
    const Vec3d& v = mesh.vertices[i];
    return btVector3(btScalar(v[0]), btScalar(v[1]), btScalar(v[2]));
  };
  for (const auto& t : mesh.triangles) triangles.addTriangle(corner(t[0]), corner(t[1]), corner(t[2]));
}

}  // namespace innersphere::test
