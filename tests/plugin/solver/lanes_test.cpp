// Contacts are solved alike with the instructions of every processor.
#include <gtest/gtest.h>

#include "solver/colouring.hpp"
#include "solver/contact_rows.hpp"
#include "solver/solver_world.hpp"

namespace innersphere::test {
namespace {

/// What contacts make of a pile's velocities.
std::vector<btScalar> solved(SolverWorld& world, bool wide) {
  std::vector<btCollisionObject*> objects;
  for (const auto& body : world.bodies) objects.push_back(body.get());
  std::vector<btPersistentManifold*> manifolds;
  for (int i = 0; i < world.dispatcher.getNumManifolds(); ++i)
    manifolds.push_back(world.dispatcher.getManifoldByIndexInternal(i));
  const int body_count = static_cast<int>(objects.size()),
            manifold_count = static_cast<int>(manifolds.size());
  btContactSolverInfo info;
  SolverBodies bodies;
  ContactRows contacts(wide);
  ConstraintRows constraints;
  Colouring colouring;
  bodies.begin(body_count, info.m_timeStep);
  bodies.find(0, body_count, objects.data());
  bodies.collect();
  bodies.fill(0, bodies.movable());
  contacts.begin(manifold_count);
  contacts.find(0, manifold_count, manifolds.data(), bodies);
  contacts.collect(bodies);
  contacts.beginStep(info, 1, SubstepOptions().depth);
  colouring.colour(bodies, constraints, contacts);
  for (int i = 0; i < contacts.blocks(); ++i) contacts.prepare(i, bodies);
  for (int i = 0; i < contacts.blocks(); ++i) contacts.carry(i, bodies.states());
  bodies.accelerate(0, bodies.movable(), info.m_timeStep);
  for (int i = 0; i < contacts.blocks(); ++i) contacts.findBounces(i, bodies);
  for (const Pass pass : {Pass::push, Pass::relax, Pass::finish}) {
    for (int i = 0; i < contacts.blocks(); ++i) contacts.solve(i, pass, bodies.states());
    bodies.move(0, bodies.movable(), info.m_timeStep);
  }
  std::vector<btScalar> all;
  for (const BodyState& state : bodies.states()) {
    for (const btVector3& v : {state.velocity, state.spin}) all.insert(all.end(), {v.x(), v.y(), v.z()});
    const btQuaternion& q = state.turned;
    all.insert(all.end(), {q.x(), q.y(), q.z(), q.w()});
  }
  for (const auto& body : world.bodies) body->setCompanionId(-1);
  return all;
}

TEST(SubstepLanes, BitsAreTheSameOnAllProcessors) {
  if (!hasWideLanes()) GTEST_SKIP() << "This processor has no AVX2.";
  SolverWorld world;
  fill(world, 5, 4);
  for (const auto& body : world.bodies) {
    body->setRestitution(btScalar(0.5));
    body->setRollingFriction(btScalar(0.01));
  }
  btScalar most = 0;
  for (int i = 0; i < 30; ++i) {
    world.step();
    const std::vector<btScalar> narrow = solved(world, false);
    ASSERT_EQ(solved(world, true), narrow) << i;
    for (const btScalar x : narrow) most = std::max(most, std::fabs(x));
  }
  EXPECT_GT(most, 0);
}

}  // namespace
}  // namespace innersphere::test
