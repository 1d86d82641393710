#include "bullet_cube.hpp"

#include <array>
#include <map>

#include "test_packings.hpp"

namespace innersphere::test {

Surface cut(const Surface& surface) {
  Surface result;
  std::map<std::array<float, 3>, std::uint32_t> known;
  const auto vertex = [&](const std::array<float, 3>& place) {
    const auto [at, fresh] = known.try_emplace(place, static_cast<std::uint32_t>(known.size()));
    if (fresh) result.vertices.push_back(place);
    return at->second;
  };
  for (const auto& t : surface.triangles) {
    std::uint32_t corners[3], middles[3];
    for (int k = 0; k < 3; ++k) {
      const auto &p = surface.vertices[t[k]], &q = surface.vertices[t[(k + 1) % 3]];
      corners[k] = vertex(p);
      middles[k] = vertex({(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2});
    }
    for (int k = 0; k < 3; ++k) result.triangles.push_back({corners[k], middles[k], middles[(k + 2) % 3]});
    result.triangles.push_back({middles[0], middles[1], middles[2]});
  }
  return result;
}

BulletCube::BulletCube(const std::string& kind) {
  const btScalar h = btScalar(0.5);
  if (kind == "packing") {
    shape = makeShape(latticeBox({1, 1, 1}, 8));
    return;
  }
  if (kind == "box") {
    shape = std::make_shared<btBoxShape>(btVector3(h, h, h));
  } else if (kind == "hull") {
    auto hull = std::make_shared<btConvexHullShape>();
    for (int i = 0; i < 8; ++i) hull->addPoint(btVector3(i & 1 ? h : -h, i & 2 ? h : -h, i & 4 ? h : -h));
    shape = hull;
  } else {
    Surface surface = latticeBox({1, 1, 1}, 1).surface;
    if (kind == "cut_mesh") surface = cut(cut(surface));
    const auto corner = [&](std::uint32_t v) {
      const auto& p = surface.vertices[v];
      return btVector3(p[0], p[1], p[2]);
    };
    for (const auto& t : surface.triangles) {
      const bool inside_out = kind == "inside_out_mesh";
      mesh_.addTriangle(corner(t[0]), corner(t[inside_out ? 2 : 1]), corner(t[inside_out ? 1 : 2]));
    }
    shape = std::make_shared<btBvhTriangleMeshShape>(&mesh_, true);
  }
  shape->setMargin(0);
}

}  // namespace innersphere::test
