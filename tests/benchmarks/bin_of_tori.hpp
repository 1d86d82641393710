// Tori in a bin, in a Bullet world, with one or another kind of collision shape.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "innersphere/contact_options.hpp"

namespace innersphere::benchmarks {

constexpr double kRing = 1, kTube = 0.3;  // [m]

struct BodyState {
  btTransform transform;
  btVector3 velocity;
  btVector3 spin;
};

/// What one step took [us].
struct StepTime {
  double all = 0;
  double narrow_phase = 0;  ///< Bullet's dispatcher and all that it calls
  double processors = 0;    ///< the step's, of all threads: other programs on the machine do not add to it
};

/// A bin with `bodies` tori above it, in layers. All kinds have the same mass properties.
class BinOfTori {
 public:
  /// `make` gives the shape of body i; the bin's floor and walls are planes. `batched`: BatchedDispatcher.
  BinOfTori(int bodies, bool batched, const std::function<void(btCollisionDispatcher&)>& prepare,
            const std::function<std::shared_ptr<btCollisionShape>(int)>& make, const btVector3& inertia);
  ~BinOfTori();

  /// What a program does with the world after each step; a part of the step in its times.
  std::function<void(btDiscreteDynamicsWorld&)> after_step;

  StepTime step(double dt);
  std::vector<BodyState> state() const;
  void setState(const std::vector<BodyState>& state);
  int contacts() const;

 private:
  /// Measures its narrow phase; else as Bullet's.
  class World : public btDiscreteDynamicsWorld {
   public:
    using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;
    void performDiscreteCollisionDetection() override;
    double narrow_phase = 0;  ///< [us]
  };
  btDefaultCollisionConfiguration configuration_;
  std::unique_ptr<btCollisionDispatcher> dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  World world_;
  std::vector<std::shared_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> walls_, bodies_;
};

}  // namespace innersphere::benchmarks
