// What is inside comes out: bodies that start in another, or are thrown into it, have left it after a second,
// and are not thrown.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "each_world.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "outline_meshes.hpp"
#include "packing/mesh_shapes.hpp"
#include "test_world.hpp"
#include "thin_meshes.hpp"

namespace innersphere::test {
namespace {

struct Case {
  std::string body, ground;
  double sunk;   ///< of its height, below the ground
  double speed;  ///< downwards [m/s]
  Response response;
  int rate;  ///< [steps/s]
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.body << " in " << c.ground;
}

std::shared_ptr<PackingShape> shapeOf(const std::string& name) {
  static std::map<std::string, std::shared_ptr<PackingShape>> shapes;
  std::shared_ptr<PackingShape>& shape = shapes[name];
  if (shape) return shape;
  if (name == "horn") {
    shape = makePackedShape(*makeSolid(hornMesh(), name), 256);
  } else if (name == "finer_bowl") {
    shape = makeNamedShape("bowl", 270, 0.2);
  } else {
    shape = makeNamedShape(name, 256, 0.2);
  }
  return shape;
}

/// A shape's corners, in the frame of the body.
std::vector<btVector3> cornersOf(const PackingShape& shape) {
  std::vector<btVector3> corners;
  for (const auto& v : shape.model().packing().surface.vertices)
    corners.push_back(shape.getLocalScaling() * (shape.principalTransform() * btVector3(v[0], v[1], v[2])));
  return corners;
}

constexpr double kPlate = 0.03;  ///< its thickness [m]
constexpr double kOut = 0.1;     ///< what has been out for so long has left [s]

/// A box, as a box, as a hull, or as a closed mesh.
std::shared_ptr<btCollisionShape> makePlate(const std::string& kind, const btVector3& half,
                                            btTriangleMesh& triangles) {
  if (kind == "plate") return std::make_shared<btBoxShape>(half);
  const Vec3d high{half.x(), half.y(), half.z()};
  const Mesh mesh = boxMesh({-high[0], -high[1], -high[2]}, high);
  if (kind == "hull_plate") {
    auto hull = std::make_shared<btConvexHullShape>();
    for (const Vec3d& v : mesh.vertices) hull->addPoint({btScalar(v[0]), btScalar(v[1]), btScalar(v[2])});
    hull->setMargin(0);
    return hull;
  }
  addTriangles(mesh, triangles);
  return std::make_shared<btBvhTriangleMeshShape>(&triangles, true);
}

class Leaving : public testing::TestWithParam<Case> {};

TEST_P(Leaving, TakesLessThanASecond) {
  const Case& c = GetParam();
  ContactOptions options;
  options.response = c.response;
  TestWorld world;
  PackingCollisionAlgorithm::prepareWorld(world.world, options);
  btTriangleMesh triangles;
  if (c.ground == "plane") world.addFloor();
  if (c.ground == "box") world.add(std::make_shared<btBoxShape>(btVector3(3, 3, 1)), 0, btVector3(0, 0, -1));
  if (c.ground.find("plate") != std::string::npos) {
    const btVector3 half(3, 3, btScalar(kPlate / 2));
    world.add(makePlate(c.ground, half, triangles), 0, btVector3(0, 0, -half.z()));
  }
  if (c.ground.find("sheet") != std::string::npos) {
    // Wound one way or the other.
    const btScalar t = c.ground == "sheet" ? btScalar(3) : btScalar(-3);
    for (const btScalar s : {btScalar(3), btScalar(-3)})
      triangles.addTriangle(btVector3(-s, -t * s / 3, 0), btVector3(s, -t * s / 3, 0),
                            btVector3(s, t * s / 3, 0));
    world.add(std::make_shared<btBvhTriangleMeshShape>(&triangles, true), 0, btVector3(0, 0, 0));
  }
  const std::shared_ptr<PackingShape> shape = shapeOf(c.body);
  const std::vector<btVector3> corners = cornersOf(*shape);
  // The lowest and the highest place of the body.
  const auto range = [&](const btTransform& body) {
    std::pair<double, double> z{1e9, -1e9};
    for (const btVector3& v : corners) {
      z.first = std::min(z.first, double((body * v).z()));
      z.second = std::max(z.second, double((body * v).z()));
    }
    return z;
  };
  // Tip or rim first. A horn that is upright to the last digit would show how rays along its axis are
  // rounded.
  const double turned = c.body == "horn" ? M_PI + 0.02 : c.body.find("bowl") != std::string::npos ? 2 : 0;
  const btTransform upside = btTransform(btQuaternion(btVector3(1, 0, 0), btScalar(turned)));
  btTransform place = upside * shape->principalTransform().inverse();
  place.setOrigin(btVector3(0, 0, 0));
  const auto [low, high] = range(place);
  place.getOrigin().setZ(btScalar(c.speed > 0 ? 0.3 - low : -low - c.sunk * (high - low)));
  btRigidBody& body = world.add(shape, 1, place.getOrigin(), place.getRotation());
  body.setActivationState(DISABLE_DEACTIVATION);
  body.setRollingFriction(btScalar(0.01));
  body.setLinearVelocity(btVector3(0, 0, btScalar(-c.speed)));
  const double size = 0.4;
  double fastest = 0, deepest = c.sunk * (high - low), out = 0, t = c.speed > 0 ? -0.3 / c.speed : 0;
  // What stands on its rim tips over once it is out.
  for (; t < 1 + kOut && out < kOut; t += 1.0 / c.rate) {
    world.run(1.0 / c.rate, 1.0 / c.rate);
    fastest = std::max(fastest, double(body.getLinearVelocity().z()));
    const double depth = -range(body.getWorldTransform()).first;
    deepest = std::max(deepest, depth);
    out = t > 0 && depth < 0.005 * size ? out + 1.0 / c.rate : 0;
  }
  EXPECT_GE(out, kOut) << "deepest " << deepest;
  // By the law: half of its size in a second, or three times its depth.
  EXPECT_LT(fastest, 1.1 * std::max(0.5 * size, 3 * deepest));
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const Response response : {Response::compliant, Response::rigid}) {
    for (const int rate : {240, 60}) {
      for (const char* ground : {"box", "plane", "sheet"}) {
        const bool sheet = std::string(ground) == "sheet";
        for (const char* body : {"gear", "torus", "lbracket", "horn"}) {
          for (const double sunk : {0.3, 1.0}) {
            if (sheet && sunk == 1) continue;  // it is on the other side
            all.push_back({body, ground, sunk, 0, response, rate});
          }
          if (!sheet) all.push_back({body, ground, 0, 20, response, rate});
        }
      }
      // What is thin, through a sheet up to where the greater part of the body begins.
      for (const char* ground : {"sheet", "turned_sheet"}) {
        for (const double sunk : {0.05, 0.15, 0.5, 0.65})
          all.push_back({"horn", ground, sunk, 0, response, rate});
        all.push_back({"blade", ground, 0.2, 0, response, rate});
      }
      // And through a plate, up to its middle, to its other side, and beyond.
      for (const char* ground : {"plate", "hull_plate", "mesh_plate"}) {
        for (const char* body : {"horn", "bowl"}) {
          for (const double sunk : {0.05, 0.1, 0.2}) all.push_back({body, ground, sunk, 0, response, rate});
        }
      }
      // Other spheres come close to the plate's faces at other times.
      all.push_back({"finer_bowl", "hull_plate", 0.2, 0, response, rate});
    }
  }
  return all;
}

std::string nameOf(const testing::TestParamInfo<Case>& info) {
  const Case& c = info.param;
  const std::string part = std::to_string(std::lround(100 * c.sunk));
  const std::string how = c.speed > 0 ? "_thrown_at_" : c.sunk == 1 ? "_deep_in_" : "_by_" + part + "_in_";
  return c.body + how + c.ground + (c.response == Response::rigid ? "_rigid_at_" : "_compliant_at_") +
         std::to_string(c.rate);
}

INSTANTIATE_TEST_SUITE_P(Of, Leaving, testing::ValuesIn(cases()), nameOf);

/// Two bodies of one shape without gravity.
class InEachOther {
 public:
  explicit InEachOther(const std::shared_ptr<PackingShape>& shape) {
    world.world.setGravity(btVector3(0, 0, 0));
    for (btRigidBody** body : {&lower, &upper}) {
      *body = &world.add(shape, 1, btVector3(0, 0, 0));
      (*body)->setActivationState(DISABLE_DEACTIVATION);
    }
  }
  ~InEachOther() { world.world.setConstraintSolver(&world.solver); }

  void setSolver(bool substeps) {
    world.world.setConstraintSolver(substeps ? static_cast<btConstraintSolver*>(&solver) : &world.solver);
    PackingCollisionAlgorithm::prepareWorld(world.world);
  }

  void place(double height, double turned = 0) {
    for (btRigidBody* body : {lower, upper}) {
      body->setWorldTransform(btTransform::getIdentity());
      body->setLinearVelocity(btVector3(0, 0, 0));
      body->setAngularVelocity(btVector3(0, 0, 0));
    }
    const btQuaternion rotation(btVector3(1, 2, 3).normalized(), btScalar(turned));
    upper->setWorldTransform(btTransform(rotation, btVector3(0, 0, btScalar(height))));
  }

  double deepest(double distance = 0) {
    struct Deepest : btCollisionWorld::ContactResultCallback {
      btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                               const btCollisionObjectWrapper*, int, int) override {
        depth = std::max(depth, -double(point.getDistance()));
        return 0;
      }
      double depth = 0;
    } found;
    found.m_closestDistanceThreshold = btScalar(distance);
    world.world.contactPairTest(lower, upper, found);
    return found.depth;
  }

  /// Runs for a second. Returns how fast they went away from each other at most, and notes how deep they
  /// were.
  double leave(double rate) {
    double fastest = 0;
    most = 0;
    for (int i = 0; i < int(rate); ++i) {
      most = std::max(most, deepest());
      world.run(1 / rate, 1 / rate);
      fastest = std::max(fastest, double((upper->getLinearVelocity() - lower->getLinearVelocity()).length()));
    }
    return fastest;
  }

  double most = 0;

 private:
  SubstepSolver solver;
  TestWorld world;
  btRigidBody* lower = nullptr;
  btRigidBody* upper = nullptr;
};

std::shared_ptr<PackingShape> cubeOfAMetre() {
  return makePackedShape(*makeBox({1, 1, 1}), 256);
}

// Their sides lie in the same planes: lines through both meet the sides, too, which are 1 m of a way out.
TEST(CubesInEachOther, SayTheShortestWayOutHoweverFarTheyLook) {
  InEachOther cubes(cubeOfAMetre());
  for (const double depth : {0.1, 0.2, 0.3, 0.4, 0.45, 0.6}) {
    cubes.place(1 - depth);
    for (const double distance : {0.0, 0.1, 0.2})
      EXPECT_NEAR(cubes.deepest(distance), depth, 1e-3) << "looked " << distance << " m far";
  }
}

// Each side is a way out: all of them together hold the cubes, and throw them where they give way.
TEST(CubesInEachOther, LeaveByOneSide) {
  InEachOther cubes(cubeOfAMetre());
  for (const bool substeps : {false, true}) {
    cubes.setSolver(substeps);
    for (const double rate : {60.0, 240.0}) {
      for (const double depth : {0.45, 0.7, 1.0}) {
        cubes.place(1 - depth);
        const double fastest = cubes.leave(rate);
        EXPECT_LT(cubes.deepest(), 0.005) << rate << " steps/s, " << depth << " m";
        EXPECT_LT(fastest, 1.1 * std::max(0.5, 3 * depth))
            << rate << " steps/s, " << depth << " m";  // the law
      }
    }
  }
}

// Teeth and walls that cross push each way: only all of the way out takes them apart. The law holds for
// places that touch: centres of bodies that turn may be twice as fast.
TEST(SolidsInTheSamePlace, Part) {
  for (const char* name : {"gear", "torus", "lbracket", "bowl"}) {
    const auto shape = shapeOf(name);
    InEachOther bodies(shape);
    for (const bool substeps : {false, true}) {
      bodies.setSolver(substeps);
      for (const double rate : {60.0, 240.0}) {
        for (const double turned : {0.0, 0.5}) {
          bodies.place(0, turned);
          const double fastest = bodies.leave(rate);
          EXPECT_LT(bodies.deepest(), 0.005 * 0.4)
              << name << (substeps ? ", substeps, " : ", ") << rate << " steps/s, turned by " << turned;
          EXPECT_LT(fastest, 2 * std::max(0.2, 3 * bodies.most))
              << name << (substeps ? ", substeps, " : ", ") << rate << " steps/s, turned by " << turned;
        }
      }
    }
  }
}

// 2 % of its size deep between walls that lean by 10 degrees, with friction that would hold it between walls
// of 27: no solid gives way by as much.
TEST(Wedges, ComeOutOfWhatTheyAreDrivenInto) {
  constexpr double kSlope = 10 * M_PI / 180, kFriction = 0.5, kDeep = 0.02;
  const auto sideAt = [&](double z) { return z * std::tan(kSlope); };
  const auto groove = makePackedShape(
      *makeSolid(prismMesh({{0, 0}, {sideAt(1), 1}, {1, 1}, {1, -0.5}, {-1, -0.5}, {-1, 1}, {-sideAt(1), 1}}),
                 "groove"),
      1000);
  const auto wedge = makePackedShape(
      *makeSolid(
          prismMesh({{-sideAt(0.4), 0.4}, {sideAt(0.4), 0.4}, {sideAt(0.9), 0.9}, {-sideAt(0.9), 0.9}}),
          "wedge"),
      1000);
  const double size = std::hypot(2 * sideAt(0.9), 1, 0.5);
  inEachWorld([&](TestWorld& world, bool substeps, double rate) {
    world.world.setGravity(btVector3(0, 0, 0));
    const auto add = [&](const std::shared_ptr<PackingShape>& shape, double mass, double z) -> btRigidBody& {
      const btTransform place =
          shape->bodyTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(z))));
      btRigidBody& body = world.add(shape, mass, place.getOrigin(), place.getRotation());
      body.setFriction(btScalar(std::sqrt(kFriction)));
      body.setActivationState(DISABLE_DEACTIVATION);
      return body;
    };
    add(groove, 0, 0);
    const btRigidBody& body = add(wedge, 1, -kDeep * size / std::sin(kSlope));
    world.run(1, 1 / rate);
    const double depth = -wedge->meshTransform(body.getWorldTransform()).getOrigin().z() * std::sin(kSlope);
    EXPECT_LT(depth, 0.005 * size) << substeps << ", " << rate << " steps/s";
    // By the law, along both walls as along one.
    EXPECT_LT(body.getLinearVelocity().length(), 0.5 * size) << substeps << ", " << rate << " steps/s";
  });
}

// No wedge, though walls press against each other through it: a force that somebody needs. It would fall by
// 20 m; friction of Bullet's solver lets it creep.
TEST(Wedges, AreNotWhatTwoBodiesGrip) {
  constexpr double kSide = 0.2, kDeep = 0.001, kWall = 0.1;
  const auto cube = makePackedShape(*makeBox({kSide, kSide, kSide}), 256);
  const auto wall = std::make_shared<btBoxShape>(btVector3(kWall, kWall, kWall));
  inEachWorld([&](TestWorld& world, bool substeps, double rate) {
    for (const double side : {-1.0, 1.0})
      world.add(wall, 0, btVector3(btScalar(side * (kSide / 2 + kWall - kDeep)), 0, 0));
    const btRigidBody& body = world.add(cube, 1, btVector3(0, 0, 0));
    world.run(2, 1 / rate);
    EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0, (substeps ? 0.005 : 0.05) * kSide)
        << substeps << ", " << rate << " steps/s";
  });
}

}  // namespace
}  // namespace innersphere::test
