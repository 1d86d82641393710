#include "moved_solid.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace innersphere::benchmarks {
namespace {

Vec3d unit(const Vec3d& p) {
  const double length = std::hypot(p[0], p[1], p[2]);
  return {p[0] / length, p[1] / length, p[2] / length};
}

/// An octahedron, every triangle divided into four again and again, on the unit sphere.
Mesh sphereMesh(int divisions) {
  Mesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int i = 0; i < divisions; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, is_new] =
          middles.emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) {
        const Vec3d &p = mesh.vertices[a], &q = mesh.vertices[b];
        mesh.vertices.push_back(unit({p[0] + q[0], p[1] + q[1], p[2] + q[2]}));
      }
      return found->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& t : mesh.triangles) {
      const std::uint32_t a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

/// The sphere with a smaller one taken out.
Mesh shellMesh(int divisions, double thickness) {
  Mesh mesh = sphereMesh(divisions);
  const Mesh outer = mesh;
  const auto count = static_cast<std::uint32_t>(outer.vertices.size());
  for (const Vec3d& v : outer.vertices) {
    mesh.vertices.push_back({(1 - thickness) * v[0], (1 - thickness) * v[1], (1 - thickness) * v[2]});
  }
  for (const auto& t : outer.triangles) mesh.triangles.push_back({t[1] + count, t[0] + count, t[2] + count});
  return mesh;
}

/// A sphere pulled apart along the axes: a box with edges and corners rounded to a tenth of its width.
Mesh roundedBox(int divisions) {
  Mesh mesh = sphereMesh(divisions);
  for (Vec3d& v : mesh.vertices) {
    for (double& x : v) x = 0.1 * x + (x > 1e-12 ? 0.4 : x < -1e-12 ? -0.4 : 0);
  }
  return mesh;
}

}  // namespace

Vec3d MovedSolid::from(const Vec3d& p) const {
  return {(p[0] - shift_[0]) / scale_, (p[1] - shift_[1]) / scale_, (p[2] - shift_[2]) / scale_};
}

Vec3d MovedSolid::to(const Vec3d& p) const {
  return {p[0] * scale_ + shift_[0], p[1] * scale_ + shift_[1], p[2] * scale_ + shift_[2]};
}

ClosestPoint MovedSolid::closestPoint(const Vec3d& p, double cutoff) const {
  const ClosestPoint found = solid_->closestPoint(from(p), cutoff / scale_);
  return {found.distance * scale_, to(found.point)};
}

Bounds MovedSolid::bounds() const {
  const Bounds box = solid_->bounds();
  return {to(box.min), to(box.max)};
}

MassProperties MovedSolid::massProperties() const {
  MassProperties mass = solid_->massProperties();
  mass.volume *= std::pow(scale_, 3);
  mass.centre_of_mass = to(mass.centre_of_mass);
  for (double& x : mass.inertia) x *= std::pow(scale_, 5);
  return mass;
}

Mesh MovedSolid::surface() const {
  Mesh surface = solid_->surface();
  for (Vec3d& v : surface.vertices) v = to(v);
  return surface;
}

std::vector<std::pair<std::string, Mesh>> hardMeshes() {
  return {{"fine sphere mesh", sphereMesh(6)},
          {"shell, 1 % thick", shellMesh(5, 0.01)},
          {"box with rounded edges", roundedBox(6)}};
}

}  // namespace innersphere::benchmarks
