#include "solver/constraint_rows.hpp"

#include <algorithm>
#include <cmath>

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Rows of Bullet's own constraints at most.
constexpr int kRoom = 6;
/// Rows are the same ones as before if their directions are, to this cosine.
constexpr btScalar kSameRow = btScalar(0.9);
/// Steps after which a constraint that is not solved any more is forgotten.
constexpr unsigned kRemembered = 256;

}  // namespace

void ConstraintRows::beginStep(const btContactSolverInfo& info, int substeps) {
  info_ = info;
  substep_ = info.m_timeStep / btScalar(substeps);
}

void ConstraintRows::collect(btTypedConstraint** constraints, int count, SolverBodies& bodies) {
  joints_.clear();
  rows_.clear();
  movable_ = bodies.movable();
  for (int i = 0; i < count; ++i) {
    btTypedConstraint& constraint = *constraints[i];
    if (!constraint.isEnabled()) continue;
    const btScalar borne = constraint.internalGetAppliedImpulse();
    constraint.internalSetAppliedImpulse(0);
    constraint.buildJacobian();
    const int a = bodies.indexOf(constraint.getRigidBodyA()), b = bodies.indexOf(constraint.getRigidBodyB());
    if (a == SolverBodies::kBroken || b == SolverBodies::kBroken) continue;
    if (!bodies.isMovable(a) && !bodies.isMovable(b)) continue;
    btTypedConstraint::btConstraintInfo1 size{};
    constraint.getInfo1(&size);
    Joint& joint = joints_.emplace_back();
    joint = {&constraint, a, b, rows_.size(), 0, std::max(kRoom, size.m_numConstraintRows), 1};
    rows_.resize(rows_.size() + static_cast<std::size_t>(joint.room));
    bodies.follow(a);
    bodies.follow(b);
    if (btJointFeedback* feedback = constraint.getJointFeedback()) {
      feedback->m_appliedForceBodyA.setZero();
      feedback->m_appliedTorqueBodyA.setZero();
      feedback->m_appliedForceBodyB.setZero();
      feedback->m_appliedTorqueBodyB.setZero();
    }
    recall(joint, borne);
  }
}

/// The rows that a constraint had at the end of its last step, with their impulses.
void ConstraintRows::recall(Joint& joint, btScalar borne) {
  Memory& memory = memory_[joint.constraint];
  memory.last_step = step_;
  // Another constraint may have come to lie where one was that is gone.
  if (memory.borne != borne) memory.rows.clear();
  const std::size_t known = std::min(memory.rows.size(), static_cast<std::size_t>(joint.room));
  joint.count = static_cast<int>(known);
  for (std::size_t i = 0; i < known; ++i) {
    Row& row = rows_[joint.begin + i] = memory.rows[i];
    row.sum = 0;
  }
}

/// Asks for as many rows as there are, into the first places of the joint.
void ConstraintRows::ask(Joint& joint, btScalar erp) {
  Row* first = &rows_[joint.begin];
  for (int i = 0; i < joint.count; ++i) {
    Row& row = first[i];
    row.linear_a.setZero();
    row.angular_a.setZero();
    row.linear_b.setZero();
    row.angular_b.setZero();
    row.error = 0;
    row.cfm = info_.m_globalCfm;
    row.low = -SIMD_INFINITY;
    row.high = SIMD_INFINITY;
  }
  btTypedConstraint::btConstraintInfo2 rows;
  rows.fps = 1 / substep_;
  rows.erp = erp;
  rows.m_J1linearAxis = first->linear_a;
  rows.m_J1angularAxis = first->angular_a;
  rows.m_J2linearAxis = first->linear_b;
  rows.m_J2angularAxis = first->angular_b;
  rows.rowskip = sizeof(Row) / sizeof(btScalar);
  rows.m_constraintError = &first->error;
  rows.cfm = &first->cfm;
  rows.m_lowerLimit = &first->low;
  rows.m_upperLimit = &first->high;
  rows.m_numIterations = info_.m_numIterations;
  rows.m_damping = info_.m_damping;
  joint.constraint->getInfo2(&rows);
  joint.damping = rows.m_damping;
}

/// Rows that a limit adds or takes away leave the others their impulses.
void ConstraintRows::match(Joint& joint, const Row* before, int count_before) {
  const auto alike = [](const Row& l, const Row& r) {
    const auto product = [](const Row& x, const Row& y) {
      return x.linear_a.dot(y.linear_a) + x.angular_a.dot(y.angular_a) + x.linear_b.dot(y.linear_b) +
             x.angular_b.dot(y.angular_b);
    };
    const btScalar both = product(l, r);
    return both > 0 && both * both > kSameRow * kSameRow * product(l, l) * product(r, r);
  };
  for (int i = 0; i < joint.count; ++i) {
    Row& row = rows_[joint.begin + static_cast<std::size_t>(i)];
    row.impulse = row.sum = 0;
    const int same = joint.count == count_before ? i : -1;
    for (int j = same < 0 ? 0 : same; j < (same < 0 ? count_before : same + 1); ++j) {
      if (!alike(row, before[j])) continue;
      row.impulse = before[j].impulse;
      row.sum = before[j].sum;
      break;
    }
  }
}

void ConstraintRows::refresh(int index, const SolverBodies& bodies) {
  Joint& joint = joints_[static_cast<std::size_t>(index)];
  btTypedConstraint::btConstraintInfo1 size{};
  joint.constraint->getInfo1(&size);
  // Where a constraint of the user's own grows within a step, its rows stay as they were until the next one.
  if (size.m_numConstraintRows > joint.room) return;
  const int count_before = joint.count;
  Row* const first = &rows_[joint.begin];
  before_.assign(first, first + count_before);
  joint.count = size.m_numConstraintRows;
  if (joint.count == 0) return;
  ask(joint, info_.m_erp / 2);
  for (int i = 0; i < joint.count; ++i) first[i].relaxed = first[i].error;
  ask(joint, info_.m_erp);
  match(joint, before_.data(), count_before);
  const BodyState &a = bodies.state(joint.a), &b = bodies.state(joint.b);
  for (int i = 0; i < joint.count; ++i) {
    Row& row = first[i];
    row.relaxed = 2 * row.relaxed - row.error;
    const btScalar yields = row.linear_a.dot(row.linear_a * a.inverse_mass) +
                            row.linear_b.dot(row.linear_b * b.inverse_mass) +
                            row.angular_a.dot(a.inverseInertiaTimes(row.angular_a)) +
                            row.angular_b.dot(b.inverseInertiaTimes(row.angular_b));
    const bool sound = yields > SIMD_EPSILON && std::isfinite(yields) && std::isfinite(row.error) &&
                       std::isfinite(row.relaxed) && std::isfinite(row.cfm);
    row.mass = sound ? 1 / yields : btScalar(0);
    if (!sound) row.impulse = row.error = row.relaxed = row.cfm = 0;
    // Limits of a motor that has become weaker hold for what it starts with, too.
    row.impulse = std::clamp(row.impulse, std::min(row.low, row.high), row.high);
  }
}

/// Bodies that cannot be moved are shared by threads: they are not written.
void ConstraintRows::push(const Joint& joint, const Row& row, btScalar impulse,
                          std::vector<BodyState>& states) const {
  if (joint.a < movable_)
    states[static_cast<std::size_t>(joint.a)].push(row.linear_a * impulse, row.angular_a * impulse);
  if (joint.b < movable_)
    states[static_cast<std::size_t>(joint.b)].push(row.linear_b * impulse, row.angular_b * impulse);
}

void ConstraintRows::warmStart(int index, std::vector<BodyState>& states) {
  const Joint& joint = joints_[static_cast<std::size_t>(index)];
  for (int i = 0; i < joint.count; ++i) {
    const Row& row = rows_[joint.begin + static_cast<std::size_t>(i)];
    push(joint, row, row.impulse, states);
  }
}

void ConstraintRows::solve(int index, Pass pass, std::vector<BodyState>& states) {
  const Joint& joint = joints_[static_cast<std::size_t>(index)];
  const BodyState& a = states[static_cast<std::size_t>(joint.a)];
  const BodyState& b = states[static_cast<std::size_t>(joint.b)];
  for (int i = 0; i < joint.count; ++i) {
    Row& row = rows_[joint.begin + static_cast<std::size_t>(i)];
    const btScalar speed = row.linear_a.dot(a.velocity) + row.angular_a.dot(a.spin) +
                           row.linear_b.dot(b.velocity) + row.angular_b.dot(b.spin);
    const btScalar wanted = pass == Pass::push ? row.error : row.relaxed;
    const btScalar change = row.mass * (wanted - speed * joint.damping) - row.impulse * row.cfm;
    const btScalar total = btMax(row.low, btMin(row.impulse + change, row.high));
    const btScalar impulse = total - row.impulse;
    row.impulse = total;
    push(joint, row, impulse, states);
    if (pass == Pass::relax) row.sum += total;
  }
}

void ConstraintRows::writeBack() {
  for (Joint& joint : joints_) {
    btTypedConstraint& constraint = *joint.constraint;
    btJointFeedback* feedback = constraint.getJointFeedback();
    Row* const first = &rows_[joint.begin];
    for (int i = 0; i < joint.count; ++i) {
      const Row& row = first[i];
      constraint.internalSetAppliedImpulse(row.sum);
      if (std::fabs(row.sum) >= constraint.getBreakingImpulseThreshold()) constraint.setEnabled(false);
      if (feedback == nullptr) continue;
      const btScalar force = row.sum / info_.m_timeStep;
      feedback->m_appliedForceBodyA += row.linear_a * force;
      feedback->m_appliedTorqueBodyA += row.angular_a * force;
      feedback->m_appliedForceBodyB += row.linear_b * force;
      feedback->m_appliedTorqueBodyB += row.angular_b * force;
    }
    Memory& memory = memory_[joint.constraint];
    memory.rows.assign(first, first + joint.count);
    memory.borne = constraint.internalGetAppliedImpulse();
  }
}

void ConstraintRows::endStep() {
  ++step_;
  if (step_ % kRemembered != 0) return;
  for (auto entry = memory_.begin(); entry != memory_.end();) {
    if (step_ - entry->second.last_step > kRemembered)
      entry = memory_.erase(entry);
    else
      ++entry;
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
