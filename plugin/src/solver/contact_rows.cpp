#include "solver/contact_rows.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "common/bullet_vectors.hpp"
#include "common/contact_tolerances.hpp"
#include "solver/point_curvature.hpp"
#include "solver/soft_step.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Fastest push, in sizes of the smaller body per second, and in depths per second for what is deeper.
constexpr btScalar kFastest = btScalar(0.5), kLeaving = 3;
/// A face that lands flat is thrown back by all its corners in one substep: each of them goes on until the others
/// have had their part.
constexpr int kBounceRounds = 8;

bool isSound(const btManifoldPoint& point) {
  return isFinite(point.getPositionWorldOnA()) && isFinite(point.getPositionWorldOnB()) &&
         isFinite(point.m_normalWorldOnB) && std::isfinite(point.getDistance());
}

/// How far `turned` moves the end of an arm.
Lanes3 swing(const Lanes3& axis, Lanes w, const Lanes3& arm) {
  const Lanes3 across = cross(axis, arm);
  return (across * w + cross(axis, across)) * inAll(2);
}

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

/// Both parts of an impulse across the normal, which together are no larger than `most`.
void holdWithin(Lanes most, Lanes& along_1, Lanes& along_2) {
  const Lanes length = root(along_1 * along_1 + along_2 * along_2);
  const Lanes share = length > most ? most / length : inAll(1);
  along_1 *= share;
  along_2 *= share;
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
  const btScalar holds = time_step / point.m_contactCFM;  // Bullet divides CFM by the step
  return Spring{point.m_contactERP * holds / time_step, (1 - point.m_contactERP) * holds};
}

}  // namespace

/// One body of each pair of a block.
struct ContactRows::Bodies {
  Bodies(const int* places, const std::vector<BodyState>& states) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const BodyState& state = states[static_cast<std::size_t>(places[lane])];
      velocity.set(lane, state.velocity);
      spin.set(lane, state.spin);
      moved.set(lane, state.moved);
      axis.set(lane, btVector3(state.turned.x(), state.turned.y(), state.turned.z()));
      w[lane] = state.turned.w();
      inverse_mass.set(lane, state.inverse_mass);
      xx[lane] = state.xx;
      yy[lane] = state.yy;
      zz[lane] = state.zz;
      xy[lane] = state.xy;
      xz[lane] = state.xz;
      yz[lane] = state.yz;
    }
  }
  void put(const int* places, int movable, std::vector<BodyState>& states) const {
    for (int lane = 0; lane < kLanes; ++lane) {
      if (places[lane] >= movable) continue;
      BodyState& state = states[static_cast<std::size_t>(places[lane])];
      state.velocity = velocity.get(lane);
      state.spin = spin.get(lane);
    }
  }
  Lanes3 velocityAt(const Lanes3& arm) const { return velocity + cross(spin, arm); }
  void push(const Lanes3& impulse) { velocity = velocity + scaled(inverse_mass, impulse); }
  Lanes3 inverseInertiaTimes(const Lanes3& l) const {
    return {xx * l.x + xy * l.y + xz * l.z, xy * l.x + yy * l.y + yz * l.z, xz * l.x + yz * l.y + zz * l.z};
  }
  void turn(const Lanes3& l) { spin = spin + inverseInertiaTimes(l); }
  void pushAt(const Lanes3& arm, const Lanes3& impulse) {
    push(impulse);
    turn(cross(arm, impulse));
  }

  Lanes3 velocity, spin, moved, axis, inverse_mass;
  Lanes w, xx, yy, zz, xy, xz, yz;
};

void ContactRows::collect(btPersistentManifold** manifolds, int count, SolverBodies& bodies) {
  entries_.clear();
  sources_.clear();
  pairs_.clear();
  broken_ = 0;
  movable_ = bodies.movable();
  for (int i = 0; i < count; ++i) {
    if (manifolds[i]->getNumContacts() == 0) continue;
    int a = bodies.indexOf(*manifolds[i]->getBody0()), b = bodies.indexOf(*manifolds[i]->getBody1());
    if (a == SolverBodies::kBroken || b == SolverBodies::kBroken) continue;
    const bool flipped = a > b;
    if (flipped) std::swap(a, b);
    if (bodies.isMovable(a)) entries_.push_back({a, b, i, flipped});
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& l, const Entry& r) {
    return std::tie(l.a, l.b, l.manifold) < std::tie(r.a, r.b, r.manifold);
  });
  for (const Entry& entry : entries_) {
    btPersistentManifold& manifold = *manifolds[entry.manifold];
    if (pairs_.empty() || pairs_.back().a != entry.a || pairs_.back().b != entry.b)
      pairs_.push_back({entry.a, entry.b, static_cast<int>(sources_.size()), 0});
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      btManifoldPoint& point = manifold.getContactPoint(k);
      // Bullet's own measure of which points its solver is to leave alone.
      if (point.getDistance() > manifold.getContactProcessingThreshold()) continue;
      if (!isSound(point)) {
        ++broken_;
        continue;
      }
      sources_.push_back({&point, entry.flipped});
      ++pairs_.back().count;
    }
  }
  pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(), [](const ContactPair& p) { return p.count == 0; }),
               pairs_.end());
}

void ContactRows::clearBlocks() {
  blocks_.clear();
  point_count_ = 0;
}

void ContactRows::addBlock(const int* pairs, int count) {
  Block& block = blocks_.emplace_back();
  block.begin = point_count_;
  block.count = 0;
  for (int lane = 0; lane < kLanes; ++lane) {
    block.pair[lane] = lane < count ? pairs[lane] : -1;
    if (lane < count) block.count = std::max(block.count, pairs_[static_cast<std::size_t>(pairs[lane])].count);
  }
  point_count_ += block.count;
  if (points_.size() < static_cast<std::size_t>(point_count_)) points_.resize(static_cast<std::size_t>(point_count_));
}

void ContactRows::beginStep(const btContactSolverInfo& info, int substeps) {
  substeps_ = btScalar(substeps);
  substep_ = info.m_timeStep / substeps_;
  slop_ = info.m_linearSlop;
  bounce_threshold_ = info.m_restitutionVelocityThreshold;
  soft_ = Softness::ofPhase(kContactPhase, kContactDamping, substep_);
  soft_on_fixed_ = Softness::ofPhase(2 * kContactPhase, kContactDamping / 2, substep_);
  warm_starting_ = (info.m_solverMode & SOLVER_USE_WARMSTARTING) != 0;
}

void ContactRows::prepare(int index, const SolverBodies& bodies) {
  Block& block = blocks_[static_cast<std::size_t>(index)];
  block.bounces = block.rolls = block.bends = false;
  block.share = Lanes{};
  for (int i = 0; i < block.count; ++i) points_[static_cast<std::size_t>(block.begin + i)] = PointLanes{};
  for (int lane = 0; lane < kLanes; ++lane) {
    block.a[lane] = block.b[lane] = bodies.movable();
    if (block.pair[lane] < 0) continue;
    const ContactPair& pair = pairs_[static_cast<std::size_t>(block.pair[lane])];
    block.a[lane] = pair.a;
    block.b[lane] = pair.b;
    block.share[lane] = bodies.isMovable(pair.b) ? btScalar(0.5) : btScalar(0);
    for (int i = 0; i < pair.count; ++i) {
      PointLanes& point = points_[static_cast<std::size_t>(block.begin + i)];
      const Source& source = sources_[static_cast<std::size_t>(pair.begin + i)];
      fillPlace(point, lane, source, pair, bodies);
      fillForces(point, lane, *source.point, pair, bodies);
      block.bounces = block.bounces || point.restitution[lane] > 0;
      block.bends = block.bends || point.bend[lane] != 0;
      block.rolls = block.rolls || point.rolling[lane] > 0 || point.spinning[lane] > 0;
    }
  }
  const Bodies a(block.a, bodies.states()), b(block.b, bodies.states());
  for (int i = block.begin; i < block.begin + block.count; ++i)
    fillMasses(points_[static_cast<std::size_t>(i)], a, b, block.rolls);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (block.pair[lane] < 0) continue;
    const ContactPair& pair = pairs_[static_cast<std::size_t>(block.pair[lane])];
    for (int i = 0; i < pair.count; ++i) {
      const btManifoldPoint& point = *sources_[static_cast<std::size_t>(pair.begin + i)].point;
      fillSoftness(points_[static_cast<std::size_t>(block.begin + i)], lane, point, pair, bodies);
    }
  }
}

/// Where the bodies touch, and what they have borne there.
void ContactRows::fillPlace(PointLanes& lanes, int lane, const Source& source, const ContactPair& pair,
                            const SolverBodies& bodies) const {
  const btManifoldPoint& point = *source.point;
  const btScalar sign = source.flipped ? btScalar(-1) : btScalar(1);
  const btVector3& on_a = source.flipped ? point.getPositionWorldOnB() : point.getPositionWorldOnA();
  const btVector3& on_b = source.flipped ? point.getPositionWorldOnA() : point.getPositionWorldOnB();
  const btVector3 normal = point.m_normalWorldOnB * sign;
  // The fixed world does not turn.
  const btVector3 arm_a = on_a - bodies.origin(pair.a),
                  arm_b = pair.b == bodies.movable() ? btVector3(0, 0, 0) : on_b - bodies.origin(pair.b);
  lanes.normal.set(lane, normal);
  lanes.arm_a.set(lane, arm_a);
  lanes.arm_b.set(lane, arm_b);
  lanes.gap[lane] = point.getDistance() + slop_;
  fillCurves(lanes, lane, source, bodies.size(pair.a), bodies.size(pair.b));
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
    lanes.impulse[lane] = std::max(point.m_prevRHS / substeps_, btScalar(0));
    lanes.impulse_1[lane] = borne.dot(side_1);
    lanes.impulse_2[lane] = borne.dot(side_2);
  }
  lanes.side_1.set(lane, side_1);
  lanes.side_2.set(lane, side_2);
}

/// How the place goes along with them: the centre of curvature stays on its body, as if spheres touched. A
/// place without one is a corner, which is its own centre, or lies on a face; there it stays on the body, as it
/// does on what is nearly flat: that would roll off its end. Sizes of 0 are of what does not turn.
void ContactRows::fillCurves(PointLanes& lanes, int lane, const Source& source, btScalar size_a,
                             btScalar size_b) {
  Curvatures curved = curvaturesOf(*source.point);
  if (source.flipped) std::swap(curved.a, curved.b);
  const auto radius = [](btScalar curvature, btScalar size) {
    if (curvature == 0) return btScalar(0);
    return size == 0 || std::fabs(curvature) * size > 1 ? 1 / curvature : btScalar(0);
  };
  btScalar a = radius(curved.a, size_a), b = radius(curved.b, size_b);
  // Where surfaces fit each other there is no one place.
  if (!(curved.a + curved.b > kConforming * (std::fabs(curved.a) + std::fabs(curved.b)))) a = b = 0;
  const btVector3 normal = lanes.normal.get(lane);
  lanes.radius_a[lane] = a;
  lanes.radius_b[lane] = b;
  lanes.bend[lane] = a != 0 && b != 0 ? 1 / (a + b) : btScalar(0);
  lanes.normal_0.set(lane, normal);
  lanes.gap_0[lane] = lanes.gap[lane];
  lanes.pivot_a.set(lane, lanes.arm_a.get(lane) + normal * a);
  lanes.pivot_b.set(lane, lanes.arm_b.get(lane) - normal * b);
}

/// Where the bodies touch now.
void ContactRows::follow(const Block& block, PointLanes& point, const Bodies& a, const Bodies& b) {
  const Lanes3 moved = a.moved - b.moved;
  const Lanes3 way = moved + swing(a.axis, a.w, point.pivot_a) - swing(b.axis, b.w, point.pivot_b);
  const Lanes along = dot(way, point.normal_0);
  point.gap = point.gap_0 + along;
  // Both feel the push at one place, in the middle, so that it turns them as much as it would turn one body.
  Lanes3 apart = moved + point.normal_0 * point.gap_0;
  if (block.bends) {
    const Lanes3 aside = way - point.normal_0 * along;
    point.gap += inAll(btScalar(0.5)) * dot(aside, aside) * point.bend;
    const Lanes3 turned = point.normal_0 + aside * point.bend;
    const Lanes length = root(dot(turned, turned));
    point.normal = turned * (length > Lanes{} ? inAll(1) / length : Lanes{});
    point.side_1 = point.side_1 - point.normal * dot(point.side_1, point.normal);
    point.side_2 = point.side_2 - point.normal * dot(point.side_2, point.normal);
    apart = apart - (point.normal - point.normal_0) * (point.radius_a + point.radius_b);
  }
  point.arm_a = point.pivot_a - point.normal * point.radius_a - apart * block.share;
  point.arm_b = point.pivot_b + point.normal * point.radius_b + apart * block.share;
}

/// What the point has been told of forces, and what it bore.
void ContactRows::fillForces(PointLanes& lanes, int lane, const btManifoldPoint& point,
                             const ContactPair& pair, const SolverBodies& bodies) {
  for (int body : {pair.a, pair.b}) {
    const btRigidBody* rigid = bodies.rigid(body);
    if (rigid == nullptr || !rigid->hasAnisotropicFriction(btCollisionObject::CF_ANISOTROPIC_FRICTION)) continue;
    for (Lanes3* side : {&lanes.side_1, &lanes.side_2}) side->set(lane, scaledByAnisotropy(*rigid, side->get(lane)));
  }
  lanes.friction[lane] = point.m_combinedFriction;
  lanes.restitution[lane] = point.m_combinedRestitution;
  lanes.rolling[lane] = point.m_combinedRollingFriction;
  lanes.spinning[lane] = point.m_combinedSpinningFriction;
  const btScalar most = lanes.friction[lane] * lanes.impulse[lane];
  const btScalar held = std::hypot(lanes.impulse_1[lane], lanes.impulse_2[lane]);
  if (held > most) {
    lanes.impulse_1[lane] *= most / held;
    lanes.impulse_2[lane] *= most / held;
  }
}

/// How much each row moves.
void ContactRows::fillMasses(PointLanes& point, const Bodies& a, const Bodies& b, bool rolls) {
  const auto along = [&](const Lanes3& way) {
    const Lanes3 turn_a = cross(point.arm_a, way), turn_b = cross(point.arm_b, way);
    return massOf(dot(way, scaled(a.inverse_mass, way)) + dot(way, scaled(b.inverse_mass, way)) +
                  dot(turn_a, a.inverseInertiaTimes(turn_a)) + dot(turn_b, b.inverseInertiaTimes(turn_b)));
  };
  const auto about = [&](const Lanes3& axis) {
    return massOf(dot(axis, a.inverseInertiaTimes(axis)) + dot(axis, b.inverseInertiaTimes(axis)));
  };
  point.mass = along(point.normal);
  point.mass_1 = along(point.side_1);
  point.mass_2 = along(point.side_2);
  if (!rolls) return;
  point.mass_rolling = smaller(about(point.side_1), about(point.side_2));
  point.mass_spinning = about(point.normal);
}

/// How they give way.
void ContactRows::fillSoftness(PointLanes& lanes, int lane, const btManifoldPoint& point, const ContactPair& pair,
                               const SolverBodies& bodies) const {
  const bool both_move = bodies.isMovable(pair.b);
  const btScalar size = both_move ? std::min(bodies.size(pair.a), bodies.size(pair.b)) : bodies.size(pair.a);
  Softness soft = both_move ? soft_ : soft_on_fixed_;
  lanes.fastest[lane] = std::max(kFastest * size, -kLeaving * point.getDistance());
  if (const auto spring = springOf(point, substep_ * substeps_)) {
    soft = Softness::ofSpring(spring->stiffness, spring->damping, lanes.mass[lane], substep_);
    lanes.spring[lane] = 1;
    lanes.fastest[lane] = BT_LARGE_FLOAT;
  }
  lanes.rate[lane] = soft.rate;
  lanes.soft_mass[lane] = soft.mass;
  lanes.soft_impulse[lane] = soft.impulse;
}

void ContactRows::warmStart(int index, std::vector<BodyState>& states) {
  Block& block = blocks_[static_cast<std::size_t>(index)];
  block.bouncing = false;
  Bodies a(block.a, states), b(block.b, states);
  for (int i = block.begin; i < block.begin + block.count; ++i) {
    PointLanes& point = points_[static_cast<std::size_t>(i)];
    if (block.bounces) startBounces(block, point, a, b);
    const Lanes3 impulse =
        point.normal * point.impulse + point.side_1 * point.impulse_1 + point.side_2 * point.impulse_2;
    a.pushAt(point.arm_a, impulse);
    b.pushAt(point.arm_b, impulse * inAll(-1));
    if (!block.rolls) continue;
    const Lanes3 turn =
        point.side_1 * point.roll_1 + point.side_2 * point.roll_2 + point.normal * point.spin;
    a.turn(turn);
    b.turn(turn * inAll(-1));
  }
  a.put(block.a, movable_, states);
  b.put(block.b, movable_, states);
}

/// Points that the bodies reach in this substep leave as fast as restitution says. What threw them back is no
/// load that goes on.
void ContactRows::startBounces(Block& block, PointLanes& point, const Bodies& a, const Bodies& b) const {
  const Lanes none{};
  const auto bounced = point.bounce > none;
  point.impulse = bounced ? none : point.impulse;
  point.impulse_1 = bounced ? none : point.impulse_1;
  point.impulse_2 = bounced ? none : point.impulse_2;
  const Lanes speed = dot(a.velocityAt(point.arm_a) - b.velocityAt(point.arm_b), point.normal);
  const auto hits = point.gap + speed * inAll(substep_) <= none;
  point.bounce = hits ? speed * point.restitution * inAll(-1) : none;
  point.bounce = speed < inAll(-bounce_threshold_) ? point.bounce : none;
  for (int lane = 0; lane < kLanes; ++lane) block.bouncing = block.bouncing || point.bounce[lane] > 0;
}

void ContactRows::solveFriction(const Block& block, PointLanes& point, Bodies& a, Bodies& b) {
  const Lanes3 slide = a.velocityAt(point.arm_a) - b.velocityAt(point.arm_b);
  Lanes along_1 = point.impulse_1 - point.mass_1 * (dot(slide, point.side_1) - point.belt_1);
  Lanes along_2 = point.impulse_2 - point.mass_2 * (dot(slide, point.side_2) - point.belt_2);
  holdWithin(point.friction * point.impulse, along_1, along_2);
  const Lanes3 impulse =
      point.side_1 * (along_1 - point.impulse_1) + point.side_2 * (along_2 - point.impulse_2);
  point.impulse_1 = along_1;
  point.impulse_2 = along_2;
  a.pushAt(point.arm_a, impulse);
  b.pushAt(point.arm_b, impulse * inAll(-1));
  if (!block.rolls) return;
  const Lanes3 rolls = a.spin - b.spin;
  Lanes roll_1 = point.roll_1 - point.mass_rolling * dot(rolls, point.side_1);
  Lanes roll_2 = point.roll_2 - point.mass_rolling * dot(rolls, point.side_2);
  holdWithin(point.rolling * point.impulse, roll_1, roll_2);
  const Lanes most = point.spinning * point.impulse;
  const Lanes spin =
      larger(smaller(point.spin - point.mass_spinning * dot(rolls, point.normal), most), most * inAll(-1));
  const Lanes3 turn = point.side_1 * (roll_1 - point.roll_1) + point.side_2 * (roll_2 - point.roll_2) +
                      point.normal * (spin - point.spin);
  point.roll_1 = roll_1;
  point.roll_2 = roll_2;
  point.spin = spin;
  a.turn(turn);
  b.turn(turn * inAll(-1));
}

void ContactRows::solveNormal(PointLanes& point, Pass pass, Bodies& a, Bodies& b) const {
  const Lanes none{}, one = inAll(1);
  const Lanes gap = point.gap;
  const Lanes speed = dot(a.velocityAt(point.arm_a) - b.velocityAt(point.arm_b), point.normal);
  const auto open = gap > none;
  const auto bounces = point.bounce > none;
  // Apart, they may come as near as they are; in each other, they are driven apart.
  Lanes bias = gap * inAll(1 / substep_), mass = one, impulse = none, acts = one;
  if (pass == Pass::push) {
    bias = open ? bias : larger(gap * point.rate, point.fastest * inAll(-1));
    mass = open ? one : point.soft_mass;
    impulse = open ? none : point.soft_impulse;
  } else {
    bias = open ? bias : none;
    // What is to bounce goes on until its substep; a spring of the user's is no error to be given back.
    const Lanes goes_on = speed * point.restitution < inAll(-bounce_threshold_) * point.restitution ? none : one;
    acts = open ? goes_on : one - point.spring;
  }
  bias = bounces ? point.bounce * inAll(-1) : bias;
  mass = bounces ? one : mass;
  impulse = bounces ? none : impulse;
  const Lanes change = acts * (none - point.mass * mass * (speed + bias) - impulse * point.impulse);
  const Lanes total = larger(point.impulse + change, none);
  const Lanes3 push = point.normal * (total - point.impulse);
  point.impulse = total;
  a.pushAt(point.arm_a, push);
  b.pushAt(point.arm_b, push * inAll(-1));
}

void ContactRows::solve(int index, Pass pass, std::vector<BodyState>& states) {
  const Block& block = blocks_[static_cast<std::size_t>(index)];
  Bodies a(block.a, states), b(block.b, states);
  PointLanes* const begin = points_.data() + block.begin;
  PointLanes* const end = begin + block.count;
  if (pass == Pass::relax) {
    for (PointLanes* point = begin; point != end; ++point) follow(block, *point, a, b);
  }
  for (int round = block.bouncing ? kBounceRounds : 1; round > 0; --round) {
    for (PointLanes* point = begin; point != end; ++point) {
      solveNormal(*point, pass, a, b);
      solveFriction(block, *point, a, b);
    }
  }
  for (int i = block.begin; pass == Pass::relax && i < block.begin + block.count; ++i) {
    PointLanes& point = points_[static_cast<std::size_t>(i)];
    point.sum += point.impulse;
    point.sum_1 += point.impulse_1;
    point.sum_2 += point.impulse_2;
  }
  a.put(block.a, movable_, states);
  b.put(block.b, movable_, states);
}

void ContactRows::writeBack(int index) {
  const Block& block = blocks_[static_cast<std::size_t>(index)];
  for (int lane = 0; lane < kLanes; ++lane) {
    if (block.pair[lane] < 0) continue;
    const ContactPair& pair = pairs_[static_cast<std::size_t>(block.pair[lane])];
    for (int i = 0; i < pair.count; ++i) {
      const PointLanes& from = points_[static_cast<std::size_t>(block.begin + i)];
      const Source& source = sources_[static_cast<std::size_t>(pair.begin + i)];
      btManifoldPoint& point = *source.point;
      const bool bounced = from.bounce[lane] > 0;
      point.m_appliedImpulse = from.sum[lane];
      point.m_prevRHS = bounced ? btScalar(0) : from.impulse[lane] * substeps_;
      point.m_appliedImpulseLateral1 = from.sum_1[lane];
      point.m_appliedImpulseLateral2 = from.sum_2[lane];
      if ((point.m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED) != 0) continue;
      const btScalar sign = source.flipped ? btScalar(-1) : btScalar(1);
      point.m_lateralFrictionDir1 = from.side_1.get(lane) * sign;
      point.m_lateralFrictionDir2 = from.side_2.get(lane) * sign;
    }
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
