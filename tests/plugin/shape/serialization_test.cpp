// Worlds with packings in .bullet files.
#include <gtest/gtest.h>

#include <LinearMath/btSerializer.h>
#ifdef INNERSPHERE_BULLET_IMPORTER
#include <BulletWorldImporter/btBulletWorldImporter.h>
#endif

#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

/// Keeps what is written, in the order in which it comes.
struct Recorder : btDefaultSerializer {
  void finalizeChunk(btChunk* chunk, const char* type, int code, void* pointer) override {
    if (code == BT_SHAPE_CODE) {
      const int number = static_cast<const btCollisionShapeData*>(chunk->m_oldPtr)->m_shapeType;
      if (number == SPHERE_SHAPE_PROXYTYPE) ++spheres;
      if (number == COMPOUND_SHAPE_PROXYTYPE)
        compounds.push_back(static_cast<btCompoundShapeData*>(chunk->m_oldPtr));
    }
    btDefaultSerializer::finalizeChunk(chunk, type, code, pointer);
  }
  int spheres = 0;
  std::vector<const btCompoundShapeData*> compounds;
};

TEST(Serialization, IsACompoundOfSpheres) {
  const auto shape = makeShape(latticeBox({1, 1, 1}, 3));
  Recorder recorder;
  recorder.registerNameForPointer(shape.get(), "brick");
  recorder.startSerialization();
  shape->serializeSingleShape(&recorder);
  EXPECT_EQ(recorder.spheres, 27);
  ASSERT_EQ(recorder.compounds.size(), 1u);
  EXPECT_EQ(recorder.compounds[0]->m_numChildShapes, 27);
  EXPECT_NE(recorder.compounds[0]->m_collisionShapeData.m_name, nullptr);
  recorder.finishSerialization();  // frees its chunks
}

TEST(Serialization, StockBulletLoadsAWorld) {
#ifndef INNERSPHERE_BULLET_IMPORTER
  GTEST_SKIP() << "built without Bullet's loader of .bullet files: install libbullet-extras-dev";
#else
  btDefaultSerializer serializer;
  const btVector3 places[2] = {btVector3(0, 0, 3), btVector3(1, 2, btScalar(0.5))};
  {
    TestWorld world;
    const auto shape = makeShape(moved(latticeBox({1, 1, 1}, 4), {5, 0, 0}));
    const auto scaled = makeShape(latticeBox({1, 1, 1}, 4));
    scaled->setLocalScaling(btVector3(2, 2, 2));
    scaled->setSphereCount(8);
    scaled->setMargin(btScalar(0.1));
    world.add(shape, 1, places[0]);
    world.add(shape, 0, places[1]);
    world.add(scaled, 2, btVector3(9, 0, 0));
    world.world.serialize(&serializer);
  }

  btDefaultCollisionConfiguration configuration;  // a Bullet that has never heard of packings
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  btBulletWorldImporter importer(&world);
  std::vector<unsigned char> file(serializer.getBufferPointer(),
                                  serializer.getBufferPointer() + serializer.getCurrentBufferSize());
  ASSERT_TRUE(
      importer.loadFileFromMemory(reinterpret_cast<char*>(file.data()), static_cast<int>(file.size())));
  ASSERT_EQ(importer.getNumRigidBodies(), 3);
  for (int i = 0; i < 2; ++i) {
    const btRigidBody& body = *btRigidBody::upcast(importer.getRigidBodyByIndex(i));
    EXPECT_LT(body.getWorldTransform().getOrigin().distance(places[i]), 1e-6);
    EXPECT_EQ(body.isStaticObject(), i == 1);
    ASSERT_TRUE(body.getCollisionShape()->isCompound());
    EXPECT_EQ(static_cast<const btCompoundShape*>(body.getCollisionShape())->getNumChildShapes(), 64);
    btVector3 min, max;
    body.getCollisionShape()->getAabb(btTransform::getIdentity(), min, max);
    EXPECT_LT((max - btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))).length(), 1e-3);
    EXPECT_LT((min + btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))).length(), 1e-3);
  }
  const auto* compound =
      static_cast<const btCompoundShape*>(importer.getRigidBodyByIndex(2)->getCollisionShape());
  ASSERT_EQ(compound->getNumChildShapes(), 8);
  ASSERT_EQ(compound->getChildShape(0)->getShapeType(), SPHERE_SHAPE_PROXYTYPE);
  EXPECT_NEAR(static_cast<const btSphereShape*>(compound->getChildShape(0))->getRadius(), 0.25 + 0.1, 1e-5);

  // And it collides, as a compound does.
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  btRigidBody floor(0, nullptr, &plane);
  world.addRigidBody(&floor);
  world.setGravity(btVector3(0, 0, -10));
  for (int i = 0; i < 180; ++i) world.stepSimulation(btScalar(1) / 60, 0);
  EXPECT_NEAR(importer.getRigidBodyByIndex(0)->getWorldTransform().getOrigin().z(), 0.5, 0.01);
  world.removeRigidBody(&floor);
  importer.deleteAllData();
#endif
}

}  // namespace
}  // namespace innersphere::test
