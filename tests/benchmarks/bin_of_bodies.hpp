// Bodies in a bin, in a Bullet world, with one or another kind of collision shape and solver.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <btBulletDynamicsCommon.h>

#include "innersphere/contact_options.hpp"

namespace innersphere::benchmarks {

/// As an option of a program names them.
inline const std::map<std::string, Backend> kBackends{
    {"auto", Backend::automatic}, {"cpu", Backend::cpu}, {"cuda", Backend::cuda}};

constexpr double kRing = 1, kTube = 0.3;  ///< of a torus [m]

struct BodyState {
  btTransform transform;
  btVector3 velocity;
  btVector3 spin;
};

/// What one step took [us].
struct StepTime {
  double all = 0;
  double narrow_phase = 0;  ///< Bullet's dispatcher and all that it calls
  double solver = 0;        ///< with Bullet's search for islands
  double processors = 0;    ///< the step's, of all threads: other programs on the machine do not add to it
};

struct BinOptions {
  int bodies = 20;
  /// Between two columns, and two layers, of bodies as they begin [m]; as tori need it.
  double pitch = 2 * (kRing + kTube) + 0.1, layer = 1.2;
  bool batched = false;  ///< with a BatchedDispatcher
  std::function<void(btDiscreteDynamicsWorld&)> prepare = [](btDiscreteDynamicsWorld&) {};
  std::function<std::shared_ptr<btCollisionShape>(int)> make;  ///< the shape of body i
  btVector3 inertia{1, 1, 1};                                  ///< of 1 kg
  std::shared_ptr<btConstraintSolver> solver = std::make_shared<btSequentialImpulseConstraintSolver>();
};

/// A bin of planes with bodies above it, in layers. Nothing sleeps.
class BinOfBodies {
 public:
  explicit BinOfBodies(const BinOptions& options);
  ~BinOfBodies();

  /// What a program does with the world after each step; a part of the step in its times.
  std::function<void(btDiscreteDynamicsWorld&)> after_step;

  /// Not to: the solver gets all bodies at once, and Bullet looks for no islands.
  void splitIslands(bool split) { world_.getSimulationIslandManager()->setSplitIslands(split); }
  /// The world's solver from now on.
  void solveWith(std::shared_ptr<btConstraintSolver> solver);
  StepTime step(double dt);
  std::vector<BodyState> state() const;
  void setState(const std::vector<BodyState>& state);
  int contacts() const;

 private:
  /// Measures its narrow phase and its solver; else as Bullet's.
  class World : public btDiscreteDynamicsWorld {
   public:
    using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;
    void performDiscreteCollisionDetection() override;
    void solveConstraints(btContactSolverInfo& info) override;
    double narrow_phase = 0, solver = 0;  ///< [us]
  };
  btDefaultCollisionConfiguration configuration_;
  std::unique_ptr<btCollisionDispatcher> dispatcher_;
  btDbvtBroadphase broadphase_;
  std::shared_ptr<btConstraintSolver> solver_;
  World world_;
  std::vector<std::shared_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> walls_, bodies_;
};

}  // namespace innersphere::benchmarks
