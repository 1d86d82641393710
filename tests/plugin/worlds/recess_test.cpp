// Bodies whose underside rises beside a foot stand on packed floors on that foot alone.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "each_world.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "named_packings.hpp"
#include "outline_meshes.hpp"

namespace innersphere::test {
namespace {

/// A foot 0.2 m wide and 0.05 high in the middle of a block, whose underside rises from there to both sides
/// [rad].
Mesh footedBlock(double rises) {
  const double side = 0.05 + 0.2 * std::tan(rises);
  return prismMesh(
      {{-0.1, 0}, {0.1, 0}, {0.1, 0.05}, {0.3, side}, {0.3, 0.4}, {-0.3, 0.4}, {-0.3, side}, {-0.1, 0.05}});
}

// The edge in which the floor ends, a metre off, was taken for one in the valley between foot and underside:
// such bodies were thrown up by up to metres.
TEST(Recess, BodiesStandOnTheFootBesideIt) {
  constexpr double kFloor = 2, kAbove = 0.002, kSeconds = 0.5;
  const auto floor = makePackedShape(*makeBox({kFloor, kFloor, 0.4}), 256);
  for (const double degrees : {6.0, 11.25, 30.0}) {
    const auto shape = makePackedShape(*makeSolid(footedBlock(degrees * M_PI / 180), "block"), 256);
    inEachWorld([&](TestWorld& world, bool substeps, double rate) {
      SCOPED_TRACE(testing::Message() << degrees << " degrees, " << rate << (substeps ? " substeps" : ""));
      world.add(floor, 0, btVector3(0, 0, btScalar(-0.2)));
      btRigidBody& body = world.add(shape, 20, btVector3(0, 0, 0));
      const btVector3 place{btScalar(0.13), btScalar(-0.4), btScalar(kAbove)};
      body.setWorldTransform(shape->bodyTransform(btTransform(btQuaternion::getIdentity(), place)));
      body.setInterpolationWorldTransform(body.getWorldTransform());
      const btVector3 start = body.getWorldTransform().getOrigin();
      btScalar farthest = 0;
      for (int i = 0; i < int(kSeconds * rate); ++i) {
        world.run(1 / rate, 1 / rate);
        farthest = btMax(farthest, body.getWorldTransform().getOrigin().distance(start));
        for (const btManifoldPoint& point : world.contactsOfLast())
          EXPECT_LT(point.getPositionWorldOnB().distance(start), 0.7);  // no corner is as far
      }
      EXPECT_LT(farthest, 2 * kAbove);
      EXPECT_LT(body.getLinearVelocity().length(), 0.002);
    });
  }
}

}  // namespace
}  // namespace innersphere::test
