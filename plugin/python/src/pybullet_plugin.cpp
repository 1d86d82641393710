#include "pybullet_plugin.hpp"

#include <unistd.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include "innersphere/packing_collision_algorithm.hpp"
#include "pybullet_interface.hpp"
#include "pybullet_world.hpp"

namespace innersphere::pybullet {
namespace {

/// Jobs that wait for the server. Clients may have servers in several threads.
struct Jobs {
  std::mutex mutex;
  std::map<int, std::shared_ptr<Job>> waiting;
  int last = 0;
};

Jobs& jobs() {
  static Jobs& all = *new Jobs;  // never destroyed: PyBullet may unload plug-ins at exit
  return all;
}

std::shared_ptr<Job> take(int number) {
  const std::lock_guard lock(jobs().mutex);
  const auto found = jobs().waiting.find(number);
  if (found == jobs().waiting.end()) return nullptr;
  std::shared_ptr<Job> job = found->second;
  jobs().waiting.erase(found);
  return job;
}

}  // namespace

int announce(std::shared_ptr<Job> job) {
  const std::lock_guard lock(jobs().mutex);
  jobs().waiting[++jobs().last] = std::move(job);
  return jobs().last;
}

void withdraw(int number) {
  take(number);
}

// At the end of a connection the world has gone before; the registration is then dropped without touching it.
void Plugin::release() {
  attached_ = false;
  std::string why;
  btMultiBodyDynamicsWorld* world = findWorld(command_processor_, why);
  if (world == nullptr || !PackingCollisionAlgorithm::isRegistered(world->getDispatcher())) {
    if (dispatcher_ != nullptr) PackingCollisionAlgorithm::forget(dispatcher_);
    dispatcher_ = nullptr;
    return;
  }
  for (int i = 0; i < world->getNumCollisionObjects(); ++i) {
    btCollisionObject& object = *world->getCollisionObjectArray()[i];
    for (const Given& one : given_) {
      if (object.getCollisionShape() != one.shape.get()) continue;
      swapShape(*world, object, one.before);
      break;
    }
  }
  PackingCollisionAlgorithm::unregisterAlgorithm(world->getDispatcher());
  setSolver(*world, std::nullopt);
  dispatcher_ = nullptr;
  given_.clear();
}

void Plugin::setOptions(const Options& options) {
  apply(find(), options);
  options_ = options;
  attached_ = true;
}

/// Throws before anything is changed.
void Plugin::apply(btMultiBodyDynamicsWorld& world, const Options& options) {
  // Where it is not registered, the dispatcher of before was that of a world that has been reset.
  if (dispatcher_ != nullptr && !PackingCollisionAlgorithm::isRegistered(world.getDispatcher())) {
    PackingCollisionAlgorithm::forget(dispatcher_);
    dispatcher_ = nullptr;
  }
  if (options.substeps && world.getWorldType() == BT_DEFORMABLE_MULTIBODY_DYNAMICS_WORLD)
    throw std::invalid_argument("solver 'substep' does not solve worlds of deformable bodies");
  if (!PackingCollisionAlgorithm::isRegistered(world.getDispatcher())) ++worlds_;
  PackingCollisionAlgorithm::registerAlgorithm(world, options.contacts);
  dispatcher_ = world.getDispatcher();
  setSolver(world, options.substeps);
  int& mode = world.getSolverInfo().m_solverMode;
  mode = options.two_friction_directions ? mode | SOLVER_USE_2_FRICTION_DIRECTIONS
                                         : mode & ~SOLVER_USE_2_FRICTION_DIRECTIONS;
}

/// Takes a solver of ours out, if it is still there, and puts another one in, if `options` say so. PyBullet's
/// solves what has links.
void Plugin::setSolver(btMultiBodyDynamicsWorld& world, const std::optional<SubstepOptions>& options) {
  int& batch = world.getSolverInfo().m_minimumSolverBatchSize;
  if (solver_ && world.getConstraintSolver() == solver_.get()) {
    world.setMultiBodyConstraintSolver(solver_->others());
    batch = batch_before_;
  }
  solver_.reset();
  if (!options) return;
  auto* own = static_cast<btMultiBodyConstraintSolver*>(world.getConstraintSolver());
  solver_ = std::make_unique<MultiBodySubstepSolver>(*options, own);
  world.setMultiBodyConstraintSolver(solver_.get());
  batch_before_ = std::exchange(batch, -1);
}

btMultiBodyDynamicsWorld& Plugin::find() const {
  std::string why;
  btMultiBodyDynamicsWorld* found = findWorld(command_processor_, why);
  if (found == nullptr) throw std::runtime_error(why);
  return *found;
}

btMultiBodyDynamicsWorld& Plugin::world() {
  if (!attached_) throw std::invalid_argument("innersphere is detached");
  btMultiBodyDynamicsWorld* same = place_.world();
  btMultiBodyDynamicsWorld& found = same != nullptr ? *same : find();
  if (same == nullptr) place_ = WorldPlace(command_processor_, found);
  if (!PackingCollisionAlgorithm::isRegistered(found.getDispatcher())) apply(found, options_);
  return found;
}

btCollisionObject& Plugin::collider(int body, int link) {
  btCollisionObject* object = findCollider(world(), body, link);
  if (object == nullptr) {
    throw std::invalid_argument("body " + std::to_string(body) +
                                (link < 0 ? " has no base that collides"
                                          : " has no link " + std::to_string(link) + " that collides"));
  }
  return *object;
}

btCollisionObject& Plugin::packable(int body, int link) {
  btCollisionObject& object = collider(body, link);
  if (options_.substeps && MultiBodySubstepSolver::isMovingLink(object)) {
    throw std::invalid_argument(
        "link " + std::to_string(link) + " of body " + std::to_string(body) +
        " is in reduced coordinates, which solver 'substep' does not move: make it with "
        "useMaximalCoordinates");
  }
  return object;
}

void Plugin::give(int body, int link, std::unique_ptr<PackingShape> shape) {
  btCollisionObject& object = packable(body, link);
  btMultiBodyDynamicsWorld& found = world();
  dropUnused(found);
  btCollisionShape* before = object.getCollisionShape();
  for (const Given& one : given_) {
    if (one.shape.get() == before) before = one.before;
  }
  swapShape(found, object, shape.get());
  given_.push_back({std::move(shape), before});
}

btTransform Plugin::inertialFrame(int body) {
  const btRigidBody* rigid = btRigidBody::upcast(&collider(body, -1));
  if (rigid == nullptr)
    throw std::invalid_argument("body " + std::to_string(body) + " is not in maximal coordinates");
  std::string why;
  btTransform frame;
  if (!findInertialFrame(command_processor_, client_, body, *rigid, frame, why))
    throw std::runtime_error(why);
  return frame;
}

int Plugin::worldNumber() {
  world();
  return worlds_;
}

void Plugin::dropUnused(btMultiBodyDynamicsWorld& world) {
  std::set<const btCollisionShape*> used;
  for (int i = 0; i < world.getNumCollisionObjects(); ++i)
    used.insert(world.getCollisionObjectArray()[i]->getCollisionShape());
  std::erase_if(given_, [&](const Given& one) { return used.count(one.shape.get()) == 0; });
}

}  // namespace innersphere::pybullet

#define INNERSPHERE_PLUGIN_FUNCTION extern "C" __attribute__((visibility("default")))

INNERSPHERE_PLUGIN_FUNCTION int initPlugin_innersphere(innersphere::pybullet::Context* context) {
  context->user = new innersphere::pybullet::Plugin(*context);
  return innersphere::pybullet::kApiVersion;
}

INNERSPHERE_PLUGIN_FUNCTION void exitPlugin_innersphere(innersphere::pybullet::Context* context) {
  delete static_cast<innersphere::pybullet::Plugin*>(context->user);
  context->user = nullptr;
}

/// The integers are the number of a job, and the process that knows it. Returns 0 if the job was run, and -1
/// if it is unknown.
INNERSPHERE_PLUGIN_FUNCTION int executePluginCommand_innersphere(
    innersphere::pybullet::Context* context, const innersphere::pybullet::Arguments* arguments) {
  using namespace innersphere::pybullet;
  if (arguments->int_count != 2 || arguments->ints[1] != static_cast<int>(getpid())) return -1;
  const std::shared_ptr<Job> job = take(arguments->ints[0]);
  if (!job) return -1;
  try {
    job->work(*static_cast<Plugin*>(context->user));
  } catch (...) {
    job->error = std::current_exception();
  }
  job->done = true;
  return 0;
}
