#include "innersphere/substep_solver.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include "common/body_name.hpp"
#include "common/log.hpp"
#include "innersphere/error.hpp"
#include "solver/colouring.hpp"
#include "solver/constraint_rows.hpp"
#include "solver/contact_rows.hpp"
#include "solver/crew.hpp"
#include "solver/solver_bodies.hpp"
#include "solver/substep_count.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// What a part for a thread has at least, and what makes a thread worth calling.
constexpr int kJoints = 2, kBodies = 16, kManifolds = 32, kPairsForThread = 128;
/// Passes that push in a substep, at most, and that take speed back. What is light, between what is heavy and
/// the ground, hands on a part of an impact in each.
constexpr int kMostPasses = 10;

void checkSubsteps(const SubstepOptions& options) {
  constexpr int kMost = 1000;
  if (options.substeps < 0 || options.substeps > kMost)
    throw Error(ErrorCode::bad_argument, "SubstepOptions::substeps is 0, or from 1 to 1000.");
  if (options.most < 1 || options.most > kMost)
    throw Error(ErrorCode::bad_argument, "SubstepOptions::most is from 1 to 1000.");
  if (!(options.longest > 0)) throw Error(ErrorCode::bad_argument, "SubstepOptions::longest is above 0.");
  if (!(options.depth > 0)) throw Error(ErrorCode::bad_argument, "SubstepOptions::depth is above 0.");
}

}  // namespace

class SubstepSolver::Impl {
 public:
  SubstepOptions options;
  int last_substeps = 0;
  std::mutex mutex;  ///< worlds that share the solver wait for each other

  void solve(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds, int manifold_count,
             btTypedConstraint** constraints, int constraint_count, const btContactSolverInfo& info);
  void beginStep();
  void endStep();
  void reset() {
    contacts_.forget();
    constraints_.forget();
  }

 private:
  int arrange(btTypedConstraint** constraints, int count, const btContactSolverInfo& info);
  void step(btScalar substep);
  void pass(Pass pass);
  template <typename Joint, typename Block>
  void forEachRow(const Joint& joint, const Block& block);
  template <typename Work>
  void forEachBlock(const Work& work);
  void report();

  SolverBodies bodies_;
  ContactRows contacts_;
  ConstraintRows constraints_;
  Colouring colouring_;
  Crew crew_;
  bool called_ = false;  ///< ever
  bool reported_ = false, reported_world_ = false;
};

void SubstepSolver::Impl::beginStep() {
  last_substeps = 0;
}

/// A btDiscreteDynamicsWorld hands over a group in each step, if only an empty one.
void SubstepSolver::Impl::endStep() {
  constraints_.endStep();
  bodies_.endStep();
  if (called_ || reported_world_) return;
  reported_world_ = true;
  log("SubstepSolver is told of steps, but not given anything to solve: a btMultiBodyDynamicsWorld solves "
      "with a btMultiBodyConstraintSolver of its own. This is said once.");
}

/// Calls for all constraints and for all blocks of contacts, colour by colour.
template <typename Joint, typename Block>
void SubstepSolver::Impl::forEachRow(const Joint& joint, const Block& block) {
  for (const Colour& colour : colouring_.colours()) {
    const auto rows = [&](int part, int parts) {
      const int joints = Crew::boundOf(colour.joints, part + 1, parts);
      for (int i = Crew::boundOf(colour.joints, part, parts); i < joints; ++i)
        joint(colouring_.joints()[static_cast<std::size_t>(colour.first_joint + i)]);
      const int blocks = contacts_.partOf(colour.first_block, colour.blocks, part + 1, parts);
      for (int i = contacts_.partOf(colour.first_block, colour.blocks, part, parts); i < blocks; ++i)
        block(i);
    };
    if (colour.alone)
      rows(0, 1);
    else
      crew_.forEachPart((colour.joints + kJoints - 1) / kJoints + colour.blocks, rows);
  }
}

/// Calls for all blocks at the same time, each by the thread that has it in forEachRow().
template <typename Work>
void SubstepSolver::Impl::forEachBlock(const Work& work) {
  crew_.forEachPart(Crew::kMostThreads, [&](int part, int parts) {
    for (const Colour& colour : colouring_.colours()) {
      const int end = contacts_.partOf(colour.first_block, colour.blocks, part + 1, parts);
      for (int i = contacts_.partOf(colour.first_block, colour.blocks, part, parts); i < end; ++i) work(i);
    }
  });
}

void SubstepSolver::Impl::pass(Pass pass) {
  forEachRow([&](int joint) { constraints_.solve(joint, pass, bodies_.states()); },
             [&](int block) { contacts_.solve(block, pass, bodies_.states()); });
}

void SubstepSolver::Impl::step(btScalar substep) {
  crew_.forEach(bodies_.movable(), kBodies,
                [&](int begin, int end) { bodies_.accelerate(begin, end, substep); });
  // The user's classes are asked by this thread alone.
  for (int i = 0; i < constraints_.count(); ++i) constraints_.refresh(i, bodies_);
  for (const int joint : colouring_.joints()) constraints_.warmStart(joint, bodies_.states());
  if (contacts_.bounces()) forEachBlock([&](int block) { contacts_.findBounces(block, bodies_); });
  int passes = 0;
  do {
    pass(Pass::push);
    ++passes;
  } while (contacts_.takeImpact() && passes < kMostPasses);
  crew_.forEach(bodies_.movable(), kBodies, [&](int begin, int end) { bodies_.move(begin, end, substep); });
  bodies_.moveDriven(substep);
  crew_.forEach(constraints_.count(), kJoints, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) constraints_.refactor(i, bodies_);
  });
  // As many take the speed back that was given to drive bodies apart: what fewer leave of it throws bodies.
  // What arrives is stopped by several, too: by one alone a face that lands flat would slide away.
  bool arrives = contacts_.takeArrival();
  for (int relaxed = 1; relaxed < passes || (arrives && relaxed < kMostPasses); ++relaxed) {
    pass(Pass::relax);
    arrives = contacts_.takeImpact();
  }
  pass(Pass::finish);
}

void SubstepSolver::Impl::solve(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                                int manifold_count, btTypedConstraint** constraints, int constraint_count,
                                const btContactSolverInfo& info) {
  called_ = true;
  const btScalar time_step = info.m_timeStep;
  if (!(time_step > 0) || !std::isfinite(time_step)) return;
  bodies_.begin(body_count, time_step);
  contacts_.begin(manifold_count);
  const int helpers = std::min((manifold_count + constraint_count) / kPairsForThread,
                               tbb::this_task_arena::max_concurrency() - 1);
  crew_.work(helpers, [&] {
    crew_.forEach(body_count, kBodies, [&](int begin, int end) { bodies_.find(begin, end, bodies); });
    bodies_.collect();
    crew_.forEach(bodies_.movable(), kBodies, [&](int begin, int end) { bodies_.fill(begin, end); });
    crew_.forEach(manifold_count, kManifolds,
                  [&](int begin, int end) { contacts_.find(begin, end, manifolds, bodies_); });
    const int substeps = arrange(constraints, constraint_count, info);
    forEachBlock([&](int block) { contacts_.prepare(block, bodies_); });
    forEachRow([](int) {}, [&](int block) { contacts_.carry(block, bodies_.states()); });
    bodies_.startDriven(time_step / btScalar(std::max(1, substeps)));
    for (int i = 0; i < substeps; ++i) step(time_step / btScalar(substeps));
    forEachBlock([&](int block) { contacts_.writeBack(block); });
    constraints_.writeBack();
    crew_.forEach(bodies_.movable(), kBodies, [&](int begin, int end) { bodies_.finish(begin, end); });
  });
  bodies_.release();
  report();
}

/// What one thread does: finds pairs and constraints, and in which order they are solved. Returns the number
/// of substeps.
int SubstepSolver::Impl::arrange(btTypedConstraint** constraints, int count,
                                 const btContactSolverInfo& info) {
  contacts_.collect(bodies_);
  constraints_.collect(constraints, count, bodies_);
  int substeps = 0;
  if (bodies_.movable() > 0)
    substeps = substepsFor(options, info.m_timeStep, bodies_, contacts_.pairs(), constraints_);
  last_substeps = std::max(last_substeps, substeps);
  contacts_.beginStep(info, std::max(1, substeps), options.depth);
  constraints_.beginStep(info, std::max(1, substeps));
  colouring_.colour(bodies_, constraints_, contacts_);
  return substeps;
}

void SubstepSolver::Impl::report() {
  if (reported_) return;
  const btRigidBody* body = bodies_.broken();
  if (body == nullptr && contacts_.broken() == 0 && constraints_.broken() == 0) return;
  reported_ = true;
  std::string message =
      "SubstepSolver leaves out bodies, contacts and rows of constraints whose velocities, forces, places or "
      "properties are, or have become, infinite or undefined: such bodies are stopped, and nothing touches "
      "them. ";
  if (body != nullptr) message += "The first such body has " + numbersOf(*body) + ". ";
  log(message + "This is said once.");
}

SubstepSolver::SubstepSolver(const SubstepOptions& options) : impl_(std::make_unique<Impl>()) {
  setOptions(options);
}
SubstepSolver::~SubstepSolver() = default;

const SubstepOptions& SubstepSolver::options() const {
  return impl_->options;
}

void SubstepSolver::setOptions(const SubstepOptions& options) {
  checkSubsteps(options);
  impl_->options = options;
}

int SubstepSolver::substeps() const {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->last_substeps;
}

void SubstepSolver::prepareSolve(int, int) {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  impl_->beginStep();
}

btScalar SubstepSolver::solveGroup(btCollisionObject** bodies, int body_count,
                                   btPersistentManifold** manifolds, int manifold_count,
                                   btTypedConstraint** constraints, int constraint_count,
                                   const btContactSolverInfo& info, btIDebugDraw*, btDispatcher*) {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  impl_->solve(bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info);
  return 0;
}

void SubstepSolver::allSolved(const btContactSolverInfo&, btIDebugDraw*) {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  impl_->endStep();
}

void SubstepSolver::reset() {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  impl_->reset();
}

btConstraintSolverType SubstepSolver::getSolverType() const {
  return BT_SEQUENTIAL_IMPULSE_SOLVER;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
