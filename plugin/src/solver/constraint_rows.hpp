// Constraints as rows: hinges, sliders, motors, limits, and what users derive from btTypedConstraint.
#pragma once

#include <atomic>
#include <unordered_map>
#include <vector>

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include "solver/contact_rows.hpp"
#include "solver/soft_step.hpp"
#include "solver/solver_bodies.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// The constraints of a group, through getInfo1() and getInfo2(), which are asked in each substep, with the
/// bodies where they are then: so joints turn as exactly as the substep is short. Their step is the substep.
/// Error reduction (ERP) and constraint force mixing (CFM) act in each.
///
/// What reduces an error gives bodies a speed that is not theirs, which passes after the bodies have moved
/// take back. It is told from the speed of motors by asking twice, with half of the error reduction: rows
/// are linear in it. Where a constraint has an error reduction of its own it stays, as with Bullet's solver.
///
/// Rows of a joint that no limit bounds are solved together, exactly: those of a pendulum that is thin for
/// its length all but depend on each other, and one after the other they would need hundreds of passes.
class ConstraintRows {
 public:
  /// Takes the constraints of a group that are enabled.
  void collect(btTypedConstraint** constraints, int count, SolverBodies& bodies);
  /// Takes over what holds for all rows of a step.
  void beginStep(const btContactSolverInfo& info, int substeps);
  int count() const { return static_cast<int>(joints_.size()); }
  /// Returns how many rows of this step were left out because they are not finite.
  int broken() const { return broken_; }
  int bodyA(int joint) const { return joints_[static_cast<std::size_t>(joint)].a; }
  int bodyB(int joint) const { return joints_[static_cast<std::size_t>(joint)].b; }

  /// Asks a constraint for its rows. It keeps the impulses of rows that it had before.
  void refresh(int joint, const SolverBodies& bodies);
  /// Bodies have turned: tells how rows are coupled now. Those of a thin rod that whirls would over-relax.
  void refactor(int joint, const SolverBodies& bodies) {
    const Joint& j = joints_[static_cast<std::size_t>(joint)];
    if (j.count > 0) factor(j, bodies.state(j.a), bodies.state(j.b));
  }
  /// Applies the impulses of the last substep.
  void warmStart(int joint, std::vector<BodyState>& states);
  void solve(int joint, Pass pass, std::vector<BodyState>& states);
  /// Tells constraints what they have borne, breaks those that have borne too much, and remembers the
  /// impulses for the next step.
  void writeBack();

  /// A step ends: impulses of constraints that have not been seen for long are forgotten.
  void endStep();
  void forget() { memory_.clear(); }

 private:
  /// As getInfo2() fills it.
  struct Row {
    btVector3 linear_a, angular_a, linear_b, angular_b;
    btScalar error, cfm, low, high;
    btScalar impulse, sum;  ///< of the substep, of the step [N s]
    btScalar yields;        ///< speed for an impulse [1/kg]
    bool free;              ///< no limit bounds it: it is solved together with the others
    btScalar relaxed;       ///< the error without what reduces that of places
  };
  struct Joint {
    btTypedConstraint* constraint;
    int a, b;
    std::size_t begin;   ///< of its rows
    std::size_t matrix;  ///< of what couples them
    int count, room;
    btScalar damping;
    btScalar limit_share;  ///< of the limits that it names, in a substep
  };
  struct Memory {
    std::vector<Row> rows;
    btScalar borne = 0;  ///< what the constraint was told
    unsigned last_step = 0;
  };

  static void clear(Row& row);
  void factor(const Joint& joint, const BodyState& a, const BodyState& b);
  void solveFree(const Joint& joint, Pass pass, std::vector<BodyState>& states);
  btScalar missing(const Joint& joint, const Row& row, Pass pass, const std::vector<BodyState>& states) const;
  bool hasForces(const Joint& joint);
  void ask(Joint& joint, btScalar erp, btScalar step);
  void match(Joint& joint, const Row* before, int count_before, const BodyState& a, const BodyState& b);
  void recall(Joint& joint, btScalar borne);
  void push(const Joint& joint, const Row& row, btScalar impulse, std::vector<BodyState>& states) const;

  std::vector<Joint> joints_;
  std::vector<Row> rows_, before_, asked_;
  std::vector<btScalar> factors_;  ///< L of L D L^T, and D on its diagonal
  std::vector<btScalar> changes_;  ///< of impulses, a place for each row
  std::unordered_map<const btTypedConstraint*, Memory> memory_;
  btContactSolverInfo info_;
  btScalar substep_ = 0;
  Softness soft_;
  int movable_ = 0;
  std::atomic<int> broken_{0};  ///< by whichever thread finds one
  unsigned step_ = 0;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
