#include "response/penalty.hpp"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Of the rows at the points against each other.
constexpr int kIterations = 10;

btScalar dampingOf(btScalar restitution, btScalar damping) {
  if (!(restitution > 0)) return damping;
  const btScalar log_e = btLog(btMin(restitution, btScalar(1)));
  return btMin(damping, -log_e / btSqrt(SIMD_PI * SIMD_PI + log_e * log_e));
}

/// At most this long.
btVector3 limited(const btVector3& v, btScalar length) {
  const btScalar l = v.length();
  return l > length ? v * (length / l) : v;
}

}  // namespace

/// One point of contact.
struct Penalty::Row {
  btManifoldPoint* point;
  btVector3 at;
  btVector3 normal;  ///< from A to B
  btVector3 tangent[2];
  btScalar pushed;            ///< by the penalty force [N s]
  btScalar softness;          ///< 1 / (damping dt) [1/kg]; negative: no damping
  btScalar damped = 0;        ///< impulse along the normal that damping adds [N s]
  btVector3 rubbed{0, 0, 0};  ///< by friction [N s]
  btVector3 rolled{0, 0, 0};  ///< by rolling and spinning friction [N m s]
};

bool Penalty::applies(const btCollisionObject& a, const btCollisionObject& b) {
  const auto takes = [](const btCollisionObject& object) {
    return object.isStaticOrKinematicObject() || btRigidBody::upcast(&object) != nullptr;
  };
  return takes(a) && takes(b);
}

PenaltyReport Penalty::push(const Overlap& overlap, btScalar stiffness, const btVector3& arm,
                            const btManifoldArray& manifolds) {
  static thread_local std::vector<Row> rows;
  PenaltyReport report;
  report.force = toBullet(overlap.force) * stiffness;
  report.energy = overlap.energy * stiffness;
  const btVector3 impulse = report.force * time_step_;
  const btVector3 torque = toBullet(overlap.torque) * (stiffness * time_step_);
  b_.push(impulse);
  b_.turn(torque + (arm - b_.centre()).cross(impulse));
  a_.push(-impulse);
  a_.turn(-(torque + (arm - a_.centre()).cross(impulse)));

  rows.clear();
  btScalar reach_a = 0, reach_b = 0;
  for (int m = 0; m < manifolds.size(); ++m) {
    for (int i = 0; i < manifolds[m]->getNumContacts(); ++i) {
      btManifoldPoint& point = manifolds[m]->getContactPoint(i);
      Row row;
      row.point = &point;
      row.at = point.getPositionWorldOnB();
      row.normal = -point.m_normalWorldOnB;
      btPlaneSpace1(row.normal, row.tangent[0], row.tangent[1]);
      row.pushed = btMax(btScalar(0), -point.getDistance()) * point.m_combinedContactStiffness1 * time_step_;
      const btScalar damping =
          point.m_combinedContactDamping1 * dampingOf(point.m_combinedRestitution, damping_) * time_step_;
      row.softness = damping > 0 ? 1 / damping : btScalar(-1);
      rows.push_back(row);
      reach_a = btMax(reach_a, row.at.distance(a_.centre()));
      reach_b = btMax(reach_b, row.at.distance(b_.centre()));
    }
  }
  solve(rows);
  for (const Row& row : rows) {
    row.point->m_appliedImpulse = row.pushed + row.damped;
    row.point->m_lateralFrictionDir1 = row.tangent[0];
    row.point->m_lateralFrictionDir2 = row.tangent[1];
    row.point->m_appliedImpulseLateral1 = -row.rubbed.dot(row.tangent[0]);  // on A, as Bullet has it
    row.point->m_appliedImpulseLateral2 = -row.rubbed.dot(row.tangent[1]);
  }
  a_.apply();
  b_.apply();

  const btScalar inverse_mass = a_.largestInverseMass(reach_a) + b_.largestInverseMass(reach_b);
  const btScalar rate2 = stiffness * btScalar(overlap.stiffness) * inverse_mass;
  if (rate2 > 0) report.largest_step = 2 / btSqrt(rate2);
  return report;
}

void Penalty::resistRolling(Row& row, btScalar normal) {
  const btScalar rolling = row.point->m_combinedRollingFriction * normal,
                 spinning = row.point->m_combinedSpinningFriction * normal;
  if (!(rolling > 0) && !(spinning > 0)) return;
  const btVector3 spin = b_.spin() - a_.spin();
  btVector3 wanted = row.rolled;
  for (const btVector3& axis : {row.normal, row.tangent[0], row.tangent[1]}) {
    const btScalar inverse = a_.inverseInertiaAbout(axis) + b_.inverseInertiaAbout(axis);
    if (inverse > 0) wanted -= axis * (spin.dot(axis) / inverse);
  }
  const btVector3 about = row.normal * wanted.dot(row.normal);
  const btVector3 rolled = limited(about, spinning) + limited(wanted - about, rolling);
  b_.turn(rolled - row.rolled);
  a_.turn(row.rolled - rolled);
  row.rolled = rolled;
}

/// Sequential impulses, as in Bullet's solver.
void Penalty::solve(std::vector<Row>& rows) {
  const auto inverseMass = [&](const btVector3& at, const btVector3& direction) {
    return a_.inverseMassAt(at, direction) + b_.inverseMassAt(at, direction);
  };
  const auto exchange = [&](const btVector3& impulse, const btVector3& at) {
    b_.push(impulse, at);
    a_.push(-impulse, at);
  };
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    for (Row& row : rows) {
      if (row.softness >= 0) {
        const btScalar speed = (b_.velocityAt(row.at) - a_.velocityAt(row.at)).dot(row.normal);
        const btScalar change =
            -(speed + row.softness * row.damped) / (inverseMass(row.at, row.normal) + row.softness);
        // Damping does not pull.
        const btScalar damped = btMax(row.damped + change, -row.pushed);
        exchange(row.normal * (damped - row.damped), row.at);
        row.damped = damped;
      }
      const btScalar normal = row.pushed + row.damped;
      btVector3 change(0, 0, 0);
      const btVector3 slip = b_.velocityAt(row.at) - a_.velocityAt(row.at);
      for (const btVector3& tangent : row.tangent) {
        const btScalar inverse = inverseMass(row.at, tangent);
        if (inverse > 0) change -= tangent * (slip.dot(tangent) / inverse);
      }
      const btVector3 rubbed = limited(row.rubbed + change, row.point->m_combinedFriction * normal);
      exchange(rubbed - row.rubbed, row.at);
      row.rubbed = rubbed;
      resistRolling(row, normal);
    }
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
