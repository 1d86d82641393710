// How a point of a manifold becomes a row.
#include <algorithm>
#include <cmath>
#include <optional>

#include "common/bullet_vectors.hpp"
#include "common/contact_tolerances.hpp"
#include "common/squeeze.hpp"
#include "solver/contact_rows.hpp"
#include "solver/point_curvature.hpp"
#include "solver/soft_step.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Fastest push, in sizes of the smaller body per second, and in depths per second for what is deeper.
constexpr btScalar kFastestPush = btScalar(0.5), kLeavingRate = 3;
/// Angle, 2 degrees: triangles tell no better than that in which directions a surface bends most and least.
constexpr btScalar kAligned = btScalar(0.035);
/// In sizes of the smaller body: on what bends less than by its inverse size a place goes so far in a step,
/// at most, as it would come to the end of it.
constexpr btScalar kFarthestRoll = btScalar(1) / 16;
/// [rad]: a direction that is closer to one in which a body is held may be that one, for rounding.
constexpr btScalar kAcross = btScalar(1e-5);

/// A row whose mass is too large by x leaves 1 - x of a speed: more than there was, the other way round, from
/// x = 2 on. What it yields, over its masses, is the square of a length. That grows with the lever by less
/// than the root of slendernessOf() times its way: up to sqrt(2) while the square of all is below this. The
/// way has three parts, and the sum of their squares stands for a third of its own at least.
constexpr btScalar kOverRelaxing = (3 - 4 * SIMDSQRT12) / 3;

/// Bullet's anisotropic friction: how far each axis of a body counts.
btVector3 scaledByAnisotropy(const btCollisionObject& body, const btVector3& way) {
  const btMatrix3x3& axes = body.getWorldTransform().getBasis();
  return axes * ((way * axes) * body.getAnisotropicFriction());
}

/// The mass that gets this speed from an impulse; 0 if it moves nothing.
Lanes massOf(Lanes yields) {
  const Lanes mass = inAll(1) / yields;
  return yields > Lanes{} ? (mass < inAll(BT_LARGE_FLOAT) ? mass : Lanes{}) : Lanes{};
}

/// Both parts of an impulse, which together are no larger than `most`.
void holdWithin(btScalar most, btScalar& along_1, btScalar& along_2) {
  const btScalar held = std::hypot(along_1, along_2);
  if (!(held > most)) return;
  along_1 *= most / held;
  along_2 *= most / held;
}

/// Of bodies that can be moved [m].
btScalar smallerSize(const TouchingPair& pair, const SolverBodies& bodies) {
  return bodies.isMovable(pair.b) ? std::min(bodies.size(pair.a), bodies.size(pair.b)) : bodies.size(pair.a);
}

/// Of a body about the axis about which it turns most easily [1/(kg m^2)].
btScalar largestInverseInertia(int body, const SolverBodies& bodies) {
  if (!bodies.isMovable(body)) return 0;
  const btVector3& inverse = bodies.rigid(body)->getInvInertiaDiagLocal();
  return inverse[inverse.maxAxis()];
}

/// The inverse square of the lever on which a pair yields by turning as much as it does by moving [1/m^2].
btScalar slendernessOf(const TouchingPair& pair, const SolverBodies& bodies) {
  const btScalar turns = largestInverseInertia(pair.a, bodies) + largestInverseInertia(pair.b, bodies);
  return turns > 0 ? turns / (bodies.inverseMass(pair.a) + bodies.inverseMass(pair.b)) : btScalar(0);
}

struct Spring {
  btScalar stiffness, damping;
};

/// The spring that a point has been given, if it has; from ERP and CFM, what they mean in the whole step.
std::optional<Spring> springOf(const btManifoldPoint& point, btScalar time_step) {
  if ((point.m_contactPointFlags & BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING) != 0)
    return Spring{point.m_combinedContactStiffness1, point.m_combinedContactDamping1};
  constexpr int kBoth = BT_CONTACT_FLAG_HAS_CONTACT_CFM | BT_CONTACT_FLAG_HAS_CONTACT_ERP;
  if ((point.m_contactPointFlags & kBoth) != kBoth || !(point.m_contactCFM > 0)) return {};
  const btScalar holds = 1 / point.m_contactCFM;  // k dt + c
  return Spring{point.m_contactERP * holds / time_step, (1 - point.m_contactERP) * holds};
}

}  // namespace

void ContactRows::beginStep(const btContactSolverInfo& info, int substeps, btScalar depth) {
  depth_ = depth;
  impact_ = arrival_ = false;
  substeps_ = btScalar(substeps);
  substep_ = info.m_timeStep / substeps_;
  slop_ = info.m_linearSlop;
  bounce_threshold_ = info.m_restitutionVelocityThreshold;
  soft_ = Softness::ofPhase(kContactPhase, kContactDamping, substep_);
  soft_on_fixed_ = Softness::ofPhase(2 * kContactPhase, kContactDamping / 2, substep_);
  bounces_ = false;
  warm_starting_ = (info.m_solverMode & SOLVER_USE_WARMSTARTING) != 0;
}

void ContactRows::prepare(int index, const SolverBodies& bodies) {
  Block& block = blocks_[static_cast<std::size_t>(index)];
  block.bounces = block.rolls = block.bends = block.bouncing = block.turned = false;
  block.slender = block.reach_a = block.reach_b = block.share = block.calm = Lanes{};
  block.inverse_mass[0] = block.inverse_mass[1] = Lanes{};
  for (int i = 0; i < block.count; ++i) points_[static_cast<std::size_t>(block.begin + i)] = PointLanes{};
  for (int lane = 0; lane < kLanes; ++lane) {
    block.a[lane] = block.b[lane] = bodies.movable();
    if (block.pair[lane] < 0) continue;
    const TouchingPair& pair = pairs_[static_cast<std::size_t>(block.pair[lane])];
    block.a[lane] = pair.a;
    block.b[lane] = pair.b;
    block.calm[lane] = depth_ * smallerSize(pair, bodies) / (substep_ * substeps_);
    block.inverse_mass[0][lane] = bodies.inverseMass(pair.a);
    block.inverse_mass[1][lane] = bodies.inverseMass(pair.b);
    block.slender[lane] = slendernessOf(pair, bodies) / kOverRelaxing;
    btScalar reach_a = 0, reach_b = 0;
    block.share[lane] = bodies.isMovable(pair.b) ? btScalar(0.5) : btScalar(0);
    for (int i = 0; i < pair.count; ++i) {
      PointLanes& point = points_[static_cast<std::size_t>(block.begin + i)];
      const Source& source = sources_[static_cast<std::size_t>(pair.begin + i)];
      fillPlace(point, lane, source, pair, bodies);
      fillForces(point, lane, *source.point, pair, bodies);
      fillTurning(point, lane, source);
      reach_a = std::max(reach_a, point.arm_a.get(lane).length());
      reach_b = std::max(reach_b, point.arm_b.get(lane).length());
      block.bounces = block.bounces || point.restitution[lane] > 0;
      block.bends = block.bends || !point.axis_1.get(lane).isZero() || !point.axis_2.get(lane).isZero();
      block.rolls = block.rolls || point.rolling[lane] > 0 || point.spinning[lane] > 0;
    }
    block.reach_a[lane] = reach_a * reach_a;
    block.reach_b[lane] = reach_b * reach_b;
  }
  if (block.bounces) bounces_ = true;
  const LaneBodies a(block.a, bodies.states()), b(block.b, bodies.states());
  for (int i = block.begin; i < block.begin + block.count; ++i)
    fillMasses(points_[static_cast<std::size_t>(i)], a, b, block.inverse_mass, block.rolls);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (block.pair[lane] < 0) continue;
    const TouchingPair& pair = pairs_[static_cast<std::size_t>(block.pair[lane])];
    PointLanes* const points = points_.data() + block.begin;
    for (int i = 0; i < pair.count; ++i) {
      const btManifoldPoint& point = *sources_[static_cast<std::size_t>(pair.begin + i)].point;
      fillSoftness(points[i], lane, point, pair, bodies);
    }
    loosen(points, sources_.data() + pair.begin, pair.count, lane, depth_ * smallerSize(pair, bodies));
    fillLoads(points, pair.count, lane);
  }
}

/// Points that are so deep that they are driven apart more slowly than their spring would do it bear a load
/// all the same, unless points of the pair press against each other. Those would load themselves, and throw
/// the bodies where one side lets go. What something holds aslant is no load.
void ContactRows::fillLoads(PointLanes* points, int count, int lane) {
  const auto isHeldBack = [&](int i) {
    return points[i].gap[lane] * points[i].rate[lane] < -points[i].fastest[lane];
  };
  const auto pressesAgainst = [&](int i, int k) {
    return points[k].gap[lane] < 0 && points[i].normal.get(lane).dot(points[k].normal.get(lane)) < 0;
  };
  for (int i = 0; i < count; ++i) {
    if (!isHeldBack(i)) continue;
    for (int k = 0; k < count; ++k)
      if (pressesAgainst(i, k)) return;
  }
  for (int i = 0; i < count; ++i) points[i].loaded[lane] = points[i].kept[lane];
}

/// What points press against each other, deeper than is wanted, is held neither by friction nor thrown. The
/// deepest of them says how little is left: else those that are less deep would hold it. That is of two
/// bodies: bodies that are fixed are one to the rows, but what two of them hold is gripped.
void ContactRows::loosen(PointLanes* points, const Source* sources, int count, int lane, btScalar wanted) {
  const auto other = [&](int i) {
    return sources[i].flipped ? sources[i].manifold->getBody0() : sources[i].manifold->getBody1();
  };
  const auto pushOf = [&](int i) {
    btScalar push = 1;
    const btScalar depth = -points[i].gap[lane];
    for (int k = 0; k < count && depth > 0; ++k) {
      if (other(k) == other(i))
        push = std::min(push, Squeeze::push(depth, points[i].normal.get(lane), -points[k].gap[lane],
                                            points[k].normal.get(lane)));
    }
    return push;
  };
  const auto deepestOf = [&](const btCollisionObject* body) {
    btScalar deepest = wanted;
    for (int i = 0; i < count; ++i)
      if (-points[i].gap[lane] > deepest && other(i) == body && pushOf(i) < 1) deepest = -points[i].gap[lane];
    return deepest;
  };
  for (int i = 0; i < count; ++i)
    if (points[i].spring[lane] > 0) return;
  const btCollisionObject* body = nullptr;
  btScalar deepest = 0;
  for (int i = 0; i < count; ++i) {
    // Points of one body mostly follow each other.
    if (other(i) != body) deepest = deepestOf(body = other(i));
    const btScalar push = deepest > wanted ? pushOf(i) : btScalar(1);
    if (!(push < 1)) continue;
    points[i].friction[lane] *= Squeeze::friction(deepest, wanted);
    points[i].fastest[lane] *= push;
  }
}

/// Where the bodies touch, and what they have borne there.
void ContactRows::fillPlace(PointLanes& lanes, int lane, const Source& source, const TouchingPair& pair,
                            const SolverBodies& bodies) const {
  const btManifoldPoint& point = *source.point;
  const btScalar sign = source.flipped ? btScalar(-1) : btScalar(1);
  btVector3 on_a = source.flipped ? point.getPositionWorldOnB() : point.getPositionWorldOnA();
  btVector3 on_b = source.flipped ? point.getPositionWorldOnA() : point.getPositionWorldOnB();
  const btVector3 normal = point.m_normalWorldOnB * sign;
  btScalar gap = point.getDistance();
  if (!isOfStart(point)) {
    const btVector3 then_a = bodies.startOf(pair.a, on_a), then_b = bodies.startOf(pair.b, on_b);
    gap += (then_a - on_a - (then_b - on_b)).dot(normal);
    on_a = then_a;
    // Where the point of what moves by itself was then is beside A's.
    on_b = bodies.isMovable(pair.b) ? then_b : on_a - normal * gap;
  }
  // The fixed world does not turn.
  const btVector3 arm_a = on_a - bodies.origin(pair.a),
                  arm_b = pair.b == bodies.movable() ? btVector3(0, 0, 0) : on_b - bodies.origin(pair.b);
  lanes.normal.set(lane, normal);
  lanes.arm_a.set(lane, arm_a);
  lanes.arm_b.set(lane, arm_b);
  lanes.gap[lane] = gap + slop_;
  fillBends(lanes, lane, source, pair, bodies);
  btVector3 side_1, side_2;
  if ((point.m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED) != 0) {
    side_1 = point.m_lateralFrictionDir1 * sign;
    side_2 = point.m_lateralFrictionDir2 * sign;
    lanes.belt_1[lane] = point.m_contactMotion1;
    lanes.belt_2[lane] = point.m_contactMotion2;
  } else {
    // As Bullet does for a new point, which takes over the impulses of an old one, but not its directions.
    btPlaneSpace1(point.m_normalWorldOnB, side_1, side_2);
    side_1 *= sign;
    side_2 *= sign;
  }
  if (warm_starting_) {
    const btVector3 borne = (point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
                             point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2) *
                            (sign / substeps_);
    // Impulses that are not finite are forgotten.
    const btScalar impulse = point.m_prevRHS / substeps_;
    if (impulse > 0 && std::isfinite(impulse) && isFinite(borne)) {
      lanes.impulse[lane] = impulse;
      lanes.impulse_1[lane] = borne.dot(side_1);
      lanes.impulse_2[lane] = borne.dot(side_2);
    }
  }
  lanes.side_1.set(lane, side_1);
  lanes.side_2.set(lane, side_2);
}

/// The way that the place goes, as normals turn: that in which the bodies slide or roll, whichever turns
/// normals more. Any way across the normal if they do neither.
btVector3 ContactRows::wayAhead(const PointLanes& lanes, int lane, const TouchingPair& pair, btScalar bend,
                                const SolverBodies& bodies) {
  const BodyState &a = bodies.state(pair.a), &b = bodies.state(pair.b);
  const btVector3 normal = lanes.normal.get(lane);
  const btVector3 sliding =
      a.velocity + a.spin.cross(lanes.arm_a.get(lane)) - b.velocity - b.spin.cross(lanes.arm_b.get(lane));
  const btVector3 slid = (sliding - normal * sliding.dot(normal)) * bend;
  const btVector3 rolled = (a.spin - b.spin).cross(normal);
  const btVector3& way = rolled.length2() > slid.length2() ? rolled : slid;
  if (way.length2() > SIMD_EPSILON * SIMD_EPSILON) return way.normalized();
  return Across(normal).x;
}

/// How the place goes along with them: to where normals agree, in the axes in which there is a top of the
/// hill of the depth. Where surfaces fit each other, or are flat, it stays: in the world if both bend, as
/// that of a bore on its pin, else on the bodies, as at a corner or on a face. Sizes of 0 are of what does
/// not turn.
void ContactRows::fillBends(PointLanes& lanes, int lane, const Source& source, const TouchingPair& pair,
                            const SolverBodies& bodies) {
  const btVector3 normal = lanes.normal.get(lane);
  lanes.normal_0.set(lane, normal);
  lanes.gap_0[lane] = lanes.gap[lane];
  lanes.pivot_a.set(lane, lanes.arm_a.get(lane));
  lanes.pivot_b.set(lane, lanes.arm_b.get(lane));
  const btScalar size_a = bodies.size(pair.a), size_b = bodies.size(pair.b);
  const btScalar size = size_b > 0 ? std::min(size_a, size_b) : size_a;
  PointBends bends = bendsOf(*source.point);
  for (Bend* bend : {&bends.a, &bends.b}) {
    const btScalar most = btFabs(bend->xx) + btFabs(bend->yy);
    // Way times bend is an angle.
    if (!(most * size > kEdgeSharpness)) continue;
    const btScalar share = kEdgeSharpness / (most * size);
    *bend = {bend->xx * share, bend->xy * share, bend->yy * share};
  }
  const btScalar both = btFabs(bends.a.xx) + btFabs(bends.a.yy) + btFabs(bends.b.xx) + btFabs(bends.b.yy);
  if (!(both * size > kFlatTogether)) {
    lanes.goes[lane] = isOfStart(*source.point) ? btScalar(1) : btScalar(0);
    return;
  }
  const Across told(-source.point->m_normalWorldOnB);  // out of the first body of the manifold
  Across ahead(normal);
  ahead.x = wayAhead(lanes, lane, pair, both, bodies);
  ahead.y = normal.cross(ahead.x);
  const auto seenAhead = [&](const Bend& bend) {
    Bend seen = bend.along(ahead.x, ahead.y, told);
    if (btFabs(seen.xy) < kAligned * btFabs(seen.xx - seen.yy)) seen.xy = 0;
    return seen;
  };
  Bend a = seenAhead(source.flipped ? bends.b : bends.a), b = seenAhead(source.flipped ? bends.a : bends.b);
  Hill hill(a, b, -source.point->getDistance(), ahead);
  const auto along = [&](const Bend& bend, int i) {
    return bend.turn(hill.axis(i), ahead).dot(hill.axis(i));
  };
  const auto common = [&](int i) { return std::min(btFabs(along(a, i)), btFabs(along(b, i))); };
  const auto rolls = [&](int i) {
    const btScalar fall = hill.fall(i);
    return hill.hasTop(i) && (fall * size > 1 || (fall * size > kFlatTogether && fall > common(i)));
  };
  // What is left of curvatures that cancel has axes of rounding: each surface has better ones.
  const bool any = rolls(0) || rolls(1);
  if (!any) hill = Hill({-a.xx, -a.xy, -a.yy}, b, 0, ahead);
  btVector3 axis[2];
  btScalar fall[2] = {0, 0}, most[2] = {BT_LARGE_FLOAT, BT_LARGE_FLOAT}, still[2] = {0, 0};
  for (int i = 0; i < 2; ++i) {
    axis[i] = hill.axis(i);
    if (any && rolls(i)) {
      fall[i] = 1 / hill.fall(i);
      if (fall[i] > size) most[i] = kFarthestRoll * size;
    } else if (common(i) * size > 1) {
      still[i] = 1 / along(b, i);
    } else {
      axis[i].setZero();
    }
  }
  // Also of a hollow on a flat face, or its edge: else it would be lifted as it turns.
  const auto radius = [&](const Bend& bend, btScalar size_of_it) {
    const btScalar curvature = bend.turn(ahead.x, ahead).dot(ahead.x);
    return btFabs(curvature) * size_of_it > 1 ? 1 / curvature : btScalar(0);
  };
  const btScalar radius_a = radius(a, size_a), radius_b = radius(b, size_b > 0 ? size_b : BT_LARGE_FLOAT);
  a = a.along(axis[0], axis[1], ahead);
  b = b.along(axis[0], axis[1], ahead);
  lanes.axis_1.set(lane, axis[0]);
  lanes.axis_2.set(lane, axis[1]);
  lanes.fall_1[lane] = fall[0];
  lanes.fall_2[lane] = fall[1];
  lanes.most_1[lane] = most[0];
  lanes.most_2[lane] = most[1];
  lanes.still_1[lane] = still[0];
  lanes.still_2[lane] = still[1];
  lanes.a_11[lane] = a.xx;
  lanes.a_12[lane] = a.xy;
  lanes.a_22[lane] = a.yy;
  lanes.b_11[lane] = b.xx;
  lanes.b_12[lane] = b.xy;
  lanes.b_22[lane] = b.yy;
  lanes.radius_a[lane] = radius_a;
  lanes.radius_b[lane] = radius_b;
  lanes.pivot_a.set(lane, lanes.arm_a.get(lane) + normal * radius_a);
  lanes.pivot_b.set(lane, lanes.arm_b.get(lane) - normal * radius_b);
}

/// What the point has been told of forces, and what it bore.
void ContactRows::fillForces(PointLanes& lanes, int lane, const btManifoldPoint& point,
                             const TouchingPair& pair, const SolverBodies& bodies) {
  for (int body : {pair.a, pair.b}) {
    const btRigidBody* rigid = bodies.rigid(body);
    if (rigid == nullptr || !rigid->hasAnisotropicFriction(btCollisionObject::CF_ANISOTROPIC_FRICTION))
      continue;
    for (Lanes3* side : {&lanes.side_1, &lanes.side_2})
      side->set(lane, scaledByAnisotropy(*rigid, side->get(lane)));
  }
  lanes.friction[lane] = point.m_combinedFriction;
  lanes.restitution[lane] = point.m_combinedRestitution;
  lanes.rolling[lane] = point.m_combinedRollingFriction;
  lanes.spinning[lane] = point.m_combinedSpinningFriction;
  holdWithin(lanes.friction[lane] * lanes.impulse[lane], lanes.impulse_1[lane], lanes.impulse_2[lane]);
}

/// What its manifold bore against rolling and spinning, shared out as its points bear.
void ContactRows::fillTurning(PointLanes& lanes, int lane, const Source& source) const {
  const auto place = static_cast<std::size_t>(source.manifold->m_index1a);
  const btVector3& borne = turnings_[place];
  if (known_[place] != source.manifold || !isFinite(borne) || !(lanes.impulse[lane] > 0)) return;
  btScalar all = 0;
  for (int i = 0; i < source.manifold->getNumContacts(); ++i)
    all += std::max(btScalar(0), source.manifold->getContactPoint(i).m_prevRHS);
  const btScalar share = source.point->m_prevRHS / all;
  const btVector3 turning = borne * (source.flipped ? -share : share);
  lanes.roll_1[lane] = turning.dot(lanes.side_1.get(lane));
  lanes.roll_2[lane] = turning.dot(lanes.side_2.get(lane));
  lanes.spin[lane] = turning.dot(lanes.normal.get(lane));
  const btScalar most_roll = lanes.rolling[lane] * lanes.impulse[lane],
                 most_spin = lanes.spinning[lane] * lanes.impulse[lane];
  holdWithin(most_roll, lanes.roll_1[lane], lanes.roll_2[lane]);
  lanes.spin[lane] = std::clamp(lanes.spin[lane], -most_spin, most_spin);
}

/// How much each row moves. A body that a linear factor holds may yield aslant alone: next to nothing, on a
/// short lever, or by rounding. What makes up for that throws it, now, or along a normal that has turned by
/// the next step. So a row moves no more than a body would that is not held, further passes add what it
/// lacks, and of what it has borne it keeps what was not borne by what holds the body; by rounding alone
/// nothing is moved. Across the normal friction bounds that. There a body that is held to a plane or a line
/// gives way in one direction only: both rows see the same motion, or one sees none. Together they are to
/// stop it once.
void ContactRows::fillMasses(PointLanes& point, const LaneBodies& a, const LaneBodies& b,
                             const Lanes (&inverse_mass)[2], bool rolls) {
  const auto along = [&](const Lanes3& way) {
    const Lanes3 turn_a = cross(point.arm_a, way), turn_b = cross(point.arm_b, way);
    return dot(way, scaled(a.inverse_mass, way)) + dot(way, scaled(b.inverse_mass, way)) +
           dot(turn_a, a.inverseInertiaTimes(turn_a)) + dot(turn_b, b.inverseInertiaTimes(turn_b));
  };
  const auto about = [&](const Lanes3& axis) {
    return massOf(dot(axis, a.inverseInertiaTimes(axis)) + dot(axis, b.inverseInertiaTimes(axis)));
  };
  // How much a body would yield along the normal if nothing held it, or more than anything if it cannot.
  const auto freely = [&](const LaneBodies& body, Lanes free, const Lanes3& arm) {
    const Lanes3& normal = point.normal;
    const Lanes3 turn = cross(arm, normal);
    const Lanes turns = dot(turn, body.inverseInertiaTimes(turn));
    const Lanes yields = dot(normal, scaled(body.inverse_mass, normal)) + turns,
                all = dot(normal, scaled({free, free, free}, normal)) + turns;
    return yields > all * inAll(kAcross * kAcross) ? all : inAll(BT_LARGE_FLOAT);
  };
  const auto isHeld = [](const LaneBodies& body, Lanes free) {
    return (body.inverse_mass.x != free) | (body.inverse_mass.y != free) | (body.inverse_mass.z != free);
  };
  const Lanes one_free =
      smaller(freely(a, inverse_mass[0], point.arm_a), freely(b, inverse_mass[1], point.arm_b));
  const Lanes yields = along(point.normal);
  point.mass = one_free < inAll(BT_LARGE_FLOAT) ? massOf(larger(yields, one_free)) : Lanes{};
  point.kept = yields < one_free ? yields / one_free : inAll(1);
  point.impulse = point.mass > Lanes{} ? point.impulse : Lanes{};
  const Lanes yields_1 = along(point.side_1), yields_2 = along(point.side_2);
  const Lanes together = massOf(yields_1 + yields_2);
  const auto held = isHeld(a, inverse_mass[0]) | isHeld(b, inverse_mass[1]);
  point.mass_1 = held ? together : massOf(yields_1);
  point.mass_2 = held ? together : massOf(yields_2);
  if (!rolls) return;
  const Lanes rolling_1 = about(point.side_1), rolling_2 = about(point.side_2);
  const Lanes least = smaller(rolling_1, rolling_2);
  point.mass_rolling = least > Lanes{} ? least : larger(rolling_1, rolling_2);
  point.mass_spinning = about(point.normal);
}

/// As bodies turn, rows yield more, or less: a thin rod up to a hundred times more within a step. Rows of old
/// masses would throw it.
void ContactRows::renewMassesOf(const Block& block, const std::vector<BodyState>& states) {
  const LaneBodies a(block.a, states), b(block.b, states);
  const Lanes none{}, one = inAll(1);
  for (int i = block.begin; i < block.begin + block.count; ++i) {
    PointLanes& point = points_[static_cast<std::size_t>(i)];
    const Lanes before = point.mass;
    fillMasses(point, a, b, block.inverse_mass, block.rolls);
    // A spring of the user's gives way as before (Softness::ofSpring).
    const auto changes = (point.spring * before * point.mass > none) & (point.soft_mass > none);
    const Lanes give = changes ? point.soft_impulse * point.mass / (point.soft_mass * before) : none;
    point.soft_mass = changes ? one / (one + give) : point.soft_mass;
    point.soft_impulse = changes ? give / (one + give) : point.soft_impulse;
  }
}

void ContactRows::renewMassesWide(int index, const std::vector<BodyState>& states) {
  renewMassesOf(blocks_[static_cast<std::size_t>(index)], states);
}

void ContactRows::renewMasses(int index, const std::vector<BodyState>& states) {
  wide_ ? renewMassesWide(index, states) : renewMassesOf(blocks_[static_cast<std::size_t>(index)], states);
}

/// How they give way.
void ContactRows::fillSoftness(PointLanes& lanes, int lane, const btManifoldPoint& point,
                               const TouchingPair& pair, const SolverBodies& bodies) const {
  const btScalar size = smallerSize(pair, bodies);
  Softness soft = bodies.isMovable(pair.b) ? soft_ : soft_on_fixed_;
  lanes.fastest[lane] = std::max(kFastestPush * size, -kLeavingRate * point.getDistance());
  if (const auto spring = springOf(point, substep_ * substeps_)) {
    soft = Softness::ofSpring(spring->stiffness, spring->damping, lanes.mass[lane], substep_);
    lanes.spring[lane] = 1;
    lanes.fastest[lane] = BT_LARGE_FLOAT;
  }
  lanes.rate[lane] = soft.rate;
  lanes.soft_mass[lane] = soft.mass;
  lanes.soft_impulse[lane] = soft.impulse;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
