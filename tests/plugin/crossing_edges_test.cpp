// Two cubes of which an edge of the one crosses an edge of the other bear on each other there, however deep
// they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

/// Each triangle in four.
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

/// A cube of 1 m: spheres on a grid, the same with edges in four pieces, or packed as many as `kind` says.
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

/// How the lowest edge of a cube crosses the highest of another, both about level.
struct Crossing {
  double depth;                     ///< [m]
  double angle;                     ///< between the edges [rad]
  double lean_upper, lean_lower;    ///< of the diagonals that stand on the edges [rad]
  double along_upper, along_lower;  ///< from the middles of the edges [m]
};

struct Cubes {
  btTransform upper, lower;
};

/// The upper cube's edge lies along x.
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

/// The shortest way that takes the upper cube out of the lower one, by the theorem of separating axes.
struct Escape {
  double depth = 1e9;  ///< [m], negative if the cubes are apart
  double next = 1e9;   ///< along the second best axis
  bool between_edges = false;
  std::array<double, 3> direction{};  ///< unit
};

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

/// Of the body that was added last, and the one before.
Escape leastEscape(const TestWorld& world) {
  const std::size_t count = world.bodies.size();
  return leastEscape(
      {world.bodies[count - 1]->getWorldTransform(), world.bodies[count - 2]->getWorldTransform()});
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

class CrossingEdges : public testing::TestWithParam<std::string> {
 protected:
  static ContactOptions rigid() {
    ContactOptions options;
    options.response = Response::rigid;  // its contacts have their true depths
    return options;
  }
};

TEST_P(CrossingEdges, PushOneWayThatIsTheLeast) {
  const auto shape = makeCube(GetParam());
  const btTransform turn(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)));
  int count = 0;
  for (const Crossing& crossing : crossings()) {
    Cubes cubes = place(crossing);
    cubes = {turn * cubes.upper, turn * cubes.lower};
    const Escape escape = leastEscape(cubes);
    if (!escape.between_edges || escape.next < 1.2 * escape.depth) continue;
    SCOPED_TRACE(describe(crossing));
    ++count;
    TestWorld world(rigid());
    world.add(shape, 0, cubes.lower.getOrigin(), cubes.lower.getRotation());
    world.add(shape, 1, cubes.upper.getOrigin(), cubes.upper.getRotation());
    world.world.performDiscreteCollisionDetection();
    const auto points = world.contactsOfLast();
    ASSERT_GE(points.size(), 1u);
    EXPECT_NEAR(-points[0].getDistance(), escape.depth, 1e-4);
    const btVector3& normal = points[0].m_normalWorldOnB;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(normal[i], escape.direction[i], 1e-3);
    // What else touches pushes the same way, or not at all.
    for (const btManifoldPoint& point : points) {
      EXPECT_TRUE(point.getDistance() > 0 || point.m_normalWorldOnB.dot(normal) > btScalar(0.95));
    }
  }
  EXPECT_GT(count, 400);
}

TEST_P(CrossingEdges, GrowWithScaleAndMargin) {
  constexpr double kScale = 2, kMargin = 0.01;
  const auto shape = makeCube(GetParam());
  shape->setLocalScaling(btVector3(1, 1, 1) * btScalar(kScale));
  shape->setMargin(btScalar(kMargin));
  for (const double depth : {-0.005, 0.02, 0.1}) {
    const Cubes cubes = place({depth, 1.3, 0.1, -0.2, 0.1, 0.05});
    TestWorld world(rigid());
    world.add(shape, 0, cubes.lower.getOrigin() * btScalar(kScale), cubes.lower.getRotation());
    world.add(shape, 1, cubes.upper.getOrigin() * btScalar(kScale), cubes.upper.getRotation());
    world.world.performDiscreteCollisionDetection();
    const auto points = world.contactsOfLast();
    ASSERT_GE(points.size(), 1u) << depth;
    EXPECT_NEAR(-points[0].getDistance(), depth * kScale + 2 * kMargin, 1e-4);
    EXPECT_GT(points[0].m_normalWorldOnB.z(), 0.9999) << depth;
  }
}

TEST_P(CrossingEdges, CarryACubeThatIsGuided) {
  const auto shape = makeCube(GetParam());
  for (const double lean : {0.0, 0.2}) {
    const Cubes cubes = place({-0.05, 1.3, lean, -lean, 0.1, 0.05});
    TestWorld world;
    world.add(shape, 0, cubes.lower.getOrigin(), cubes.lower.getRotation());
    btRigidBody& cube = world.add(shape, 1, cubes.upper.getOrigin(), cubes.upper.getRotation());
    cube.setLinearFactor(btVector3(0, 0, 1));
    cube.setAngularFactor(0);
    double deepest = 0;
    for (int i = 0; i < 480; ++i) {
      world.run(1.0 / 240, 1.0 / 240);
      deepest = std::max(deepest, leastEscape(world).depth);
    }
    EXPECT_LT(deepest, 0.01);
    EXPECT_NEAR(leastEscape(world).depth, 0, 0.002);
    EXPECT_NEAR(cube.getLinearVelocity().z(), 0, 1e-3);
  }
}

TEST_P(CrossingEdges, LetACubeTipToItsHeavySide) {
  const auto shape = makeCube(GetParam());
  for (const double along : {-0.2, 0.2}) {
    const Cubes cubes = place({-0.02, M_PI / 2, 0.0, 0.0, along, 0.0});
    TestWorld world;
    world.add(shape, 0, cubes.lower.getOrigin(), cubes.lower.getRotation());
    btRigidBody& cube = world.add(shape, 1, cubes.upper.getOrigin(), cubes.upper.getRotation());
    double deepest = 0;
    for (int i = 0; i < 240; ++i) {
      world.run(1.0 / 240, 1.0 / 240);
      deepest = std::max(deepest, leastEscape(world).depth);
    }
    EXPECT_LT(deepest, 0.01);
    EXPECT_LT(cube.getWorldTransform().getOrigin().z(), 0);
    EXPECT_LT(cube.getWorldTransform().getOrigin().x() * along, 0);
    EXPECT_NEAR(cube.getWorldTransform().getOrigin().y(), 0, 0.02);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, CrossingEdges, testing::Values("lattice", "cut", "500", "4000"));

/// An L of arms 1.2 m long and 0.4 m thick in the plane of x and y, 1 m wide, of spheres on a grid. Its inner
/// edge is at the origin.
Packing latticeAngle() {
  constexpr int kCells = 12, kWide = 10;
  Packing p;
  const auto place = [](int cell) { return static_cast<float>(0.1 * (cell + 0.5) - 0.4); };
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      for (int k = 0; k < kWide && (i < 4 || j < 4); ++k)
        p.spheres.push_back({place(i), place(j), place(k) - 0.1F, 0.05F});
    }
  }
  const float outline[6][2] = {{-0.4F, -0.4F}, {0.8F, -0.4F}, {0.8F, 0}, {0, 0}, {0, 0.8F}, {-0.4F, 0.8F}};
  for (const float z : {-0.5F, 0.5F}) {
    for (const auto& corner : outline) p.surface.vertices.push_back({corner[0], corner[1], z});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t next = (i + 1) % 6;
    p.surface.triangles.push_back({i, next, next + 6});
    p.surface.triangles.push_back({i, next + 6, i + 6});
  }
  for (const auto& t : {std::array<std::uint32_t, 3>{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}) {
    p.surface.triangles.push_back({t[0], t[2], t[1]});
    p.surface.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
  }
  p.solid.volume = 0.8;
  for (int i = 0; i < 3; ++i) p.solid.inertia[4 * i] = 0.1;
  return p;
}

class CrossingEdgesOfAnAngle : public CrossingEdges {
 protected:
  /// Contacts of a cube with an edge across the diagonal (1, 1, 0) through `place`, whose own diagonal points
  /// down it.
  std::vector<btManifoldPoint> contactsOfCube(const btVector3& place) {
    const btVector3 out = btVector3(1, 1, 0).normalized(), across = btVector3(1, -1, 0).normalized();
    const btVector3 axis(0, 0, 1);
    // Columns: along the edge, and its faces' normals.
    const btVector3 one = (out - axis).normalized(), other = (out + axis).normalized();
    const btMatrix3x3 axes(across.x(), one.x(), other.x(), across.y(), one.y(), other.y(), across.z(),
                           one.z(), other.z());
    btQuaternion turn;
    axes.getRotation(turn);
    TestWorld world(rigid());
    world.add(makeShape(latticeAngle()), 0, btVector3(0, 0, 0));
    world.add(makeCube(GetParam()), 1, place + axes * btVector3(0, btScalar(0.5), btScalar(0.5)), turn);
    world.world.performDiscreteCollisionDetection();
    return world.contactsOfLast();
  }
};

TEST_P(CrossingEdgesOfAnAngle, BearAtAnOuterEdge) {
  for (const double depth : {0.005, 0.03, 0.1}) {
    const btScalar inwards = btScalar(depth / std::sqrt(2));
    const auto points = contactsOfCube(btVector3(btScalar(0.8) - inwards, -inwards, btScalar(0.03)));
    ASSERT_GE(points.size(), 1u) << depth;
    EXPECT_NEAR(points[0].getDistance(), -depth, 1e-4);
    EXPECT_GT(points[0].m_normalWorldOnB.dot(btVector3(1, 1, 0).normalized()), 0.9999) << depth;
  }
}

TEST_P(CrossingEdgesOfAnAngle, DoNotBearInTheInnerOne) {
  // The edge spans the corner, and its ends are in the faces.
  const btScalar depth = btScalar(0.01);
  const btScalar half = btScalar(0.5 * std::sqrt(0.5));
  const auto points = contactsOfCube(btVector3(half - depth, half - depth, btScalar(0.03)));
  ASSERT_GE(points.size(), 2u);
  for (const btManifoldPoint& point : points) {
    const btVector3& normal = point.m_normalWorldOnB;
    EXPECT_LT((normal.x() + normal.y()) / std::sqrt(2), 0.72);
  }
  for (int i = 0; i < 2; ++i) {
    const btVector3& normal = points[i].m_normalWorldOnB;
    EXPECT_GT(std::max(normal.x(), normal.y()), 0.999);
    EXPECT_NEAR(points[i].getDistance(), -depth, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, CrossingEdgesOfAnAngle, testing::Values("lattice", "500", "4000"));

}  // namespace
}  // namespace innersphere::test
