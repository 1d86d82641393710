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
/// A row of which no more than this share is left by the others is one of them.
constexpr btScalar kRedundant = 32 * SIMD_EPSILON;

int rowsOf(btTypedConstraint& constraint) {
  btTypedConstraint::btConstraintInfo1 size{};
  constraint.getInfo1(&size);
  return std::max(0, size.m_numConstraintRows);
}

}  // namespace

void ConstraintRows::beginStep(const btContactSolverInfo& info, int substeps) {
  info_ = info;
  broken_ = 0;
  substep_ = info.m_timeStep / btScalar(substeps);
  // What gives way as fast as the world's error reduction says.
  const btScalar erp = std::clamp(info.m_erp, btScalar(0.01), btScalar(1));
  soft_ = Softness::ofPhase(kJointPhase, kJointPhase * (1 / erp - 1) / 2, substep_);
  for (Joint& joint : joints_) joint.limit_share = hasForces(joint) ? btScalar(1) : 1 / btScalar(substeps);
}

/// Limits are impulses. Some constraints form them of a force and the step, some have impulses of a step.
bool ConstraintRows::hasForces(const Joint& joint) {
  Joint asked = joint;
  asked.count = rowsOf(*joint.constraint);
  if (asked.count > joint.room) return false;
  const auto begin = rows_.begin() + static_cast<std::ptrdiff_t>(joint.begin);
  const auto known = [](btScalar limit) { return limit != 0 && std::fabs(limit) < SIMD_INFINITY; };
  before_.assign(begin, begin + joint.room);
  ask(asked, info_.m_erp, info_.m_timeStep);
  asked_.assign(begin, begin + asked.count);
  ask(asked, info_.m_erp, info_.m_timeStep / 2);
  bool follow = false;
  for (int i = 0; i < asked.count; ++i) {
    const Row &whole = asked_[static_cast<std::size_t>(i)], &half = begin[i];
    follow = follow || (known(whole.high) && whole.high != half.high) ||
             (known(whole.low) && whole.low != half.low);
  }
  std::copy(before_.begin(), before_.end(), begin);
  return follow;
}

void ConstraintRows::collect(btTypedConstraint** constraints, int count, SolverBodies& bodies) {
  joints_.clear();
  rows_.clear();
  factors_.clear();
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
    Joint& joint = joints_.emplace_back();
    joint = {&constraint, a, b, rows_.size(), factors_.size(), 0, std::max(kRoom, rowsOf(constraint)), 1, 1};
    const std::size_t room = static_cast<std::size_t>(joint.room);
    rows_.resize(rows_.size() + room);
    factors_.resize(factors_.size() + room * room);
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
  changes_.resize(rows_.size());
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

void ConstraintRows::clear(Row& row) {
  row.linear_a.setZero();
  row.angular_a.setZero();
  row.linear_b.setZero();
  row.angular_b.setZero();
  row.error = 0;
}

/// Asks for as many rows as there are, into the first places of the joint.
void ConstraintRows::ask(Joint& joint, btScalar erp, btScalar step) {
  Row* first = &rows_[joint.begin];
  for (int i = 0; i < joint.count; ++i) {
    Row& row = first[i];
    clear(row);
    row.cfm = info_.m_globalCfm;
    row.low = -SIMD_INFINITY;
    row.high = SIMD_INFINITY;
  }
  btTypedConstraint::btConstraintInfo2 rows;
  rows.fps = 1 / step;
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
/// Rows turn with the bodies. J v is to hold in the middle of the substep, half a turn of J further: then a
/// pendulum keeps its energy, as with SHAKE (Ryckaert et al., J. Comput. Phys. 23, 1977). At the start it
/// would lose a part that is of first order in the substep.
void ConstraintRows::match(Joint& joint, const Row* before, int count_before, const BodyState& a,
                           const BodyState& b) {
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
      const btScalar turned = (row.linear_a - before[j].linear_a).dot(a.velocity) +
                              (row.angular_a - before[j].angular_a).dot(a.spin) +
                              (row.linear_b - before[j].linear_b).dot(b.velocity) +
                              (row.angular_b - before[j].angular_b).dot(b.spin);
      row.error -= turned / 2;
      row.relaxed -= turned / 2;
      break;
    }
  }
}

void ConstraintRows::refresh(int index, const SolverBodies& bodies) {
  Joint& joint = joints_[static_cast<std::size_t>(index)];
  const int count = rowsOf(*joint.constraint);
  // Where a constraint of the user's own grows within a step, its rows stay as they were until the next one.
  if (count > joint.room) return;
  const int count_before = joint.count;
  Row* const first = &rows_[joint.begin];
  before_.assign(first, first + count_before);
  joint.count = count;
  if (joint.count == 0) return;
  ask(joint, info_.m_erp / 2, substep_);
  for (int i = 0; i < joint.count; ++i) first[i].relaxed = first[i].error;
  ask(joint, info_.m_erp, substep_);
  for (int i = 0; i < joint.count; ++i) {
    Row& row = first[i];
    row.relaxed = 2 * row.relaxed - row.error;
    row.free = row.low <= -SIMD_INFINITY && row.high >= SIMD_INFINITY;
    row.low *= joint.limit_share;
    row.high *= joint.limit_share;
  }
  match(joint, before_.data(), count_before, bodies.state(joint.a), bodies.state(joint.b));
  // Limits of a motor that has become weaker hold for what it starts with, too.
  for (int i = 0; i < joint.count; ++i)
    first[i].impulse = btMax(first[i].low, btMin(first[i].impulse, first[i].high));
  factor(joint, bodies.state(joint.a), bodies.state(joint.b));
}

/// What couples the rows, as L D L^T. A row that says what others say already, or nothing, or what is not
/// finite, is left out.
void ConstraintRows::factor(const Joint& joint, const BodyState& a, const BodyState& b) {
  const std::size_t size = static_cast<std::size_t>(joint.count);
  btScalar* const factors = &factors_[joint.matrix];
  const auto at = [&](std::size_t row, std::size_t column) -> btScalar& {
    return factors[row * size + column];
  };
  for (std::size_t i = 0; i < size; ++i) {
    Row& row = rows_[joint.begin + i];
    const btVector3 linear_a = row.linear_a * a.inverse_mass, linear_b = row.linear_b * b.inverse_mass;
    const btVector3 angular_a = a.inverseInertiaTimes(row.angular_a),
                    angular_b = b.inverseInertiaTimes(row.angular_b);
    const auto coupledTo = [&](const Row& other) {
      return other.linear_a.dot(linear_a) + other.linear_b.dot(linear_b) + other.angular_a.dot(angular_a) +
             other.angular_b.dot(angular_b);
    };
    row.yields = coupledTo(row);
    const bool sound = std::isfinite(row.yields) && std::isfinite(row.relaxed) && std::isfinite(row.cfm) &&
                       std::isfinite(row.impulse) && !std::isnan(row.low) && !std::isnan(row.high);
    if (!sound) {
      clear(row);
      row.yields = row.sum = 0;
      ++broken_;
    }
    if (!(row.yields > 0)) row.yields = row.impulse = 0;
    at(i, i) = 0;
    if (row.yields == 0 || !row.free) continue;
    btScalar rest = row.yields;
    for (std::size_t j = 0; j < i; ++j) {
      if (at(j, j) == 0) continue;
      btScalar coupled = coupledTo(rows_[joint.begin + j]);
      for (std::size_t k = 0; k < j; ++k) {
        if (at(k, k) != 0) coupled -= at(i, k) * at(j, k) * at(k, k);
      }
      at(i, j) = coupled / at(j, j);
      rest -= at(i, j) * coupled;
    }
    if (rest > kRedundant * row.yields)
      at(i, i) = rest;
    else
      row.impulse = 0;
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

/// The speed that a row lacks.
btScalar ConstraintRows::missing(const Joint& joint, const Row& row, Pass pass,
                                 const std::vector<BodyState>& states) const {
  const BodyState& a = states[static_cast<std::size_t>(joint.a)];
  const BodyState& b = states[static_cast<std::size_t>(joint.b)];
  const btScalar speed = row.linear_a.dot(a.velocity) + row.angular_a.dot(a.spin) +
                         row.linear_b.dot(b.velocity) + row.angular_b.dot(b.spin);
  const btScalar wanted = pass == Pass::push ? row.error : row.relaxed;
  return wanted - speed * joint.damping - row.impulse * row.cfm * row.yields;
}

/// Limits and motors one after the other, then all others, which have the last word.
void ConstraintRows::solve(int index, Pass pass, std::vector<BodyState>& states) {
  const Joint& joint = joints_[static_cast<std::size_t>(index)];
  for (int i = 0; i < joint.count; ++i) {
    Row& row = rows_[joint.begin + static_cast<std::size_t>(i)];
    if (row.free || row.yields == 0) continue;
    const btScalar change = missing(joint, row, pass, states) / row.yields;
    const btScalar total = btMax(row.low, btMin(row.impulse + change, row.high));
    const btScalar impulse = total - row.impulse;
    row.impulse = total;
    push(joint, row, impulse, states);
  }
  solveFree(joint, pass, states);
  if (pass != Pass::finish) return;
  for (int i = 0; i < joint.count; ++i) {
    Row& row = rows_[joint.begin + static_cast<std::size_t>(i)];
    row.sum += row.impulse;
  }
}

void ConstraintRows::solveFree(const Joint& joint, Pass pass, std::vector<BodyState>& states) {
  const std::size_t size = static_cast<std::size_t>(joint.count);
  const btScalar* const factors = &factors_[joint.matrix];
  const auto at = [&](std::size_t row, std::size_t column) { return factors[row * size + column]; };
  btScalar* const change = &changes_[joint.begin];
  for (std::size_t i = 0; i < size; ++i) {
    if (at(i, i) == 0) continue;
    change[i] = missing(joint, rows_[joint.begin + i], pass, states);
    for (std::size_t j = 0; j < i; ++j) {
      if (at(j, j) != 0) change[i] -= at(i, j) * change[j];
    }
  }
  for (std::size_t i = size; i-- > 0;) {
    if (at(i, i) == 0) continue;
    change[i] /= at(i, i);
    for (std::size_t j = i + 1; j < size; ++j) {
      if (at(j, j) != 0) change[i] -= at(j, i) * change[j];
    }
  }
  for (std::size_t i = 0; i < size; ++i) {
    Row& row = rows_[joint.begin + i];
    if (at(i, i) == 0) continue;
    if (pass == Pass::push) change[i] = soft_.mass * change[i] - soft_.impulse * row.impulse;
    row.impulse += change[i];
    push(joint, row, change[i], states);
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
