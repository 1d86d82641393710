// A ledge bears what lies on it, however near walls are all around.
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "innersphere/mesh.hpp"
#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "outline_meshes.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kShaft = 0.2, kHead = 0.25, kLedge = 0.3;  // [m] radii, height

/// A block with a bore that is wider from the ledge on.
Mesh counterbore() {
  return turnedMesh({{0, -0.1},
                     {0.3, -0.1},
                     {0.3, 0.42},
                     {kHead, 0.42},
                     {kHead, kLedge},
                     {kShaft, kLedge},
                     {kShaft, -0.05},
                     {0, -0.05}},
                    72);
}

/// A pin with a head, so much thinner all around.
Mesh pin(double clearance) {
  const double shaft = kShaft - clearance, head = kHead - clearance;
  return turnedMesh({{0, 0}, {shaft, 0}, {shaft, kLedge}, {head, kLedge}, {head, 0.4}, {0, 0.4}}, 72);
}

std::shared_ptr<PackingShape> packed(const Mesh& mesh, const std::string& name) {
  static std::map<std::string, std::shared_ptr<PackingShape>> shapes;
  std::shared_ptr<PackingShape>& shape = shapes[name];
  if (!shape) shape = makePackedShape(*makeSolid(mesh, name), 256);
  return shape;
}

struct Case {
  bool substeps, of_triangles;
  double rate, clearance;
};

class Ledge : public testing::TestWithParam<Case> {};

TEST_P(Ledge, BearsTheHeadOfAPin) {
  const Case& c = GetParam();
  TestWorld world;
  SubstepSolver solver;
  if (c.substeps) world.world.setConstraintSolver(&solver);
  PackingCollisionAlgorithm::prepareWorld(world.world);
  btTriangleMesh triangles;
  const Mesh hole = counterbore();
  addTriangles(hole, triangles);
  if (c.of_triangles) {
    world.add(std::make_shared<btBvhTriangleMeshShape>(&triangles, true), 0, btVector3(0, 0, 0));
  } else {
    const auto shape = packed(hole, "counterbore");
    world.add(shape, 0, btVector3(0, 0, 0))
        .setWorldTransform(shape->bodyTransform(btTransform::getIdentity()));
  }
  const auto shape = packed(pin(c.clearance), "pin" + std::to_string(c.clearance));
  btRigidBody& body = world.add(shape, 1, btVector3(0, 0, 0));
  const btTransform start(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(0.002)));
  body.setWorldTransform(shape->bodyTransform(start));
  body.setActivationState(DISABLE_DEACTIVATION);
  const btScalar before = body.getWorldTransform().getOrigin().z();
  btScalar lowest = before;
  for (int i = 0; i < int(c.rate); ++i) {
    world.run(1 / c.rate, 1 / c.rate);
    lowest = btMin(lowest, body.getWorldTransform().getOrigin().z());
  }
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z() - before, -0.002, 0.0003);
  EXPECT_GT(lowest - before, -0.002 - 0.001);
  world.world.setConstraintSolver(&world.solver);
}

INSTANTIATE_TEST_SUITE_P(Beside, Ledge,
                         testing::Values(Case{true, false, 60, 0.002}, Case{true, false, 240, 0.005},
                                         Case{false, false, 60, 0.005}, Case{false, false, 240, 0.002},
                                         Case{true, true, 60, 0.002}, Case{true, true, 240, 0.005},
                                         Case{false, true, 60, 0.005}, Case{false, true, 240, 0.002}),
                         [](const auto& info) {
                           const Case& c = info.param;
                           return std::string(c.substeps ? "Substeps" : "Bullet") +
                                  (c.of_triangles ? "Triangles" : "Packing") + std::to_string(int(c.rate)) +
                                  "Within" + std::to_string(int(1000 * c.clearance)) + "mm";
                         });

}  // namespace
}  // namespace innersphere::test
