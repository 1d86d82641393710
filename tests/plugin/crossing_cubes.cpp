#include "crossing_cubes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "bullet_cube.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

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
    options.overlap_errors = false;
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

ContactOptions rigidContacts() {
  ContactOptions options;
  options.response = Response::rigid;
  return options;
}

int expectLeastPushes(const std::shared_ptr<btCollisionShape>& upper,
                      const std::shared_ptr<btCollisionShape>& lower, double deepest) {
  const btTransform turn(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)));
  int count = 0;
  for (const Crossing& crossing : crossings()) {
    Cubes cubes = place(crossing);
    cubes = {turn * cubes.upper, turn * cubes.lower};
    const Escape escape = leastEscape(cubes);
    if (!escape.between_edges || escape.next < 1.2 * escape.depth || crossing.depth > deepest) continue;
    SCOPED_TRACE(describe(crossing));
    ++count;
    TestWorld world(rigidContacts());
    world.add(lower, 0, cubes.lower.getOrigin(), cubes.lower.getRotation());
    world.add(upper, 1, cubes.upper.getOrigin(), cubes.upper.getRotation());
    world.world.performDiscreteCollisionDetection();
    const auto points = world.contactsOfLast();
    EXPECT_GE(points.size(), 1u);
    if (points.empty()) continue;
    EXPECT_NEAR(-points[0].getDistance(), escape.depth, 1e-4);
    const btVector3& normal = points[0].m_normalWorldOnB;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(normal[i], escape.direction[i], 1e-3);
    // What else touches pushes the same way, or not at all.
    for (const btManifoldPoint& point : points) {
      EXPECT_TRUE(point.getDistance() > 0 || point.m_normalWorldOnB.dot(normal) > btScalar(0.95));
    }
  }
  return count;
}

void expectDepthsOfTwiceTheSize(const std::shared_ptr<btCollisionShape>& upper,
                                const std::shared_ptr<btCollisionShape>& lower, double margins) {
  constexpr btScalar kScale = 2;
  for (const auto& shape : {upper, lower}) shape->setLocalScaling(btVector3(kScale, kScale, kScale));
  for (const double depth : {-0.005, 0.02, 0.1}) {
    const Cubes cubes = place({depth, 1.3, 0.1, -0.2, 0.1, 0.05});
    TestWorld world(rigidContacts());
    world.add(lower, 0, cubes.lower.getOrigin() * kScale, cubes.lower.getRotation());
    world.add(upper, 1, cubes.upper.getOrigin() * kScale, cubes.upper.getRotation());
    world.world.performDiscreteCollisionDetection();
    const auto points = world.contactsOfLast();
    ASSERT_GE(points.size(), 1u) << depth;
    EXPECT_NEAR(-points[0].getDistance(), depth * kScale + margins, 1e-4);
    EXPECT_GT(points[0].m_normalWorldOnB.z(), 0.9999) << depth;
  }
}

void expectGuidedCubeIsCarried(const std::shared_ptr<btCollisionShape>& upper,
                               const std::shared_ptr<btCollisionShape>& lower) {
  for (const double lean : {0.0, 0.2}) {
    const Cubes cubes = place({-0.05, 1.3, lean, -lean, 0.1, 0.05});
    TestWorld world;
    world.add(lower, 0, cubes.lower.getOrigin(), cubes.lower.getRotation());
    btRigidBody& cube = world.add(upper, 1, cubes.upper.getOrigin(), cubes.upper.getRotation());
    cube.setLinearFactor(btVector3(0, 0, 1));
    cube.setAngularFactor(0);
    const auto depth = [&] { return leastEscape(Cubes{cube.getWorldTransform(), cubes.lower}).depth; };
    double deepest = 0;
    for (int i = 0; i < 480; ++i) {
      world.run(1.0 / 240, 1.0 / 240);
      deepest = std::max(deepest, depth());
    }
    EXPECT_LT(deepest, 0.01);
    EXPECT_NEAR(depth(), 0, 0.002);
    EXPECT_NEAR(cube.getLinearVelocity().z(), 0, 1e-3);
  }
}

}  // namespace innersphere::test
