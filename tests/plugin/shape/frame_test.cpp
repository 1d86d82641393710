// Shapes in other frames than the principal one.
#include <gtest/gtest.h>

#include <cmath>

#include <LinearMath/btSerializer.h>

#include "bullet_shapes.hpp"
#include "innersphere/error.hpp"
#include "innersphere/pair_overlaps.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

const btTransform kMesh(btQuaternion(btVector3(1, 2, -1).normalized(), btScalar(0.8)),
                        btVector3(3, btScalar(-1.5), 2));

/// A box away from the origin of its mesh, whose inertia is that of a turned one, so that no axis of its
/// principal frame is one of the mesh's.
Packing turnedBox(const Vec3d& size, const Vec3d& offset, int n) {
  Packing packing = moved(latticeBox(size, n), offset);
  const btMatrix3x3 turn(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)));
  const double moments[3] = {1, 2, 2.5};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      packing.solid.inertia[3 * i + j] = 0;
      for (int k = 0; k < 3; ++k) packing.solid.inertia[3 * i + j] += turn[i][k] * moments[k] * turn[j][k];
    }
  }
  return packing;
}

std::shared_ptr<const CollisionModel> modelOf(Packing packing) {
  return std::make_shared<CollisionModel>(std::make_shared<const Packing>(std::move(packing)));
}

struct Named {
  const char* name;
  std::shared_ptr<PackingShape> shape;
};

/// The same model in every kind of frame.
std::vector<Named> inAllFrames(const std::shared_ptr<const CollisionModel>& model) {
  const btTransform given(btQuaternion(btVector3(-1, 1, 2).normalized(), 2), btVector3(1, 5, -2) / 10);
  return {{"principal", std::make_shared<PackingShape>(model)},
          {"mesh", std::make_shared<PackingShape>(model, PackingShape::Frame::mesh)},
          {"given", std::make_shared<PackingShape>(model, given)}};
}

struct Corners : btTriangleCallback {
  void processTriangle(btVector3* triangle, int, int) override {
    all.insert(all.end(), triangle, triangle + 3);
  }
  std::vector<btVector3> all;
};

TEST(Frame, BadOnesAreErrors) {
  const auto model = modelOf(latticeBox({1, 1, 1}, 2));
  const auto codeOf = [&](const btTransform& frame) {
    try {
      PackingShape shape(model, frame);
    } catch (const Error& error) {
      return error.code();
    }
    ADD_FAILURE() << "no error";
    return ErrorCode::cancelled;
  };
  const btMatrix3x3 mirror(1, 0, 0, 0, 1, 0, 0, 0, -1), larger(2, 0, 0, 0, 2, 0, 0, 0, 2);
  EXPECT_EQ(codeOf(btTransform(mirror)), ErrorCode::bad_argument);
  EXPECT_EQ(codeOf(btTransform(larger)), ErrorCode::bad_argument);
  btTransform lost = btTransform::getIdentity();
  lost.setOrigin(btVector3(0, btScalar(std::nan("")), 0));
  EXPECT_EQ(codeOf(lost), ErrorCode::not_finite);
  EXPECT_THROW(PackingShape(nullptr, PackingShape::Frame::mesh), Error);
  EXPECT_THROW(PackingShape(nullptr, btTransform::getIdentity()), Error);
}

TEST(Frame, OfTheMeshIsWhereTheMeshIs) {
  const PackingShape shape(modelOf(turnedBox({1, 2, 3}, {4, 5, 6}, 2)), PackingShape::Frame::mesh);
  EXPECT_EQ(shape.meshToBody(), btTransform::getIdentity());
  EXPECT_EQ(shape.bodyTransform(kMesh), kMesh);
  EXPECT_EQ(shape.meshTransform(kMesh), kMesh);
  btVector3 min, max;
  shape.getAabb(btTransform::getIdentity(), min, max);
  EXPECT_LT(min.distance(btVector3(btScalar(3.5), 4, btScalar(4.5))), 1e-5);
  EXPECT_LT(max.distance(btVector3(btScalar(4.5), 6, btScalar(7.5))), 1e-5);
}

TEST(Frame, TheMeshIsDrawnWhereItsTransformSays) {
  Packing packing = turnedBox({1, 2, 3}, {0.5, -0.4, 0.3}, 2);
  packing.origin = {20, -10, 5};
  const auto model = modelOf(packing);
  for (const Named& in : inAllFrames(model)) {
    for (const btScalar scale : {btScalar(1), btScalar(2.5)}) {
      in.shape->setLocalScaling(btVector3(scale, scale, scale));
      const btTransform body = in.shape->bodyTransform(kMesh);
      const btTransform back = in.shape->meshTransform(body);
      EXPECT_LT(back.getOrigin().distance(kMesh.getOrigin()), 2e-5) << in.name;
      const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
      Corners corners;
      in.shape->processAllTriangles(&corners, -far, far);
      ASSERT_EQ(corners.all.size(), 3 * packing.surface.triangles.size());
      for (const auto& v : packing.surface.vertices) {
        const btVector3 mesh_vertex(btScalar(v[0] + packing.origin[0]), btScalar(v[1] + packing.origin[1]),
                                    btScalar(v[2] + packing.origin[2]));
        const btVector3 expected = kMesh * (scale * mesh_vertex);
        btScalar nearest = BT_LARGE_FLOAT;
        for (const btVector3& corner : corners.all)
          nearest = btMin(nearest, (body * corner).distance(expected));
        EXPECT_LT(nearest, 4e-5) << in.name << " " << scale;
      }
    }
  }
}

TEST(Frame, ABulletMotionStateTakesAndGivesThePlacesOfTheMesh) {
  for (const Named& in : inAllFrames(modelOf(turnedBox({1, 2, 3}, {4, 5, 6}, 2)))) {
    in.shape->setLocalScaling(btVector3(2, 2, 2));
    btDefaultMotionState state(kMesh, in.shape->meshToBody());
    btTransform body;
    state.getWorldTransform(body);
    EXPECT_LT(body.getOrigin().distance(in.shape->bodyTransform(kMesh).getOrigin()), 1e-5) << in.name;
    state.setWorldTransform(in.shape->bodyTransform(btTransform::getIdentity()));
    EXPECT_LT(state.m_graphicsWorldTrans.getOrigin().length(), 1e-5) << in.name;
  }
}

TEST(Frame, BoundsHoldTheSolid) {
  const Packing packing = turnedBox({1, 0.5, 0.25}, {0.3, -0.2, 0.1}, 3);
  for (const Named& in : inAllFrames(modelOf(packing))) {
    in.shape->setLocalScaling(btVector3(2, 2, 2));
    in.shape->setMargin(btScalar(0.1));
    btVector3 min, max, centre;
    btScalar radius;
    in.shape->getAabb(in.shape->bodyTransform(kMesh), min, max);
    in.shape->getBoundingSphere(centre, radius);
    for (const auto& v : packing.surface.vertices) {
      const btVector3 scaled = 2 * btVector3(v[0], v[1], v[2]);
      const btVector3 world = kMesh * scaled, local = in.shape->meshToBody() * scaled;
      for (int k = 0; k < 3; ++k) {
        EXPECT_GE(world[k] - 0.1, min[k] - 1e-5) << in.name;
        EXPECT_LE(world[k] + 0.1, max[k] + 1e-5) << in.name;
      }
      EXPECT_LE(local.distance(centre) + 0.1, radius + 1e-5) << in.name;
      EXPECT_LE(local.length() + 0.1, in.shape->getAngularMotionDisc() + 1e-5) << in.name;
    }
  }
}

TEST(Frame, InertiaIsAboutTheAxesThroughItsOrigin) {
  // A homogeneous box of sizes a, b, c and mass m has m (b^2 + c^2) / 12, ... about its centre.
  const auto model = modelOf(moved(latticeBox({1, 2, 3}, 2), {4, 5, 6}));
  const auto inertiaIn = [&](const PackingShape& shape) {
    btVector3 inertia;
    shape.calculateLocalInertia(6, inertia);
    return inertia;
  };
  const btVector3 own(btScalar(6.5), 5, btScalar(2.5));
  EXPECT_LT(inertiaIn(PackingShape(model)).distance(own), 1e-4);
  const btVector3 moved_on = own + 6 * btVector3(25 + 36, 16 + 36, 16 + 25);
  EXPECT_LT(inertiaIn(PackingShape(model, PackingShape::Frame::mesh)).distance(moved_on), 2e-3);
  // Turned about its own centre, by a quarter and an eighth about z.
  const auto turned = [&](btScalar angle) {
    const btTransform turn(btQuaternion(btVector3(0, 0, 1), angle));
    return turn * btTransform(btQuaternion::getIdentity(), -btVector3(4, 5, 6));
  };
  EXPECT_LT(inertiaIn(PackingShape(model, turned(SIMD_HALF_PI)))
                .distance(btVector3(5, btScalar(6.5), btScalar(2.5))),
            1e-4);
  PackingShape eighth(model, turned(SIMD_HALF_PI / 2));
  EXPECT_LT(inertiaIn(eighth).distance(btVector3(btScalar(5.75), btScalar(5.75), btScalar(2.5))), 1e-4);
  eighth.setLocalScaling(btVector3(2, 2, 2));
  EXPECT_LT(inertiaIn(eighth).distance(4 * btVector3(btScalar(5.75), btScalar(5.75), btScalar(2.5))), 4e-4);
}

/// What the law of contact takes for the size of a body must not depend on where the origin lies.
TEST(Frame, TheContactThresholdDoesNotFollowTheFrame) {
  const auto shapes = inAllFrames(modelOf(turnedBox({1, 1, 1}, {40, 0, 0}, 1)));
  for (const Named& in : shapes)
    EXPECT_EQ(in.shape->getContactBreakingThreshold(btScalar(0.02)),
              shapes[0].shape->getContactBreakingThreshold(btScalar(0.02)));
}

TEST(Frame, SavedSpheresAreInIt) {
  struct Recorder : btDefaultSerializer {
    void finalizeChunk(btChunk* chunk, const char* type, int code, void* pointer) override {
      if (std::string(type) == "btCompoundShapeChildData") {
        const auto* children = static_cast<const btCompoundShapeChildData*>(chunk->m_oldPtr);
        for (int i = 0; i < chunk->m_number; ++i) {
          btVector3 at;
          at.deSerializeFloat(children[i].m_transform.m_origin);
          places.push_back(at);
        }
      }
      btDefaultSerializer::finalizeChunk(chunk, type, code, pointer);
    }
    std::vector<btVector3> places;
  };
  const Packing packing = turnedBox({1, 2, 3}, {4, 5, 6}, 2);
  for (const Named& in : inAllFrames(modelOf(packing))) {
    in.shape->setLocalScaling(btVector3(2, 2, 2));
    Recorder recorder;
    recorder.startSerialization();
    in.shape->serializeSingleShape(&recorder);
    recorder.finishSerialization();
    ASSERT_EQ(recorder.places.size(), packing.spheres.size());
    for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
      const Sphere& s = packing.spheres[i];
      const btVector3 expected = in.shape->meshToBody() * (2 * btVector3(s.x, s.y, s.z));
      EXPECT_LT(recorder.places[i].distance(expected), 2e-5) << in.name;
    }
  }
}

TEST(Frame, RaysHitTheMeshWhereItIs) {
  const btTransform upright(btQuaternion::getIdentity(), btVector3(3, btScalar(-1.5), 2));
  for (const Named& in : inAllFrames(modelOf(turnedBox({1, 1, 1}, {4, 5, 6}, 2)))) {
    TestWorld world;
    const btTransform body = in.shape->bodyTransform(upright);
    world.add(in.shape, 0, body.getOrigin(), body.getRotation());
    world.world.updateAabbs();
    const btVector3 above(btScalar(7.1), btScalar(3.6), 20), below(btScalar(7.1), btScalar(3.6), 0);
    btCollisionWorld::ClosestRayResultCallback ray(above, below);
    world.world.rayTest(above, below, ray);
    ASSERT_TRUE(ray.hasHit()) << in.name;
    EXPECT_NEAR(ray.m_hitPointWorld.z(), 8.5, 1e-4) << in.name;
  }
}

/// One look at two bodies that stand still: what differs is rounding, to which all points of contact are the
/// same but for a few millionths of the size.
TEST(Frame, ContactIsTheSameInAny) {
  const Packing packing = turnedBox({1, 1, 1}, {0.7, -0.4, 0.2}, 6);
  btVector3 lowest(0, 0, BT_LARGE_FLOAT);  // corner, which goes 0.05 deep
  for (const auto& v : packing.surface.vertices) {
    const btVector3 corner = kMesh * btVector3(v[0], v[1], v[2]);
    if (corner.z() < lowest.z()) lowest = corner;
  }
  const auto model = modelOf(packing);
  for (const char* kind : {"plane", "box", "sphere", "convex_hull", "triangle_mesh", "terrain", "packing"}) {
    std::vector<PairOverlap> found;
    std::vector<int> points;
    for (const Named& in : inAllFrames(model)) {
      BulletShape ground;
      if (std::string(kind) == "packing") {
        ground.shape = makeShape(latticeBox({4, 4, 2}, 8));
        ground.place.setOrigin(btVector3(0, 0, -1));
      } else {
        ground = makeBulletShape(kind);
      }
      TestWorld world;
      world.add(ground.shape, 0, ground.place.getOrigin(), ground.place.getRotation());
      btTransform mesh = kMesh;
      mesh.getOrigin() += btVector3(btScalar(0.013), btScalar(0.007), btScalar(-0.05)) - lowest;
      const btTransform body = in.shape->bodyTransform(mesh);
      world.add(in.shape, 1, body.getOrigin(), body.getRotation());
      world.world.performDiscreteCollisionDetection();
      const std::vector<PairOverlap> pairs = pairOverlaps(&world.dispatcher);
      ASSERT_EQ(pairs.size(), 1u) << kind << " " << in.name;
      found.push_back(pairs[0]);
      points.push_back(world.contactCount());
    }
    EXPECT_GT(found[0].depth, 0.01) << kind;
    for (std::size_t i = 1; i < found.size(); ++i) {
      EXPECT_EQ(points[i], points[0]) << kind;
      EXPECT_NEAR(found[i].depth, found[0].depth, 1e-5) << kind;
      EXPECT_NEAR(found[i].volume, found[0].volume, 1e-4 * found[0].volume + 1e-9) << kind;
      EXPECT_LT(found[i].centroid.distance(found[0].centroid), 1e-4) << kind;
    }
  }
}

/// The same body twice: a packing in the mesh's frame, and one in the principal frame that a compound moves
/// there. Both are let go where they touch, for a compound has its first contact later. They slide as far as
/// Coulomb's friction lets them, v^2 / (2 mu g). In single precision rounding decides when a corner sticks,
/// which makes a hundredth of that way.
TEST(Frame, MovesAsTheChildOfACompound) {
  const auto model = modelOf(turnedBox({1, 1, 1}, {0.1, -0.1, 0.05}, 6));
  for (const bool on_packing : {false, true}) {
    std::vector<btTransform> places;
    std::vector<PairOverlap> overlaps;
    for (const bool as_child : {false, true}) {
      TestWorld world;
      if (on_packing) {
        world.add(makeShape(latticeBox({4, 4, 2}, 8)), 0, btVector3(0, 0, -1));
      } else {
        world.addFloor();
      }
      PackingShape principal(model);
      std::shared_ptr<btCollisionShape> shape;
      if (as_child) {
        auto compound = std::make_shared<btCompoundShape>();
        compound->addChildShape(principal.bodyTransform(btTransform::getIdentity()), &principal);
        shape = compound;
      } else {
        shape = std::make_shared<PackingShape>(model, PackingShape::Frame::mesh);
      }
      btRigidBody& body = world.add(shape, 1, btVector3(0, 0, btScalar(0.45)));
      body.setMassProps(1, btVector3(1, 1, 1) / 6);
      body.updateInertiaTensor();
      body.setLinearVelocity(btVector3(btScalar(0.5), 0, 0));
      body.setActivationState(DISABLE_DEACTIVATION);
      world.run(1.5, 1.0 / 240);
      places.push_back(body.getWorldTransform());
      const std::vector<PairOverlap> pairs = pairOverlaps(&world.dispatcher);
      ASSERT_EQ(pairs.size(), 1u);
      overlaps.push_back(pairs[0]);
      if (pairs[0].a == &body) overlaps.back().force *= -1;
      world.world.removeRigidBody(&body);
      world.bodies.pop_back();
    }
    EXPECT_NEAR(places[0].getOrigin().z(), 0.45, 1e-3);
    const double way = 0.5 * 0.5 / (2 * 0.5 * 0.5 * 9.81);
    for (const btTransform& place : places) EXPECT_NEAR(place.getOrigin().x(), way, 0.04 * way) << on_packing;
    btVector3 apart = places[0].getOrigin() - places[1].getOrigin();
    EXPECT_LT(btFabs(apart.x()), sizeof(btScalar) == sizeof(float) ? 0.02 * way : 1e-5) << on_packing;
    apart.setX(0);
    EXPECT_LT(apart.length(), 1e-5) << on_packing;
    for (int i = 0; i < 3; ++i)
      EXPECT_LT(places[0].getBasis()[i].distance(places[1].getBasis()[i]), 1e-4) << on_packing;
    // The corners bear it. What the axes may differ by lifts them by half of that.
    EXPECT_NEAR(overlaps[0].depth, overlaps[1].depth, 0.5e-4) << on_packing;
    EXPECT_NEAR(overlaps[0].force.length(), 9.81, 0.05) << on_packing;
    EXPECT_LT(overlaps[0].force.distance(overlaps[1].force), 0.05) << on_packing;
  }
}

/// A kinematic body in the mesh's frame carries what lies on it.
TEST(Frame, OfAKinematicBodyCarriesOthers) {
  const auto model = modelOf(turnedBox({2, 2, 1}, {3, 2, 1}, 4));
  TestWorld world;
  const auto shape = std::make_shared<PackingShape>(model, PackingShape::Frame::mesh);
  btRigidBody& lift = world.add(shape, 0, btVector3(-3, -2, btScalar(-1.5)));  // its top at 0
  lift.setCollisionFlags(lift.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  lift.setActivationState(DISABLE_DEACTIVATION);
  btRigidBody& load = world.add(makeShape(latticeBox({1, 1, 1}, 6)), 1, btVector3(0, 0, btScalar(0.5)));
  btDefaultMotionState state(lift.getWorldTransform());
  lift.setMotionState(&state);
  for (int i = 0; i < 60; ++i) {
    state.m_graphicsWorldTrans.getOrigin() += btVector3(0, 0, btScalar(0.5) / 60);
    world.run(1.0 / 60);
  }
  world.run(0.5);
  EXPECT_NEAR(load.getWorldTransform().getOrigin().z(), 1, 0.005);
  lift.setMotionState(nullptr);
}

}  // namespace
}  // namespace innersphere::test
