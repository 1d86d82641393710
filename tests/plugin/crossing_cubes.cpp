#include "crossing_cubes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "bullet_cube.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"
#include "test_packings.hpp"

namespace innersphere::test {

std::shared_ptr<PackingShape> makeCube(const std::string& kind) {
  if (kind == "lattice") return makeShape(latticeBox({1, 1, 1}, 8));
  if (kind == "cut") {
    Packing lattice = latticeBox({1, 1, 1}, 8);
    lattice.surface = cut(cut(lattice.surface));
    return makeShape(lattice);
  }
  static std::map<std::string, Packing> packings;
  Packing& packing = packings[kind];
  if (packing.spheres.empty()) {
    PackOptions options;
    options.spheres = std::stoul(kind);
    packing = pack(*makeBox({1, 1, 1}), options);
  }
  return makeShape(packing);
}

Cubes place(const Crossing& c) {
  const btVector3 lowest(btScalar(c.along_upper), btScalar(-0.5), btScalar(-0.5));
  const btVector3 highest(btScalar(c.along_lower), btScalar(0.5), btScalar(0.5));
  const btVector3 x(1, 0, 0), z(0, 0, 1);
  const btMatrix3x3 upper(btQuaternion(x, btScalar(M_PI / 4 + c.lean_upper)));
  const btMatrix3x3 lower(btQuaternion(z, btScalar(c.angle)) *
                          btQuaternion(x, btScalar(M_PI / 4 + c.lean_lower)));
  return {btTransform(upper, z * btScalar(-c.depth) - upper * lowest),
          btTransform(lower, -(lower * highest))};
}

Escape leastEscape(const Cubes& cubes) {
  using Vector = std::array<double, 3>;
  const auto dot = [](const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  const auto axisOf = [](const btTransform& cube, int i) {
    const btVector3 axis = cube.getBasis().getColumn(i);
    return Vector{axis.x(), axis.y(), axis.z()};
  };
  Vector apart;
  for (int i = 0; i < 3; ++i)
    apart[i] = double(cubes.upper.getOrigin()[i]) - double(cubes.lower.getOrigin()[i]);
  Escape best;
  const auto test = [&](Vector axis, bool between_edges) {
    const double length = std::sqrt(dot(axis, axis));
    if (length < 1e-3) return;
    const double sign = dot(axis, apart) < 0 ? -1 : 1;
    for (double& x : axis) x *= sign / length;
    double depth = -dot(axis, apart);
    for (int i = 0; i < 3; ++i)
      depth +=
          (std::fabs(dot(axis, axisOf(cubes.upper, i))) + std::fabs(dot(axis, axisOf(cubes.lower, i)))) / 2;
    best.next = std::min(best.next, std::max(depth, best.depth));
    if (depth < best.depth) {
      best.depth = depth;
      best.between_edges = between_edges;
      best.direction = axis;
    }
  };
  for (int i = 0; i < 3; ++i) {
    test(axisOf(cubes.upper, i), false);
    test(axisOf(cubes.lower, i), false);
    for (int j = 0; j < 3; ++j) {
      const Vector a = axisOf(cubes.upper, i), b = axisOf(cubes.lower, j);
      test({a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}, true);
    }
  }
  return best;
}

std::vector<Crossing> crossings() {
  std::vector<Crossing> all;
  for (double depth : {0.005, 0.02, 0.05, 0.1, 0.17, 0.25}) {
    for (double angle : {0.8, 1.05, M_PI / 2, 1.8, 2.4}) {
      for (double lean : {-0.35, -0.15, 0.0, 0.2}) {
        for (double along : {-0.23, 0.0, 0.11, 0.3})
          all.push_back({depth, angle, lean, lean / 2 + 0.07, along, 0.1 - along / 2});
      }
    }
  }
  return all;
}

std::string describe(const Crossing& c) {
  std::ostringstream text;
  text << c.depth << " deep at " << c.angle << " rad, leaning " << c.lean_upper << " and " << c.lean_lower
       << " rad, " << c.along_upper << " and " << c.along_lower << " from the middle";
  return text.str();
}

}  // namespace innersphere::test
