// Spheres near meshes, against the distance of a box and of a corner between walls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <btBulletCollisionCommon.h>

#include "narrow_phase/shapes/shape_surface.hpp"
#include "test_packings.hpp"

namespace innersphere::test {
namespace {

constexpr double kRadius = 0.3, kHalf = 1;

/// One ball, where a test puts it.
std::vector<NearSphere> nearAt(ShapeSurface& surface, const btVector3& place,
                               const btQuaternion& turn = btQuaternion::getIdentity()) {
  static const std::shared_ptr<PackingShape> ball = [] {
    Packing packing;
    packing.spheres = {{0, 0, 0, float(kRadius)}};
    auto shape = makeShape(packing);
    shape->setMargin(0);
    return shape;
  }();
  const PlacedPacking body(*ball, btTransform(turn, place), Estimator::raw, 0);
  std::vector<NearSphere> found;
  surface.findNearSpheres(body, btTransform::getIdentity(), found);
  return found;
}

std::vector<NearSphere> nearAt(const btCollisionShape& mesh, const btVector3& place) {
  return nearAt(*makeShapeSurface(mesh), place);
}

/// The surface of a cube, each face in n x n squares of two triangles; wound so that normals point out.
class CubeMesh {
 public:
  explicit CubeMesh(int n) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int sign : {1, -1}) {
        for (int i = 0; i < n * n; ++i) addSquare(axis, sign, i % n, i / n, n);
      }
    }
    shape = std::make_unique<btBvhTriangleMeshShape>(&mesh_, true);
  }
  std::unique_ptr<btBvhTriangleMeshShape> shape;

 private:
  void addSquare(int axis, int sign, int i, int j, int n) {
    const auto corner = [&](int di, int dj) {
      btVector3 p;
      p[axis] = btScalar(sign * kHalf);
      p[(axis + 1) % 3] = btScalar(2 * kHalf * (i + di) / n - kHalf);
      p[(axis + 2) % 3] = btScalar(2 * kHalf * (j + dj) / n - kHalf);
      return p;
    };
    const btVector3 a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
    if (sign > 0) {
      mesh_.addTriangle(a, b, c);
      mesh_.addTriangle(a, c, d);
    } else {
      mesh_.addTriangle(a, c, b);
      mesh_.addTriangle(a, d, c);
    }
  }
  btTriangleMesh mesh_;
};

class CubeMeshes : public testing::TestWithParam<int> {};

/// However its faces are cut: no edge between two triangles of a face is felt.
TEST_P(CubeMeshes, AreAsFarAwayAsTheirCube) {
  const CubeMesh cube(GetParam());
  std::mt19937 rng(6);
  std::uniform_real_distribution<double> u(-1.5, 1.5);
  int near = 0;
  for (int k = 0; k < 2000; ++k) {
    const double p[3] = {u(rng), u(rng), u(rng)};
    double outside[3], distance2 = 0;
    for (int i = 0; i < 3; ++i) {
      outside[i] = std::max(0.0, std::fabs(p[i]) - kHalf);
      distance2 += outside[i] * outside[i];
    }
    const double distance = std::sqrt(distance2);
    if (distance < 1e-3 || std::fabs(distance - kRadius) < 1e-4) continue;
    const std::vector<NearSphere> found =
        nearAt(*cube.shape, btVector3(btScalar(p[0]), btScalar(p[1]), btScalar(p[2])));
    ASSERT_EQ(found.size(), distance < kRadius ? 1u : 0u) << p[0] << " " << p[1] << " " << p[2];
    if (found.empty()) continue;
    ++near;
    EXPECT_NEAR(found[0].distance, distance, 1e-5);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(found[0].normal[i], std::copysign(outside[i] / distance, p[i]), 2e-3);
  }
  EXPECT_GT(near, 200);
}

INSTANTIATE_TEST_SUITE_P(Cuts, CubeMeshes, testing::Values(1, 2, 5));

/// A triangle beside the one below the ball is as near but for rounding.
TEST(TriangleSurface, ABallThatSinksInBesideAnEdgeIsInside) {
  constexpr double kEdge = 0.2, kDeep = 0.1;
  const CubeMesh cube(5);
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int k = 0; k < 2000; ++k) {
    const btVector3 axis(btScalar(u(rng)), btScalar(u(rng)), btScalar(u(rng)));
    const btQuaternion turn(axis.normalized(), btScalar(3 * u(rng)));
    const double beside = 1e-4 * u(rng);
    const auto place = [&](double z) {
      return btVector3(btScalar(kEdge + beside), btScalar(0.05), btScalar(z));
    };
    const auto surface = makeShapeSurface(*cube.shape);
    ASSERT_EQ(nearAt(*surface, place(kHalf + kDeep), turn).size(), 1u);
    const std::vector<NearSphere> found = nearAt(*surface, place(kHalf - kDeep), turn);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].distance, -kDeep, 1e-5) << beside;
    EXPECT_NEAR(found[0].normal.z(), 1, 1e-5);
  }
}

TEST(TriangleSurface, ACornerBetweenThreeWallsIsThreeContacts) {
  const CubeMesh cube(3);
  // Inside of the hollow cube, near three of its walls.
  const std::vector<NearSphere> found =
      nearAt(*cube.shape, btVector3(btScalar(0.9), btScalar(0.85), btScalar(0.8)));
  ASSERT_EQ(found.size(), 3u);
  const double expected[] = {0.1, 0.15, 0.2};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[i].distance, expected[i], 1e-5);
    // Its side of first contact is inside.
    EXPECT_NEAR(found[i].normal[int(i)], -1, 1e-5);
  }
}

}  // namespace
}  // namespace innersphere::test
