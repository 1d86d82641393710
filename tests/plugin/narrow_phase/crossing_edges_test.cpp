// Two cubes of which an edge of the one crosses an edge of the other bear on each other there, however deep
// they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "crossing_cubes.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

/// Of the body that was added last, and the one before.
Escape leastEscape(const TestWorld& world) {
  const std::size_t count = world.bodies.size();
  return leastEscape(
      Cubes{world.bodies[count - 1]->getWorldTransform(), world.bodies[count - 2]->getWorldTransform()});
}

class CrossingEdges : public testing::TestWithParam<std::string> {};

TEST_P(CrossingEdges, PushOneWayThatIsTheLeast) {
  const auto shape = makeCube(GetParam());
  EXPECT_GT(expectLeastPushes(shape, shape, 1), 400);
}

/// The corner of a cube in the face of another, where no faces lie on each other.
TEST_P(CrossingEdges, LeaveCornersToTheFacesTheyAreIn) {
  const auto shape = makeCube(GetParam());
  const btVector3 corner(btScalar(0.5), btScalar(0.5), btScalar(0.5));
  int count = 0;
  for (const double lean : {0.3, 0.55, 0.8}) {
    for (const double turn : {0.0, 0.4, 0.8, 1.2}) {
      for (const double x : {-0.45, -0.2, 0.3, 0.47}) {
        for (const double depth : {0.003, 0.01, 0.03}) {
          // From the diagonal upside down, towards an edge or a face.
          const btQuaternion down = shortestArcQuat(corner.normalized(), btVector3(0, 0, -1));
          const btQuaternion rotation = btQuaternion(btVector3(0, 0, 1), btScalar(turn)) *
                                        btQuaternion(btVector3(0, 1, 0), btScalar(lean - 0.55)) * down;
          const btVector3 place(btScalar(x), btScalar(0.4), btScalar(0.5 - depth));
          const Cubes cubes{btTransform(rotation, place - quatRotate(rotation, corner)),
                            btTransform::getIdentity()};
          const Escape escape = leastEscape(cubes);
          if (escape.between_edges || escape.next < 1.2 * escape.depth) continue;
          SCOPED_TRACE(testing::Message() << lean << ' ' << turn << ' ' << x << ' ' << depth);
          ++count;
          TestWorld world(rigidContacts());
          world.add(shape, 0, cubes.lower.getOrigin());
          world.add(shape, 1, cubes.upper.getOrigin(), cubes.upper.getRotation());
          world.world.performDiscreteCollisionDetection();
          const auto points = world.contactsOfLast();
          ASSERT_GE(points.size(), 1u);
          EXPECT_NEAR(-points[0].getDistance(), escape.depth, 1e-4);
          for (int i = 0; i < 3; ++i) EXPECT_NEAR(points[0].m_normalWorldOnB[i], escape.direction[i], 1e-3);
        }
      }
    }
  }
  EXPECT_GT(count, 100);
}

TEST_P(CrossingEdges, GrowWithScaleAndMargin) {
  constexpr double kMargin = 0.01;
  const auto shape = makeCube(GetParam());
  shape->setMargin(btScalar(kMargin));
  expectDepthsOfTwiceTheSize(shape, shape, 2 * kMargin);
}

TEST_P(CrossingEdges, CarryACubeThatIsGuided) {
  const auto shape = makeCube(GetParam());
  expectGuidedCubeIsCarried(shape, shape);
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
    TestWorld world(rigidContacts());
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
