#include "response/manifold_writer.hpp"

#include <algorithm>
#include <cmath>

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>

#include "common/contact_tolerances.hpp"
#include "common/motion_bound.hpp"
#include "response/patch_friction.hpp"
#include "solver/point_curvature.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Patches whose normals differ by more than about 45 degrees are not the same patch.
constexpr btScalar kSamePatch = btScalar(0.7);

/// Share of the friction that slips may ask for; the rest is there for what pushes.
constexpr btScalar kSlipShare = btScalar(0.5);
/// A slip of more than this share of the threshold at which Bullet drops contacts is given up.
constexpr btScalar kFarthestSlip = btScalar(0.2);

/// Ratio: curvatures are those of triangles. Where less than this part of two is left, as in threads, the
/// rest is that of their errors.
constexpr btScalar kSureCurvature = btScalar(0.3);

/// Ratio: what bends by no more than this part of the other surface is flat, not hollow. Curvatures of flat
/// triangles are those of rounding.
constexpr btScalar kNotHollow = btScalar(1e-5);

/// In sizes of the smaller body: what is no further below its top, or behind it, meets with it, and its
/// normal is no more than a degree off.
constexpr btScalar kAtTop = btScalar(1e-4);

using PointIndices = std::array<int, kPatchPoints>;

struct NewPoint {
  PointLaw law;
  btScalar depth = 0;
  btVector3 normal{0, 0, 0};   ///< from A to B
  btVector3 on_b{0, 0, 0};     ///< in the world
  btVector3 local_a{0, 0, 0};  ///< the point on A, in the frame of A's object
  btVector3 slip{0, 0, 0};     ///< of A on B, that friction is to undo
  btVector3 aside{0, 0, 0};    ///< of the point on A from the one on B
  btScalar friction = 1;       ///< share of it
  btScalar curvature = 0;      ///< mean of both surfaces together [1/m]
  btScalar ahead = 0;          ///< how much further on bodies that rock touch when the step ends [m]
  btScalar nearer = 0;         ///< how much nearer the bodies come in the step as a hollow bends [m]
  btScalar turns_away = 0;     ///< and how much less than by their speed, as they turn elsewhere [m]
  bool is_later = false;       ///< bodies will have bounced from the top of its hill when they come to it
  PointBends bends;
};

/// Pairs each new point with the nearest old one, nearest pairs first; -1 where there are more new ones.
PointIndices matchPoints(const btPersistentManifold& manifold, const NewPoint* points, int count) {
  PointIndices match;
  match.fill(-1);
  std::array<bool, kPatchPoints> taken{};
  const int old_count = manifold.getNumContacts();
  for (int round = 0; round < std::min(count, old_count); ++round) {
    int best_new = -1, best_old = -1;
    btScalar best = BT_LARGE_FLOAT;
    for (int i = 0; i < count; ++i) {
      if (match[i] >= 0) continue;
      for (int j = 0; j < old_count; ++j) {
        const btScalar distance = manifold.getContactPoint(j).m_localPointA.distance2(points[i].local_a);
        if (!taken[j] && distance < best) {
          best = distance;
          best_new = i;
          best_old = j;
        }
      }
    }
    if (best_new < 0) break;
    match[best_new] = best_old;
    taken[best_old] = true;
  }
  return match;
}

void removeUnmatched(btPersistentManifold& manifold, PointIndices& match) {
  for (int j = manifold.getNumContacts() - 1; j >= 0; --j) {
    if (std::find(match.begin(), match.end(), j) != match.end()) continue;
    const int last = manifold.getNumContacts() - 1;
    manifold.removeContactPoint(j);  // moves the last point to j
    std::replace(match.begin(), match.end(), last, j);
  }
}

btManifoldPoint* pointAt(btPersistentManifold& manifold, const btVector3& on_b) {
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    if (manifold.getContactPoint(i).m_positionWorldOnB == on_b) return &manifold.getContactPoint(i);
  }
  return nullptr;
}

/// Points of bodies that the user has given friction anchors are kept by Bullet as they are, their depth too,
/// while friction holds. Here all friction that holds is anchored: the point is to be replaced.
void letGo(const btCollisionObject& a, const btCollisionObject& b, btManifoldPoint& cached) {
  if (((a.getCollisionFlags() | b.getCollisionFlags()) & btCollisionObject::CF_HAS_FRICTION_ANCHOR) == 0)
    return;
  constexpr btScalar kSome = btScalar(1e-15);  // more than friction of 0 holds
  cached.m_combinedFriction = 0;
  if (cached.m_appliedImpulseLateral1 == 0) cached.m_appliedImpulseLateral1 = kSome;
}

/// Bullet takes points for one that are nearer to each other than the distance at which it drops contacts.
/// Where contact is foretold that may be further than bodies are large: a new point gets an empty one to be
/// put in, but for the first of a manifold. Returns its index, or -1.
int makePlace(btPersistentManifold& manifold) {
  if (manifold.getNumContacts() == 0) return -1;
  btManifoldPoint place;
  place.m_distance1 = BT_LARGE_FLOAT;
  constexpr bool kAnyDistance = true;
  return manifold.addManifoldPoint(place, kAnyDistance);
}

/// Far from the origin, places may be rounded to that of another point, which has been replaced then.
void removeIfEmpty(int place, btPersistentManifold& manifold) {
  if (place >= 0 && manifold.getContactPoint(place).m_distance1 == BT_LARGE_FLOAT)
    manifold.removeContactPoint(place);
}

/// B's share of what the places on both bodies are told to be further apart, for the solver's sake. Where
/// they are is a lever, too, and would turn the lighter one: what rolls would gain speed from a slip, and
/// what bounces spin from a gap.
btScalar shareOfHeavier(const btCollisionObject& a, const btCollisionObject& b) {
  const btScalar of_a = inverseMass(a), of_b = inverseMass(b);
  return of_a > 0 ? of_a / (of_a + of_b) : btScalar(0);
}

/// The restitution of what bounces from a gap, so that it is as fast there as it would be when it has been at
/// the surface and comes back: the solver has it turn round at once, and forces pull it on all the while.
btScalar restitutionAt(btScalar gap, btScalar approach, btScalar pull, btScalar time_step,
                       btScalar restitution) {
  // Bullet's speeds are those of half a step ago.
  const btScalar closing = approach + pull / 2, in_gap = 2 * pull / time_step * gap;
  const btScalar there = restitution * restitution * (closing * closing + in_gap) - in_gap;
  return there > 0 ? btMax((btSqrt(there) - pull / 2) / approach, btScalar(0)) : btScalar(0);
}

/// Stiffness, damping and the depth they act on, and the slip that friction is to undo, unless the user has
/// set a law of their own, through the bodies or in a material callback. The callback has seen the true
/// depth.
void setLaw(btManifoldPoint& point, const NewPoint& from, const btCollisionObject& a,
            const btCollisionObject& b, const PairMotion& motion, const SolverSettings& solver) {
  constexpr int kUsersOwn = BT_CONTACT_FLAG_HAS_CONTACT_CFM | BT_CONTACT_FLAG_HAS_CONTACT_ERP |
                            BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING;
  const PointLaw& law = from.law;
  if (!law.solved) return;
  // Directions of the user's own may be those of a belt that moves what lies on it.
  const bool belt = (point.m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED) != 0;
  if (!belt) point.m_combinedFriction *= from.friction * law.friction;
  if (point.m_combinedFriction > 0 && point.m_combinedRollingFriction == 0) {
    const btScalar tilts = motion.spin().cross(from.normal).length() * law.time_step;
    point.m_combinedRollingFriction = law.rolling + law.tilting * tilts + from.ahead;
  }
  // Bullet reads the one only where there is the other.
  if (law.rolling > 0 && point.m_combinedSpinningFriction == 0)
    point.m_combinedSpinningFriction =
        point.m_combinedFriction * spinningLever(from.depth, from.curvature, motion.spin(), from.normal);
  if (law.penalty) {
    point.m_combinedContactStiffness1 = law.stiffness;
    point.m_combinedContactDamping1 = law.damping;
    return;
  }
  const bool users_own = (point.m_contactPointFlags & kUsersOwn) != 0;
  bool spring = law.spring && !users_own;
  btScalar depth = users_own ? from.depth : law.depth;
  // A bounce starts from the surface: the depth that was reached within the step must not add to it, nor the
  // distance that is left, or the give of the spring, take from it.
  const btScalar approach = motion.approachAt(from.on_b, from.normal);
  const bool meets = depth + approach * law.time_step > 0;
  const bool bounces = point.m_combinedRestitution * approach > law.push;
  if (solver.substeps) {
    setBends(point, from.bends);
  } else {
    // The solver would begin the bounce before they touch, and brake them on their way.
    if (!meets || from.is_later) point.m_combinedRestitution = 0;
    if (meets && bounces && !from.is_later && (depth < 0 || spring)) {
      const btScalar pull = law.time_step * (accelerationOf(a) - accelerationOf(b)).dot(from.normal);
      point.m_combinedRestitution = restitutionAt(btMax(-from.depth, btScalar(0)), approach, pull,
                                                  law.time_step, point.m_combinedRestitution);
      depth = 0;
      spring = false;
    }
  }
  // The solver lets a gap close at a constant speed; points beside the one that a body rolls on turn away
  // instead, and would brake it.
  if (depth < 0 && !solver.substeps)
    depth = btMin(btScalar(0), depth + (from.nearer > 0 ? from.nearer : -from.turns_away));
  // A spring gives way by a part of the speed that it stops: too far for what is thin.
  if (motion.isSwept() && meets && approach * law.time_step > depth) spring = false;
  // What the bend of a hollow would drive in within the step is to leave as fast: bodies follow it, neither
  // braked nor sinking in.
  const btScalar driven_in = from.nearer + btMin(from.depth, btScalar(0));
  if (driven_in > 0 && !users_own && !(meets && bounces)) {
    const btScalar held = law.time_step * law.stiffness;
    const btScalar share = spring ? held / (held + law.damping) : solver.erp;
    depth = btMin(depth + driven_in / share, spring ? solver.deepest_spring : solver.deepest_push);
  }
  if (spring) {
    // The solver starts with a part of the last impulse. What is short of a load that lies still would make
    // it sink until its spring has replaced it: where the spring bears more, it starts with all of it. A
    // spring that is held back does so while the bodies still come nearer: later it would throw them apart.
    if (solver.warm_starting > 0 && law.starts)
      point.m_appliedImpulse = law.bears / solver.warm_starting;
    else if (solver.warm_starting > 0 && !(law.held_back && approach < 0))
      point.m_appliedImpulse =
          btMax(point.m_appliedImpulse, btMin(point.m_appliedImpulse / solver.warm_starting, law.bears));
    point.m_combinedContactStiffness1 = law.stiffness;
    point.m_combinedContactDamping1 = law.damping;
    point.m_contactPointFlags |= BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING;
  }
  const bool driven_apart = law.depth < from.depth;
  const bool held = !driven_apart && !from.slip.isZero() && !belt;
  point.m_contactPointFlags &= ~BT_CONTACT_FLAG_FRICTION_ANCHOR;
  if (held) point.m_contactPointFlags |= BT_CONTACT_FLAG_FRICTION_ANCHOR;
  if (depth == from.depth && !held && from.aside.isZero()) return;
  point.m_distance1 = -depth;
  const btVector3 slip = held ? from.slip : btVector3(0, 0, 0);
  const btVector3 apart = from.normal * (depth - from.depth) + slip;
  // A SubstepSolver takes places along with the bodies, and asks for no slip.
  const btScalar of_b = solver.substeps ? btScalar(0) : shareOfHeavier(a, b);
  point.m_positionWorldOnA = from.on_b + from.normal * from.depth + from.aside + apart * (1 - of_b);
  point.m_positionWorldOnB = from.on_b - apart * of_b;
  point.m_localPointB = b.getWorldTransform().invXform(point.m_positionWorldOnB);
  point.m_localPointA = a.getWorldTransform().invXform(point.m_positionWorldOnA);
}

/// A point above a slope whose hilltop is among the points. A SubstepSolver has the hill go along with the
/// bodies, so that its top meets the other body before the slope does. Tops of other hills do not count: they
/// may touch while this one still comes down. Along a ridge, where a hill has no top, all places are tops,
/// but one end may touch while the other comes down: it has to be as deep after the step, too, as the ridge
/// is here.
bool leavesItToTop(const ContactPatch& patch, int index, const btVector3& origin, const PairMotion& motion,
                   btScalar time_step, btScalar separation) {
  const ContactPoint& point = patch.points[index];
  if (point.depth >= 0 || point.to_top.isZero()) return false;
  const Hill hill(point.bend_a, point.bend_b, point.depth, bendAxes(point));
  const auto approachAt = [&](const btVector3& place) {
    return motion.approachAt(origin + place, point.normal);
  };
  for (int i = 0; i < patch.count; ++i) {
    const ContactPoint& other = patch.points[i];
    btVector3 across(0, 0, 0), along(0, 0, 0);
    for (int k = 0; k < 2; ++k)
      (hill.hasTop(k) ? across : along) += hill.axis(k) * hill.axis(k).dot(other.on_b - point.on_b);
    const btScalar deeper = other.depth - point.depth - point.below_top / 2;
    const btScalar falls_back = time_step * (approachAt(other.on_b - along) - approachAt(other.on_b));
    if (deeper > btMax(btScalar(0), falls_back) &&
        across.distance(point.to_top) < btMax(kSameHill * across.length(), kSameTop * separation))
      return true;
  }
  return false;
}

/// The curves along an axis across the normal in which two surfaces touch.
struct Curves {
  Curves(const ContactPoint& point, const Across& axes, const btVector3& axis, const btVector3& place,
         const PairMotion& motion)
      : k(point.bend_a.turn(axis, axes).dot(axis)),
        l(point.bend_b.turn(axis, axes).dot(axis)),
        v(motion.velocityAt(place).dot(axis)),
        u(motion.a().spin.cross(point.normal).dot(axis)),
        w(motion.b().spin.cross(point.normal).dot(axis)) {}
  /// The acceleration with which they come nearer, beside that of the bodies' points.
  btScalar approach() const {
    return ((u - w) * (u - w) + 2 * v * (k * w + l * u) - k * l * v * v) / (k + l);
  }
  btScalar k, l;  ///< of A and B: how they bend [1/m]
  btScalar v;     ///< how fast they slide [m/s]
  btScalar u, w;  ///< and how fast their normals turn [1/s]
};

/// How much nearer bodies come to each other in the step than the plane in which they touch says, where one
/// lies in a hollow of the other [m]: as that bends, and both turn. That is the second order of the gap
/// between two curves. Not where they touch only later, further on, nor where the sum of both bends is not
/// known, nor where what is round is all but flat for a body of this radius [m].
btScalar nearerByBending(const ContactPoint& point, const btVector3& place, const PairMotion& motion,
                         btScalar time_step, btScalar size) {
  const bool in_b = point.bend_b.isHollow();
  if (in_b == point.bend_a.isHollow()) return 0;
  const Across axes = bendAxes(point);
  const Hill hill(point.bend_a, point.bend_b, point.depth, axes);
  btScalar acceleration = 0;
  for (int i = 0; i < 2; ++i) {
    if (!hill.hasTop(i)) continue;
    const Curves curves(point, axes, hill.axis(i), place, motion);
    const btScalar k = curves.k, l = curves.l;
    const btScalar hollow = in_b ? l : k, round = in_b ? k : l;
    const bool sure = k + l > kSureCurvature * (btFabs(k) + btFabs(l)) && 2 * size * round > 1;
    if (!(hollow < 0) || !sure) continue;
    // By this angle the normal turns within the step; they touch here from where it is that of the point.
    const btScalar angle = btFabs(k * l * curves.v - k * curves.w - l * curves.u) / (k + l) * time_step;
    const btScalar left = btMin(angle, kSteepSlope) + hollow * btFabs(point.to_top.dot(hill.axis(i)));
    if (!(left > 0)) continue;
    const btScalar share = left / angle;
    acceleration += share * share * curves.approach();
  }
  if (acceleration == 0) return 0;
  acceleration += motion.approachByTurningAt(place, point.normal);
  return acceleration * time_step * time_step / 2;
}

/// How much less near bodies come in the step than by their speeds, as they turn [m]: by as much as their
/// points turn away. At the top of a hill other points take their place, see above: none of it is left where
/// what is round rolls on a plane. Not where bodies are all but flat together.
btScalar turnsAway(const ContactPoint& point, const btVector3& place, const PairMotion& motion,
                   btScalar time_step, btScalar separation, btScalar size) {
  btScalar acceleration = motion.approachByTurningAt(place, point.normal), beyond = 0;
  if (!(point.to_top.length() > kSameTop * separation)) {
    const Across axes = bendAxes(point);
    const Hill hill(point.bend_a, point.bend_b, point.depth, axes);
    for (int i = 0; i < 2; ++i) {
      if (!hill.hasTop(i) || !(2 * size * hill.fall(i) > 1)) continue;
      const Curves curves(point, axes, hill.axis(i), place, motion);
      const btScalar k = curves.k, l = curves.l;
      if (btMin(k, l) < -kNotHollow * btMax(k, l)) continue;
      acceleration += curves.approach();
      // Of circles, what the second order leaves out. Flat ones have none.
      if (!(2 * size * btMin(k, l) > 1)) continue;
      const btScalar radii = 1 / k + 1 / l, aside = (curves.v - curves.u / k - curves.w / l) * time_step;
      const btScalar left = radii - point.depth - motion.velocityAt(place).dot(point.normal) * time_step;
      if (left > 0) beyond += aside * aside * (1 / (left + std::hypot(left, aside)) - 1 / (2 * radii));
    }
  }
  return beyond - acceleration * time_step * time_step / 2;
}

/// How bodies bend at a point, in the axes in which a SubstepSolver is told so.
PointBends bendsAcross(const ContactPoint& point) {
  const Across to(point.normal), from = bendAxes(point);
  return {point.bend_a.along(to.x, to.y, from), point.bend_b.along(to.x, to.y, from)};
}

/// Bullet has found the points' places on the bodies as if all of them were where kinematic ones will be.
void takeToStart(const Placed& start, btPersistentManifold& manifold) {
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    btManifoldPoint& point = manifold.getContactPoint(i);
    point.m_localPointA = start.a.invXform(point.m_positionWorldOnA);
    point.m_localPointB = start.b.invXform(point.m_positionWorldOnB);
  }
}

/// Returns when bodies meet first, from the start of the step [s].
btScalar firstMeeting(const std::vector<ContactPatch>& patches, const btVector3& origin,
                      const PairMotion& motion) {
  btScalar first = BT_LARGE_FLOAT;
  for (const ContactPatch& patch : patches) {
    for (int i = 0; i < patch.count; ++i) {
      const ContactPoint& point = patch.points[i];
      const btScalar approach = motion.approachAt(origin + point.on_b, point.normal);
      if (approach > 0) first = btMin(first, btMax(-point.depth / approach, btScalar(0)));
    }
  }
  return first;
}

/// A slope of a hill that meets later than another point, its top.
bool meetsAfterTop(const ContactPoint& point, const btVector3& place, const PairMotion& motion,
                   btScalar first, btScalar size) {
  const btScalar left = -point.depth - first * motion.approachAt(place, point.normal);
  return btMin(point.below_top, left) > kAtTop * size;
}

/// The points of one patch into the manifold that `result` holds.
void writePatch(const btCollisionObject& a, const btCollisionObject& b, const Placed& start,
                const PairMotion& motion, const btVector3& origin, const ContactPatch& patch, btScalar first,
                const ContactLaw::OfPatch& law, const SolverSettings& solver, btManifoldResult* result) {
  btPersistentManifold& manifold = *result->getPersistentManifold();
  std::array<NewPoint, kPatchPoints> points;
  btScalar load = 0;
  for (int i = 0; i < manifold.getNumContacts(); ++i) load += manifold.getContactPoint(i).m_appliedImpulse;
  int count = 0;
  for (int i = 0; i < patch.count; ++i) {
    NewPoint& point = points[count];
    point.depth = patch.points[i].depth;
    point.law = law.at(point.depth);
    if (-point.depth > manifold.getContactBreakingThreshold()) continue;
    if (solver.substeps &&
        leavesItToTop(patch, i, origin, motion, point.law.time_step, manifold.getContactBreakingThreshold()))
      continue;
    point.normal = patch.points[i].normal;
    point.curvature = patch.points[i].bend_a.mean() + patch.points[i].bend_b.mean();
    point.on_b = origin + patch.points[i].on_b;
    if (point.law.rocks)
      point.ahead =
          btMin(law.size(), point.law.time_step * rockingSpeed(patch.points[i], point.on_b, motion, a, b,
                                                               law.size(), load, point.law.time_step));
    if (solver.substeps) {
      point.bends = bendsAcross(patch.points[i]);
    } else {
      point.nearer = nearerByBending(patch.points[i], point.on_b, motion, point.law.time_step, law.size());
      // That is for gaps alone.
      if (point.depth < 0 || point.law.depth < 0)
        point.turns_away = turnsAway(patch.points[i], point.on_b, motion, point.law.time_step,
                                     manifold.getContactBreakingThreshold(), law.size());
      point.is_later = meetsAfterTop(patch.points[i], point.on_b, motion, first, law.size());
    }
    point.aside = patch.points[i].aside;
    point.local_a = start.a.invXform(point.on_b + point.normal * point.depth);
    ++count;
  }
  PointIndices match = matchPoints(manifold, points.data(), count);
  removeUnmatched(manifold, match);
  const btScalar friction = slidingShare(motion, patch, manifold);
  const btScalar largest_slip = law.slipUndoneBy(kSlipShare * mostFriction(manifold));
  const btScalar farthest_slip = kFarthestSlip * manifold.getContactBreakingThreshold();
  for (int i = 0; i < count; ++i) {
    NewPoint& point = points[i];
    point.friction = friction;
    // Where Bullet, which has moved kinematic bodies, will say that it is.
    const btVector3 local_a =
        motion.a().has_arrived ? a.getWorldTransform().invXform(start.a * point.local_a) : point.local_a;
    // Bullet keeps impulses and lifetime of the cached point nearest to the new one: move that which is to
    // become it there first.
    const bool known = match[i] >= 0;
    const int place = known ? match[i] : makePlace(manifold);
    if (place >= 0) {
      btManifoldPoint& cached = manifold.getContactPoint(place);
      if (known && !solver.substeps)
        point.slip = slipOf(cached, start, motion, point.on_b, point.normal, point.law.time_step,
                            largest_slip, farthest_slip);
      cached.m_localPointA = local_a;
      letGo(a, b, cached);
    }
    result->addContactPoint(-point.normal, point.on_b, -point.depth);
    if (!known) removeIfEmpty(place, manifold);
    if (btManifoldPoint* added = pointAt(manifold, point.on_b)) setLaw(*added, point, a, b, motion, solver);
  }
  result->refreshContactPoints();
  if (motion.a().has_arrived || motion.b().has_arrived) takeToStart(start, manifold);
}

}  // namespace

void ManifoldWriter::clear() {
  for (const Entry& entry : entries_) dispatcher_->releaseManifold(entry.manifold);
  entries_.clear();
}

void ManifoldWriter::report(const btCollisionObject& a, const btCollisionObject& b, const btVector3& origin,
                            const std::vector<ContactPatch>& patches, btManifoldResult* result) {
  // The result looks up the order of the bodies in its manifold.
  btPersistentManifold order(&a, &b, 0, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  btPersistentManifold* const before = result->getPersistentManifold();
  result->setPersistentManifold(&order);
  for (const ContactPatch& patch : patches) {
    for (int i = 0; i < patch.count; ++i) {
      const ContactPoint& point = patch.points[i];
      result->addContactPoint(-point.normal, origin + point.on_b, -point.depth);
    }
  }
  result->setPersistentManifold(before);
}

void ManifoldWriter::append(btManifoldArray& manifolds) const {
  for (const Entry& entry : entries_) manifolds.push_back(entry.manifold);
}

void ManifoldWriter::assign(const btTransform& a, const std::vector<ContactPatch>& patches) {
  owner_.assign(entries_.size(), -1);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const ContactPatch& patch = patches[p];
    const btVector3 normal = patch.normal * a.getBasis();
    const btVector3 centre = patch.centre * a.getBasis();
    const btScalar extent = btSqrt(patch.area) + btScalar(1e-30);
    int best = -1;
    btScalar best_cost = BT_LARGE_FLOAT;
    for (std::size_t e = 0; e < entries_.size(); ++e) {
      const btScalar cosine = normal.dot(entries_[e].normal);
      const btScalar cost = 1 - cosine + entries_[e].centre.distance(centre) / extent;
      if (owner_[e] < 0 && cosine > kSamePatch && cost < best_cost) {
        best_cost = cost;
        best = static_cast<int>(e);
      }
    }
    if (best >= 0) owner_[best] = static_cast<int>(p);
  }
}

/// Gives patches that match no manifold an idle one, or a new one.
void ManifoldWriter::provide(const btCollisionObject& a, const btCollisionObject& b, std::size_t count) {
  for (std::size_t p = 0; p < count; ++p) {
    if (std::find(owner_.begin(), owner_.end(), static_cast<int>(p)) != owner_.end()) continue;
    auto idle = std::find(owner_.begin(), owner_.end(), -1);
    if (idle == owner_.end()) {
      btPersistentManifold* manifold = dispatcher_->getNewManifold(&a, &b);
      if (manifold == nullptr)
        return;  // the user has limited their number; Bullet's own algorithms go without, too
      entries_.push_back({manifold, manifold->getContactBreakingThreshold(),
                          manifold->getContactProcessingThreshold(), btVector3(0, 0, 0), btVector3(0, 0, 0)});
      idle = owner_.insert(owner_.end(), -1);
    }
    *idle = static_cast<int>(p);
  }
}

void ManifoldWriter::write(const btCollisionObject& a, const btCollisionObject& b, const Placed& start,
                           const PairMotion& motion, const btVector3& origin,
                           const std::vector<ContactPatch>& patches, const ContactLaw& law,
                           btScalar separation, btManifoldResult* result) {
  if (patches.empty() && entries_.empty()) return;
  assign(start.a, patches);
  provide(a, b, patches.size());
  const btScalar first = law.solver().substeps ? btScalar(0) : firstMeeting(patches, origin, motion);
  btPersistentManifold* const before = result->getPersistentManifold();
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    Entry& entry = entries_[e];
    if (owner_[e] < 0) {
      while (entry.manifold->getNumContacts() > 0) entry.manifold->removeContactPoint(0);
      continue;
    }
    const std::size_t p = static_cast<std::size_t>(owner_[e]);
    entry.normal = patches[p].normal * start.a.getBasis();
    entry.centre = patches[p].centre * start.a.getBasis();
    entry.manifold->setContactBreakingThreshold(btMax(entry.threshold, separation));
    entry.manifold->setContactProcessingThreshold(law.penalty() ? -BT_LARGE_FLOAT : entry.processing);
    result->setPersistentManifold(entry.manifold);
    writePatch(a, b, start, motion, origin, patches[p], first, law.of(patches, p), law.solver(), result);
  }
  result->setPersistentManifold(before);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
