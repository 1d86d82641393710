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
#include "innersphere/packer.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"
#include "turned_meshes.hpp"

namespace innersphere::test {
namespace {

/// Packed with 256 spheres, once.
std::shared_ptr<PackingShape> shapeOf(const std::string& solid) {
  static std::map<std::string, std::shared_ptr<PackingShape>> shapes;
  std::shared_ptr<PackingShape>& shape = shapes[solid];
  if (!shape) {
    PackOptions options;
    options.spheres = 256;
    options.overlap_errors = false;
    const std::unique_ptr<Solid> packed =
        solid == "cow" ? makeCow() : makeSolid(solid == "cup" ? cupMesh() : hornMesh(), solid);
    shape = makeShape(pack(*packed, options));
  }
  return shape;
}

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
  btTriangleMesh triangles;
  if (c.ground == "plane") world.addFloor();
  if (c.ground == "box") world.add(std::make_shared<btBoxShape>(btVector3(1, 1, 1)), 0, btVector3(0, 0, -1));
  if (c.ground == "mesh") {
    for (const btScalar s : {btScalar(1), btScalar(-1)})
      triangles.addTriangle(btVector3(-s, -s, 0), btVector3(s, -s, 0), btVector3(s, s, 0));
    world.add(std::make_shared<btBvhTriangleMeshShape>(&triangles, true), 0, btVector3(0, 0, 0));
  }
  std::vector<btVector3> vertices;
  btVector3 min(1, 1, 1), max(-1, -1, -1);
  for (const auto& v : shape->model().packing().surface.vertices) {
    vertices.push_back(shape->principalTransform() * btVector3(v[0], v[1], v[2]));
    min.setMin(vertices.back());
    max.setMax(vertices.back());
  }
  const auto lowest = [&](const btTransform& body) {
    btScalar z = BT_LARGE_FLOAT;
    for (const btVector3& v : vertices) z = btMin(z, (body * v).z());
    return double(z);
  };
  const btQuaternion turn = btQuaternion(btVector3(1, 0, 0), btScalar(c.tilt)) *
                            btQuaternion(btVector3(0, 1, 0), btScalar(c.pitch));
  btTransform place = btTransform(turn) * shape->principalTransform().inverse();
  place.setOrigin(btVector3(btScalar(0.013), btScalar(0.027), 0));
  place.getOrigin().setZ(btScalar(0.01 - lowest(place)));
  btRigidBody& body = world.add(shape, 0.2, place.getOrigin(), place.getRotation());
  body.setActivationState(DISABLE_DEACTIVATION);
  body.setRollingFriction(btScalar(0.01));
  world.run(2, 1.0 / c.rate);
  const double size = (max - min).length();
  EXPECT_GT(lowest(body.getWorldTransform()), -0.005 * size);
  EXPECT_LT(lowest(body.getWorldTransform()), 0.005 * size);
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

}  // namespace
}  // namespace innersphere::test
