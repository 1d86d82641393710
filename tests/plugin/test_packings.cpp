#include "test_packings.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace innersphere::test {
namespace {

Surface boxSurface(const Vec3d& size) {
  Surface s;
  for (int i = 0; i < 8; ++i) {
    s.vertices.push_back({static_cast<float>((i & 1 ? 0.5 : -0.5) * size[0]),
                          static_cast<float>((i & 2 ? 0.5 : -0.5) * size[1]),
                          static_cast<float>((i & 4 ? 0.5 : -0.5) * size[2])});
  }
  s.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return s;
}

}  // namespace

Packing latticeBox(const Vec3d& size, int n) {
  Packing p;
  const double r = 0.5 * std::min({size[0], size[1], size[2]}) / n;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        p.spheres.push_back({static_cast<float>(((i + 0.5) / n - 0.5) * size[0]),
                             static_cast<float>(((j + 0.5) / n - 0.5) * size[1]),
                             static_cast<float>(((k + 0.5) / n - 0.5) * size[2]),
                             static_cast<float>(r * 0.999999)});
      }
    }
  }
  p.surface = boxSurface(size);
  p.solid.volume = size[0] * size[1] * size[2];
  for (int i = 0; i < 3; ++i) {
    const double a = size[(i + 1) % 3], b = size[(i + 2) % 3];
    p.solid.inertia[4 * i] = p.solid.volume * (a * a + b * b) / 12;
  }
  return p;
}

Surface ballSurface(double radius, std::uint32_t rings) {
  Surface surface;
  const std::uint32_t segments = 2 * rings;
  const auto vertex = [&](std::uint32_t ring, std::uint32_t segment) {
    return ring == 0 ? 0 : ring == rings ? 1 : 2 + (ring - 1) * segments + segment % segments;
  };
  surface.vertices = {{0, 0, static_cast<float>(radius)}, {0, 0, static_cast<float>(-radius)}};
  for (std::uint32_t i = 1; i < rings; ++i) {
    for (std::uint32_t j = 0; j < segments; ++j) {
      const double polar = M_PI * i / rings, azimuth = 2 * M_PI * j / segments;
      surface.vertices.push_back({static_cast<float>(radius * std::sin(polar) * std::cos(azimuth)),
                                  static_cast<float>(radius * std::sin(polar) * std::sin(azimuth)),
                                  static_cast<float>(radius * std::cos(polar))});
    }
  }
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t j = 0; j < segments; ++j) {
      const std::uint32_t a = vertex(i, j), b = vertex(i, j + 1), c = vertex(i + 1, j),
                          d = vertex(i + 1, j + 1);
      if (i > 0) surface.triangles.push_back({a, c, b});
      if (i + 1 < rings) surface.triangles.push_back({b, c, d});
    }
  }
  return surface;
}

Packing singleBall(double radius) {
  Packing p;
  p.spheres.push_back({0, 0, 0, static_cast<float>(radius)});
  p.solid.volume = 4.0 / 3.0 * M_PI * std::pow(radius, 3);
  for (int i = 0; i < 3; ++i) p.solid.inertia[4 * i] = 0.4 * radius * radius * p.solid.volume;
  p.surface = ballSurface(radius, 64);
  return p;
}

Packing withoutSurface(Packing packing) {
  packing.surface = {};
  return packing;
}

Packing moved(Packing packing, const Vec3d& offset) {
  for (Sphere& s : packing.spheres) {
    s.x += static_cast<float>(offset[0]);
    s.y += static_cast<float>(offset[1]);
    s.z += static_cast<float>(offset[2]);
  }
  for (auto& v : packing.surface.vertices) {
    for (int i = 0; i < 3; ++i) v[i] += static_cast<float>(offset[i]);
  }
  for (int i = 0; i < 3; ++i) packing.solid.centre_of_mass[i] += offset[i];
  return packing;
}

std::shared_ptr<PackingShape> makeShape(Packing packing) {
  return std::make_shared<PackingShape>(
      std::make_shared<CollisionModel>(std::make_shared<const Packing>(std::move(packing))));
}

}  // namespace innersphere::test
