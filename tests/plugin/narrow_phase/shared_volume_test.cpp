// The volume that a packing shares with every kind of shape, against a count of points in its spheres.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <ostream>
#include <random>

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>

#include "innersphere/pair_overlaps.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr int kCells = 8;
constexpr double kRadius = 0.5 / kCells;  // of the spheres of a cube of 1 m

/// A solid that a cube of spheres is pushed into.
struct Solid {
  const char* name;
  std::shared_ptr<btCollisionShape> shape;
  std::function<bool(const btVector3&)> holds;
  btTransform cube;                      ///< where it is
  double curvature = 0;                  ///< the largest of the surface there [1/m]
  int edge_spheres = 0;                  ///< about as many lie across an edge
  std::shared_ptr<void> data = nullptr;  ///< what the shape refers to

  friend void PrintTo(const Solid& solid, std::ostream* out) { *out << solid.name; }
};

btTransform at(double x, double y, double z, double turn = 0) {
  return btTransform(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(turn)),
                     btVector3(btScalar(x), btScalar(y), btScalar(z)));
}

/// The ground below heights over a grid of 0.25 m, 8 m across, in squares cut from (1, 0) to (0, 1).
struct Terrain {
  static constexpr int kCount = 33;
  static constexpr double kCell = 0.25, kHalf = 4;

  explicit Terrain(const std::function<double(double, double)>& height) {
    for (int j = 0; j < kCount; ++j) {
      for (int i = 0; i < kCount; ++i) heights.push_back(float(height(i * kCell - kHalf, j * kCell - kHalf)));
    }
  }
  double at(int i, int j) const { return heights[std::size_t(j * kCount + i)]; }
  bool holds(const btVector3& p) const {
    const double x = (p.x() + kHalf) / kCell, y = (p.y() + kHalf) / kCell;
    const int i = int(x), j = int(y);
    const double u = x - i, v = y - j;
    const double h = u + v < 1 ? at(i, j) + u * (at(i + 1, j) - at(i, j)) + v * (at(i, j + 1) - at(i, j))
                               : at(i + 1, j + 1) + (1 - u) * (at(i, j + 1) - at(i + 1, j + 1)) +
                                     (1 - v) * (at(i + 1, j) - at(i + 1, j + 1));
    return p.z() < h;
  }

  std::vector<float> heights;
};

Solid heightfield(const char* name, const btTransform& cube,
                  const std::function<double(double, double)>& height) {
  const auto terrain = std::make_shared<Terrain>(height);
  auto shape = std::make_shared<btHeightfieldTerrainShape>(
      Terrain::kCount, Terrain::kCount, terrain->heights.data(), btScalar(-2), btScalar(2), 2, false);
  shape->setLocalScaling(btVector3(btScalar(Terrain::kCell), btScalar(Terrain::kCell), 1));
  return {name, shape, [terrain](const btVector3& p) { return terrain->holds(p); }, cube, 0, 0, terrain};
}

Solid triangleMesh() {
  // A roof: z = -|x| / 2.
  auto mesh = std::make_shared<btTriangleMesh>();
  for (const btScalar side : {btScalar(-4), btScalar(4)}) {
    const btVector3 a(0, side, 0), b(0, -side, 0), c(side, -side, -2), d(side, side, -2);
    mesh->addTriangle(a, b, c);
    mesh->addTriangle(a, c, d);
  }
  const btVector3 out = btVector3(1, 0, 2).normalized();
  const btQuaternion lies = shortestArcQuat(btVector3(0, 0, 1), out);
  const btVector3 middle = btVector3(2, 0, -1) + out * btScalar(0.5 - 0.6 * kRadius);
  return {"triangle_mesh",
          std::make_shared<btBvhTriangleMeshShape>(mesh.get(), true),
          [](const btVector3& p) { return p.z() < -btFabs(p.x()) / 2; },
          btTransform(lies, middle),
          0,
          0,
          mesh};
}

Solid hull() {
  // An octahedron |x| + |y| + |z| < 3, its face towards (1, 1, 1).
  auto shape = std::make_shared<btConvexHullShape>();
  for (int axis = 0; axis < 3; ++axis) {
    for (const btScalar side : {btScalar(-3), btScalar(3)}) {
      btVector3 corner(0, 0, 0);
      corner[axis] = side;
      shape->addPoint(corner);
    }
  }
  const double margin = shape->getMargin();  // a part of it
  return {"convex_hull", shape,
          [margin](const btVector3& p) {
            const btVector3 q = p.absolute();
            return q.x() + q.y() + q.z() < 3 + margin * std::sqrt(3.0);
          },
          at(1.15, 1.15, 1.15, 0.4)};
}

const std::vector<Solid>& solids() {
  static const std::vector<Solid> all = [] {
    std::vector<Solid> s;
    s.push_back({"plane", std::make_shared<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(1)),
                 [](const btVector3& p) { return p.z() < 1; }, at(0, 0, 1.2, 0.5)});
    s.push_back({"sphere", std::make_shared<btSphereShape>(btScalar(2)),
                 [](const btVector3& p) { return p.length() < 2; }, at(1, 1, 1.6, 0.5), 0.5});
    const auto in_box = [](const btVector3& p) {
      return btFabs(p.x()) < 2 && btFabs(p.y()) < 2 && btFabs(p.z()) < 1;
    };
    const auto box = std::make_shared<btBoxShape>(btVector3(2, 2, 1));
    s.push_back({"box", box, in_box, at(0.2, 0.3, 1.1, 0.7)});
    s.push_back({"edge_of_a_box", box, in_box, at(1.9, 0, 0.9, 0.1), 0, kCells + 1});
    s.push_back(
        {"capsule", std::make_shared<btCapsuleShapeZ>(btScalar(1.5), btScalar(3)),
         [](const btVector3& p) {
           return btVector3(p.x(), p.y(), p.z() - btClamped(p.z(), btScalar(-1.5), btScalar(1.5))).length() <
                  1.5;
         },
         at(1.3, 0.6, 1.2, 0.6), 1 / 1.5});
    const auto in_cylinder = [](const btVector3& p) {
      return std::hypot(p.x(), p.y()) < 1.5 && btFabs(p.z()) < 2;
    };
    const auto cylinder = std::make_shared<btCylinderShapeZ>(btVector3(1.5, 1.5, 2));
    s.push_back({"side_of_a_cylinder", cylinder, in_cylinder, at(1.3, 0.6, 0.2, 0.6), 1 / 1.5});
    s.push_back({"end_of_a_cylinder", cylinder, in_cylinder, at(0.2, 0.3, 2.1, 0.6)});
    // Its tip is at z = 3.
    const auto cone = std::make_shared<btConeShapeZ>(btScalar(3), btScalar(6));
    cone->setMargin(0);
    const auto in_cone = [](const btVector3& p) {
      return p.z() > -3 && std::hypot(p.x(), p.y()) < (3 - p.z()) / 2;
    };
    s.push_back({"side_of_a_cone", cone, in_cone, at(1.8, 0.9, -0.7, 0.4), 1.0});
    s.push_back({"base_of_a_cone", cone, in_cone, at(0.3, 0.4, -3.1, 0.4)});
    s.push_back(hull());
    s.push_back(triangleMesh());
    const btVector3 out = btVector3(btScalar(-0.4), btScalar(-0.2), 1).normalized();
    s.push_back(heightfield(
        "heightfield_slope",
        btTransform(shortestArcQuat(btVector3(0, 0, 1), out), out * btScalar(0.5 - 0.6 * kRadius)),
        [](double x, double y) { return 0.4 * x + 0.2 * y; }));
    s.push_back(heightfield("heightfield_hills", at(0.3, 0.2, 0.48),
                            [](double x, double y) { return 0.04 * std::sin(2 * x) * std::cos(3 * y); }));
    return s;
  }();
  return all;
}

struct Count {
  double volume = 0;
  btVector3 moment{0, 0, 0};
  double variance = 0;
  int cut = 0;  ///< spheres
};

Count countPoints(const Solid& solid, const Packing& packing) {
  constexpr int kPoints = 1000;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> side(-1, 1);
  Count count;
  for (const Sphere& sphere : packing.spheres) {
    const double volume = 4.0 / 3 * M_PI * std::pow(double(sphere.radius), 3);
    int hits = 0;
    for (int i = 0; i < kPoints;) {
      const btVector3 p(btScalar(side(random)), btScalar(side(random)), btScalar(side(random)));
      if (p.length2() > 1) continue;
      ++i;
      const btVector3 x = solid.cube(btVector3(sphere.x, sphere.y, sphere.z) + p * btScalar(sphere.radius));
      if (!solid.holds(x)) continue;
      ++hits;
      count.moment += x * btScalar(volume / kPoints);
    }
    const double share = double(hits) / kPoints;
    count.volume += volume * share;
    count.variance += volume * volume * share * (1 - share) / kPoints;
    if (hits > 0 && hits < kPoints) ++count.cut;
  }
  return count;
}

class SharedVolume : public testing::TestWithParam<Solid> {};

// Each sphere is cut by the plane that touches the surface at its nearest point. Where that is curved, a cut
// of radius r takes up to pi r^4 / 4 times the curvature off it, and where two faces meet in a sphere, up to
// a quarter.
TEST_P(SharedVolume, IsThatOfTheSpheresInTheSolid) {
  const Solid& solid = GetParam();
  const Packing packing = latticeBox({1, 1, 1}, kCells);
  const Count count = countPoints(solid, packing);
  ASSERT_GT(count.cut, kCells);
  const double chance = 4 * std::sqrt(count.variance), digits = 1e-4 * count.volume;
  const double curved = count.cut * M_PI / 4 * std::pow(kRadius, 4) * solid.curvature;
  const double edge = solid.edge_spheres * M_PI / 3 * std::pow(kRadius, 3);
  for (const Response response : {Response::compliant, Response::penalty}) {
    ContactOptions options;
    options.response = response;
    options.estimator = Estimator::raw;
    TestWorld world(options);
    world.add(solid.shape, 0, btVector3(0, 0, 0));
    world.add(makeShape(packing), 1, solid.cube.getOrigin(), solid.cube.getRotation());
    world.world.performDiscreteCollisionDetection();
    const auto pairs = pairOverlaps(&world.dispatcher);
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_GT(pairs[0].volume, count.volume - chance - digits);
    EXPECT_LT(pairs[0].volume, count.volume + chance + digits + curved + edge);
    // What is too much is within the cube.
    const double share = (chance + digits + curved + edge) / count.volume;
    EXPECT_LT(pairs[0].centroid.distance(count.moment / btScalar(count.volume)), share * std::sqrt(3.0) / 2);
  }
}

INSTANTIATE_TEST_SUITE_P(With, SharedVolume, testing::ValuesIn(solids()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace innersphere::test
