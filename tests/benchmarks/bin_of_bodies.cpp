#include "bin_of_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <random>
#include <utility>

#include "innersphere/batched_dispatcher.hpp"
#include "timing.hpp"

namespace innersphere::benchmarks {

void BinOfBodies::World::performDiscreteCollisionDetection() {
  updateAabbs();
  computeOverlappingPairs();
  narrow_phase += timeOf([&] {
    getDispatcher()->dispatchAllCollisionPairs(getPairCache(), getDispatchInfo(), getDispatcher());
  });
}

void BinOfBodies::World::solveConstraints(btContactSolverInfo& info) {
  solver += timeOf([&] { btDiscreteDynamicsWorld::solveConstraints(info); });
}

BinOfBodies::BinOfBodies(const BinOptions& options)
    : dispatcher_(options.batched ? std::make_unique<BatchedDispatcher<>>(&configuration_)
                                  : std::make_unique<btCollisionDispatcher>(&configuration_)),
      solver_(options.solver),
      world_(dispatcher_.get(), &broadphase_, solver_.get(), &configuration_) {
  options.prepare(world_);
  world_.setGravity(btVector3(0, 0, btScalar(-9.81)));
  const int side = std::max(2, static_cast<int>(std::cbrt(options.bodies)));
  const btScalar pitch = btScalar(options.pitch), half = pitch * btScalar(side) / 2;
  const auto addWall = [&](const btVector3& normal, btScalar at) {
    shapes_.push_back(std::make_shared<btStaticPlaneShape>(normal, at));
    walls_.push_back(std::make_unique<btRigidBody>(btScalar(0), nullptr, shapes_.back().get()));
    world_.addRigidBody(walls_.back().get());
  };
  addWall(btVector3(0, 0, 1), 0);
  for (const int sign : {1, -1}) {
    addWall(btVector3(btScalar(sign), 0, 0), -half);
    addWall(btVector3(0, btScalar(sign), 0), -half);
  }
  std::mt19937 engine(1);
  const auto tilt = [&] { return btScalar(double(engine() % 1000) / 1000 - 0.5); };
  for (int i = 0; i < options.bodies; ++i) {
    shapes_.push_back(options.make(i));
    btRigidBody::btRigidBodyConstructionInfo info(1, nullptr, shapes_.back().get(), options.inertia);
    const int layer = i / (side * side), x = i % side, y = i / side % side;
    info.m_startWorldTransform.setOrigin(btVector3((btScalar(x) + btScalar(0.5)) * pitch - half,
                                                   (btScalar(y) + btScalar(0.5)) * pitch - half,
                                                   btScalar(1 + options.layer * layer)));
    info.m_startWorldTransform.setRotation(btQuaternion(tilt(), tilt(), tilt()));
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(bodies_.back().get());
  }
}

BinOfBodies::~BinOfBodies() {
  for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  for (const auto& wall : walls_) world_.removeRigidBody(wall.get());
}

void BinOfBodies::solveWith(std::shared_ptr<btConstraintSolver> solver) {
  world_.setConstraintSolver(solver.get());
  solver_ = std::move(solver);
}

StepTime BinOfBodies::step(double dt) {
  world_.narrow_phase = world_.solver = 0;
  StepTime time;
  const std::clock_t start = std::clock();
  time.all = timeOf([&] {
    world_.stepSimulation(btScalar(dt), 0);
    if (after_step) after_step(world_);
  });
  time.processors = 1e6 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  time.narrow_phase = world_.narrow_phase;
  time.solver = world_.solver;
  return time;
}

std::vector<BodyState> BinOfBodies::state() const {
  std::vector<BodyState> all;
  for (const auto& body : bodies_) {
    all.push_back({body->getWorldTransform(), body->getLinearVelocity(), body->getAngularVelocity()});
  }
  return all;
}

void BinOfBodies::setState(const std::vector<BodyState>& state) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    bodies_[i]->setCenterOfMassTransform(state[i].transform);
    bodies_[i]->setLinearVelocity(state[i].velocity);
    bodies_[i]->setAngularVelocity(state[i].spin);
  }
}

int BinOfBodies::contacts() const {
  int count = 0;
  for (int i = 0; i < dispatcher_->getNumManifolds(); ++i) {
    count += dispatcher_->getManifoldByIndexInternal(i)->getNumContacts();
  }
  return count;
}

}  // namespace innersphere::benchmarks
