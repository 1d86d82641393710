// Walls and spikes that few spheres leave out lie on what they lie on.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "innersphere/mesh.hpp"
#include "named_packings.hpp"
#include "test_world.hpp"
#include "thin_meshes.hpp"

namespace innersphere::test {
namespace {

/// Packed with 256 spheres, once.
std::shared_ptr<PackingShape> shapeOf(const std::string& solid) {
  static std::map<std::string, std::shared_ptr<PackingShape>> shapes;
  std::shared_ptr<PackingShape>& shape = shapes[solid];
  if (!shape) {
    const std::unique_ptr<Solid> packed =
        solid == "cow" ? makeCow() : makeSolid(solid == "cup" ? cupMesh() : hornMesh(), solid);
    shape = makePackedShape(*packed, 256);
  }
  return shape;
}

/// What bodies lie on: its top is at z = 0.
class Ground {
 public:
  Ground(TestWorld& world, const std::string& name) {
    if (name == "plane") world.addFloor();
    if (name == "box") world.add(std::make_shared<btBoxShape>(btVector3(2, 2, 1)), 0, btVector3(0, 0, -1));
    if (name != "mesh") return;
    for (const btScalar s : {btScalar(2), btScalar(-2)})
      triangles_.addTriangle(btVector3(-s, -s, 0), btVector3(s, -s, 0), btVector3(s, s, 0));
    world.add(std::make_shared<btBvhTriangleMeshShape>(&triangles_, true), 0, btVector3(0, 0, 0));
  }

 private:
  btTriangleMesh triangles_;
};

/// A shape's corners, in the frame of its body.
class Corners {
 public:
  explicit Corners(const PackingShape& shape) {
    for (const auto& v : shape.model().packing().surface.vertices)
      corners_.push_back(shape.principalTransform() * btVector3(v[0], v[1], v[2]));
  }
  double lowest(const btTransform& body) const {
    btScalar z = BT_LARGE_FLOAT;
    for (const btVector3& v : corners_) z = btMin(z, (body * v).z());
    return double(z);
  }
  /// Of the box around them.
  double size() const {
    btVector3 min = corners_[0], max = min;
    for (const btVector3& v : corners_) {
      min.setMin(v);
      max.setMax(v);
    }
    return double((max - min).length());
  }

 private:
  std::vector<btVector3> corners_;
};

struct Case {
  std::string solid, ground;
  double tilt;       ///< from standing, about x [rad]
  int rate;          ///< [steps/s]
  double pitch = 0;  ///< before, about y [rad]
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.solid << " on " << c.ground;
}

class ThinParts : public testing::TestWithParam<Case> {};

TEST_P(ThinParts, LieOnTheGround) {
  const Case& c = GetParam();
  const std::shared_ptr<PackingShape> shape = shapeOf(c.solid);
  TestWorld world;
  PackingCollisionAlgorithm::prepareWorld(world.world);
  const Ground ground(world, c.ground);
  const Corners corners(*shape);
  const btQuaternion turn = btQuaternion(btVector3(1, 0, 0), btScalar(c.tilt)) *
                            btQuaternion(btVector3(0, 1, 0), btScalar(c.pitch));
  btTransform place = btTransform(turn) * shape->principalTransform().inverse();
  place.setOrigin(btVector3(btScalar(0.013), btScalar(0.027), 0));
  place.getOrigin().setZ(btScalar(0.01 - corners.lowest(place)));
  btRigidBody& body = world.add(shape, 0.2, place.getOrigin(), place.getRotation());
  body.setActivationState(DISABLE_DEACTIVATION);
  body.setRollingFriction(btScalar(0.01));
  world.run(2, 1.0 / c.rate);
  EXPECT_GT(corners.lowest(body.getWorldTransform()), -0.005 * corners.size());
  EXPECT_LT(corners.lowest(body.getWorldTransform()), 0.005 * corners.size());
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const char* ground : {"plane", "box", "mesh"}) {
    for (const int rate : {240, 60}) {
      // The cup on its bottom, its rim and its side; the horn on its side.
      for (const double tilt : {0.0, M_PI, M_PI / 2 + 0.1}) all.push_back({"cup", ground, tilt, rate});
      all.push_back({"horn", ground, M_PI / 2, rate});
      // The cow on its legs, its horns, its side, its muzzle and its tail.
      for (const double tilt : {0.0, M_PI, M_PI / 2 + 0.1}) all.push_back({"cow", ground, tilt, rate});
      for (const double pitch : {1.2, -1.4}) all.push_back({"cow", ground, 0, rate, pitch});
    }
  }
  return all;
}

std::string nameOf(const testing::TestParamInfo<Case>& info) {
  const Case& c = info.param;
  const std::string posture = c.pitch > 0   ? "_falls_on_its_head"
                              : c.pitch < 0 ? "_falls_on_its_tail"
                              : c.tilt == 0 ? "_stands"
                              : c.tilt > 3  ? "_upside_down"
                                            : "_lies";
  return c.solid + posture + "_on_" + c.ground + "_at_" + std::to_string(c.rate);
}

INSTANTIATE_TEST_SUITE_P(With256Spheres, ThinParts, testing::ValuesIn(cases()), nameOf);

/// Two kinematic jaws left and right of a vessel of this radius [m].
class Hand {
 public:
  Hand(TestWorld& world, double radius) : radius_(radius), thick_(0.2 * radius) {
    for (btRigidBody*& jaw : jaws_) {
      jaw = &world.add(std::make_shared<btBoxShape>(
                           btVector3(btScalar(thick_), btScalar(0.3 * radius), btScalar(0.3 * radius))),
                       0, btVector3(0, 0, btScalar(-10)));
      jaw->setCollisionFlags(jaw->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
      jaw->setActivationState(DISABLE_DEACTIVATION);
    }
  }
  void moveTo(const btVector3& middle, double gap) {
    for (const int i : {0, 1}) {
      const btVector3 aside(btScalar((2 * i - 1) * (radius_ + gap + thick_)), 0, 0);
      jaws_[i]->setWorldTransform(btTransform(btQuaternion::getIdentity(), middle + aside));
    }
  }

 private:
  const double radius_, thick_;
  std::array<btRigidBody*, 2> jaws_;
};

class PutDown : public testing::TestWithParam<Case> {};

/// Held by a quarter of a percent of its radius on each side, tilted, put down, and let go.
TEST_P(PutDown, LiesOnTheGround) {
  const Case& c = GetParam();
  const std::shared_ptr<PackingShape> shape = shapeOf(c.solid);
  TestWorld world;
  PackingCollisionAlgorithm::prepareWorld(world.world);
  const Ground ground(world, c.ground);
  const Corners corners(*shape);
  const double dt = 1.0 / c.rate, size = corners.size();
  constexpr double kRadius = 0.05, kClosing = 0.2, kLowering = 0.8, kOpening = 0.2, kLying = 1, kDown = 0.2;
  btTransform place =
      btTransform(btQuaternion(btVector3(1, 0, 0), btScalar(c.tilt))) * shape->principalTransform().inverse();
  place.setOrigin(btVector3(0, 0, 0));
  const double down = kDown * size, start = down - corners.lowest(place);
  place.getOrigin().setZ(btScalar(start));
  btRigidBody& body = world.add(shape, 0.2, place.getOrigin(), place.getRotation());
  body.setActivationState(DISABLE_DEACTIVATION);
  Hand hand(world, kRadius);
  const double open = 0.1 * kRadius, closed = -0.0025 * kRadius;
  double deepest = 0;
  const auto goOn = [&](double seconds, double from_height, double to_height, double from_gap, double to_gap,
                        bool held) {
    const int steps = static_cast<int>(std::lround(seconds / dt));
    for (int i = 1; i <= steps; ++i) {
      const double part = double(i) / steps;
      hand.moveTo(btVector3(0, 0, btScalar(from_height + (to_height - from_height) * part)),
                  from_gap + (to_gap - from_gap) * part);
      if (held) {
        body.setWorldTransform(place);
        body.setLinearVelocity(btVector3(0, 0, 0));
        body.setAngularVelocity(btVector3(0, 0, 0));
      }
      world.run(dt, dt);
      deepest = std::max(deepest, -corners.lowest(body.getWorldTransform()));
    }
  };
  goOn(kClosing, start, start, open, closed, true);
  goOn(kLowering, start, start - down, closed, closed, false);
  EXPECT_LT(corners.lowest(body.getWorldTransform()), 0.02 * size) << "it slipped";
  goOn(kOpening, start - down, start - down, closed, open, false);
  goOn(kLying, start - down, start - down + 2 * size, open, open, false);
  EXPECT_LT(deepest, 0.005 * size);
  EXPECT_LT(std::fabs(corners.lowest(body.getWorldTransform())), 0.005 * size);
}

std::vector<Case> vessels() {
  std::vector<Case> all;
  for (const char* ground : {"plane", "box", "mesh"}) {
    for (const int rate : {240, 60}) all.push_back({"cup", ground, 0.2, rate});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(With256Spheres, PutDown, testing::ValuesIn(vessels()), nameOf);

}  // namespace
}  // namespace innersphere::test
