// The plug-in that PyBullet loads: the module itself. It runs jobs that Python has prepared in the thread of
// PyBullet's server.
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "innersphere/contact_options.hpp"
#include "innersphere/multi_body_substep_solver.hpp"
#include "innersphere/packing_shape.hpp"
#include "pybullet_interface.hpp"
#include "pybullet_world.hpp"

namespace innersphere::pybullet {

/// A body's shape that was replaced by a packing.
struct Given {
  std::unique_ptr<PackingShape> shape;
  btCollisionShape* before = nullptr;  ///< PyBullet's
};

/// What attach() was told.
struct Options {
  ContactOptions contacts;
  bool two_friction_directions = true;
  std::optional<SubstepOptions> substeps;  ///< none: PyBullet's own solver
};

/// What is kept for a client from attach() to detach(). Only the server's thread uses it.
class Plugin {
 public:
  explicit Plugin(const Context& context)
      : command_processor_(context.command_processor), client_(context.client) {}
  ~Plugin() { release(); }

  /// Gives bodies their shapes back, and the dispatcher its own functions, if the world is still there.
  void release();

  /// Returns the world as it is. Throws std::runtime_error if it is not understood.
  btMultiBodyDynamicsWorld& find() const;
  /// Attaches: sets options, for this world and those that follow it after a reset.
  void setOptions(const Options& options);
  /// Returns the world, in which packings collide. Throws std::invalid_argument if it was released, and as
  /// find() does.
  btMultiBodyDynamicsWorld& world();
  /// Returns the collision object of a link. Throws std::invalid_argument if there is none.
  btCollisionObject& collider(int body, int link);
  /// Returns the collision object of a link that may have a packing. Throws std::invalid_argument where none
  /// is, or SubstepSolver would not move it.
  btCollisionObject& packable(int body, int link);
  void give(int body, int link, std::unique_ptr<PackingShape> shape);
  /// Returns where the centre of mass and the principal axes of a body in maximal coordinates are in its
  /// base, as PyBullet keeps it. Throws as collider() does, and std::runtime_error if it does not say.
  btTransform inertialFrame(int body);
  /// Returns a number that the world has, and those after the next resets do not.
  int worldNumber();

 private:
  void apply(btMultiBodyDynamicsWorld& world, const Options& options);
  void setSolver(btMultiBodyDynamicsWorld& world, const std::optional<SubstepOptions>& options);
  void dropUnused(btMultiBodyDynamicsWorld& world);

  void* command_processor_;
  void* client_;  ///< by which plug-ins call PyBullet
  Options options_;
  bool attached_ = false;
  WorldPlace place_;                          ///< where the last world was found
  int worlds_ = 0;                            ///< that packings have collided in
  const btDispatcher* dispatcher_ = nullptr;  ///< registered last; it may be gone
  std::vector<Given> given_;
  std::unique_ptr<MultiBodySubstepSolver> solver_;  ///< put into the last world, if asked for
  int batch_before_ = 0;                            ///< m_minimumSolverBatchSize of that world
};

/// Is done once in the thread of PyBullet's server, which may not call Python. Python waits for it, with the
/// GIL.
struct Job {
  std::function<void(Plugin&)> work;
  std::exception_ptr error;
  bool done = false;
};

/// Keeps a job until the server asks for it, and returns its number.
int announce(std::shared_ptr<Job> job);
/// Drops a job that the server may not have asked for.
void withdraw(int number);

}  // namespace innersphere::pybullet
