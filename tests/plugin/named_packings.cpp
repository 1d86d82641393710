#include "named_packings.hpp"

#include <cmath>
#include <functional>
#include <utility>

#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"
#include "test_packings.hpp"

namespace innersphere::test {
namespace {

Packing packed(const Solid& solid, std::size_t n) {
  PackOptions options;
  options.spheres = n;
  options.overlap_errors = false;
  return pack(solid, options);
}

}  // namespace

std::shared_ptr<PackingShape> makePackedShape(const Solid& solid, std::size_t n) {
  return makeShape(packed(solid, n));
}

std::shared_ptr<PackingShape> makeNamedShape(const std::string& name, std::size_t n, double bounding_radius) {
  auto shape = makePackedShape(*makeNamedSolid(name), n);
  btVector3 centre;
  btScalar radius;
  shape->getBoundingSphere(centre, radius);
  const btScalar scale = btScalar(bounding_radius) / radius;
  shape->setLocalScaling(btVector3(scale, scale, scale));
  return shape;
}

std::shared_ptr<PackingShape> makeTorusShape(double ring, double tube, std::size_t n) {
  return makePackedShape(*makeTorus(ring, tube), n);
}

namespace {

/// A tube along a curve, closed to a ring or with flat ends, of so many rings of so many vertices.
Surface roundSurface(int along, int around, bool closed, const std::function<Vec3d(double, double)>& at) {
  Surface surface;
  for (int i = 0; i < along; ++i) {
    for (int k = 0; k < around; ++k) {
      const Vec3d p = at(double(i) / (closed ? along : along - 1), 2 * M_PI * k / around);
      surface.vertices.push_back({float(p[0]), float(p[1]), float(p[2])});
    }
  }
  const auto vertex = [&](int i, int k) { return std::uint32_t(i % along * around + k % around); };
  for (int i = 0; i < (closed ? along : along - 1); ++i) {
    for (int k = 0; k < around; ++k) {
      surface.triangles.push_back({vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1)});
      surface.triangles.push_back({vertex(i, k), vertex(i + 1, k + 1), vertex(i, k + 1)});
    }
  }
  for (int k = 1; k + 1 < around && !closed; ++k) {
    surface.triangles.push_back({vertex(0, 0), vertex(0, k), vertex(0, k + 1)});
    surface.triangles.push_back({vertex(along - 1, 0), vertex(along - 1, k + 1), vertex(along - 1, k)});
  }
  return surface;
}

Surface torusSurface(int along, int around, double ring, double tube) {
  return roundSurface(along, around, true, [=](double way, double turn) {
    const double angle = 2 * M_PI * way, out = ring + tube * std::cos(turn);
    return Vec3d{out * std::cos(angle), out * std::sin(angle), tube * std::sin(turn)};
  });
}

Surface cylinderSurface(double radius, double height) {
  return roundSurface(2, 192, false, [=](double way, double turn) {
    return Vec3d{radius * std::cos(turn), radius * std::sin(turn), (0.5 - way) * height};
  });
}

std::shared_ptr<PackingShape> withSurface(const Solid& solid, std::size_t n, Surface surface) {
  Packing packing = packed(solid, n);
  packing.surface = std::move(surface);
  return makeShape(std::move(packing));
}

}  // namespace

std::shared_ptr<PackingShape> makeFineTorusShape(double ring, double tube, std::size_t n) {
  return withSurface(*makeTorus(ring, tube), n, torusSurface(192, 96, ring, tube));
}

std::shared_ptr<PackingShape> makeRingTubeShape(double ring, double tube, std::size_t n) {
  const double radius = ring + 1.5 * tube, height = 3 * tube;
  Surface surface = cylinderSurface(radius, height);
  const Surface inside = torusSurface(256, 96, ring, tube);
  const auto first = std::uint32_t(surface.vertices.size());
  surface.vertices.insert(surface.vertices.end(), inside.vertices.begin(), inside.vertices.end());
  for (const auto& [a, b, c] : inside.triangles)
    surface.triangles.push_back({first + a, first + c, first + b});
  return withSurface(*makeDifference(makeCylinder(radius, height), makeTorus(ring, tube)), n,
                     std::move(surface));
}

std::shared_ptr<PackingShape> makeFineBallShape(double radius, std::size_t n) {
  return withSurface(*makeBall(radius), n, ballSurface(radius, 64));
}

std::shared_ptr<PackingShape> makeMeshBallShape(double radius, std::size_t n) {
  const Surface surface = ballSurface(radius, 16);
  Mesh mesh;
  for (const auto& [x, y, z] : surface.vertices) mesh.vertices.push_back({double(x), double(y), double(z)});
  mesh.triangles = surface.triangles;
  return withSurface(*makeSolid(mesh, "ball"), n, surface);
}

std::shared_ptr<PackingShape> makeFineCylinderShape(double radius, double height, std::size_t n) {
  return withSurface(*makeCylinder(radius, height), n, cylinderSurface(radius, height));
}

}  // namespace innersphere::test
