#include "named_packings.hpp"

#include <cmath>
#include <functional>
#include <utility>

#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"
#include "test_packings.hpp"

namespace innersphere::test {

std::shared_ptr<PackingShape> makeNamedShape(const std::string& name, std::size_t n, double bounding_radius) {
  PackOptions options;
  options.spheres = n;
  options.overlap_errors = false;
  auto shape = makeShape(pack(*makeNamedSolid(name), options));
  btVector3 centre;
  btScalar radius;
  shape->getBoundingSphere(centre, radius);
  const btScalar scale = btScalar(bounding_radius) / radius;
  shape->setLocalScaling(btVector3(scale, scale, scale));
  return shape;
}

std::shared_ptr<PackingShape> makeTorusShape(double ring, double tube, std::size_t n) {
  PackOptions options;
  options.spheres = n;
  options.overlap_errors = false;
  return makeShape(pack(*makeTorus(ring, tube), options));
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

std::shared_ptr<PackingShape> withSurface(const Solid& solid, std::size_t n, Surface surface) {
  PackOptions options;
  options.spheres = n;
  options.overlap_errors = false;
  Packing packing = pack(solid, options);
  packing.surface = std::move(surface);
  return makeShape(std::move(packing));
}

}  // namespace

std::shared_ptr<PackingShape> makeFineTorusShape(double ring, double tube, std::size_t n) {
  return withSurface(*makeTorus(ring, tube), n, roundSurface(192, 96, true, [=](double along, double around) {
    const double turn = 2 * M_PI * along, out = ring + tube * std::cos(around);
    return Vec3d{out * std::cos(turn), out * std::sin(turn), tube * std::sin(around)};
  }));
}

std::shared_ptr<PackingShape> makeFineBallShape(double radius, std::size_t n) {
  return withSurface(*makeBall(radius), n, singleBall(radius).surface);
}

std::shared_ptr<PackingShape> makeFineCylinderShape(double radius, double height, std::size_t n) {
  return withSurface(
      *makeCylinder(radius, height), n, roundSurface(2, 192, false, [=](double along, double around) {
        return Vec3d{radius * std::cos(around), radius * std::sin(around), (0.5 - along) * height};
      }));
}

}  // namespace innersphere::test
