// Bodies of all kinds that lie on something lie there: at the right height, and without creeping away.
#include <gtest/gtest.h>

#include <algorithm>

#include "named_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

class Rest : public testing::TestWithParam<std::tuple<std::string, std::string>> {};

double lowest(const PackingShape& shape, const btTransform& body) {
  const Packing& packing = shape.model().packing();
  double z = 1e9;
  for (const auto& v : packing.surface.vertices) {
    const btVector3 at = shape.principalTransform() * btVector3(v[0], v[1], v[2]);
    z = std::min(z, double((body * (shape.getLocalScaling() * at)).z()));
  }
  return z;
}

TEST_P(Rest, IsAtTheSurfaceAndDoesNotCreep) {
  const auto& [name, ground] = GetParam();
  TestWorld world;
  // With one, Bullet turns it along the last bit of sliding, and even its own boxes creep.
  world.world.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  if (ground == "plane") {
    world.addFloor();
  } else {
    // So large that its gaps are wider than the body's spheres.
    const auto shape = makeNamedShape("box", 500, 5);
    btTransform upright = shape->principalTransform().inverse();
    upright.setOrigin(btVector3(0, 0, 0));
    double top = -1e9;
    for (const auto& v : shape->model().packing().surface.vertices) {
      const btVector3 at = shape->principalTransform() * btVector3(v[0], v[1], v[2]);
      top = std::max(top, double((upright * (shape->getLocalScaling() * at)).z()));
    }
    world.add(shape, 0, btVector3(0, 0, btScalar(-top)), upright.getRotation());
  }
  const auto shape = makeNamedShape(name, 500, 0.5);  // 1 m across
  btTransform place = shape->principalTransform().inverse();
  place.setOrigin(btVector3(btScalar(0.013), btScalar(0.027), 0));
  place.getOrigin().setZ(btScalar(0.02 - lowest(*shape, place)));
  btRigidBody& body = world.add(shape, 1, place.getOrigin(), place.getRotation());
  body.setActivationState(DISABLE_DEACTIVATION);

  world.run(3, 1.0 / 120);
  const btTransform before = body.getWorldTransform();
  EXPECT_NEAR(lowest(*shape, before), 0, 5e-4);
  world.run(3, 1.0 / 120);
  const btTransform after = body.getWorldTransform();
  EXPECT_LT(before.getOrigin().distance(after.getOrigin()), 1e-4);
  EXPECT_LT(before.getRotation().angleShortestPath(after.getRotation()), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Of, Rest,
    testing::Combine(testing::Values("box", "ball", "torus", "link", "lbracket", "gear", "nut"),
                     testing::Values("plane", "packing")),
    [](const auto& info) { return std::get<0>(info.param) + "_on_" + std::get<1>(info.param); });

}  // namespace
}  // namespace innersphere::test
