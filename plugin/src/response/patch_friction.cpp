#include "response/patch_friction.hpp"

#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Friction that used less than this share of what its cone allows (squared) has held.
constexpr btScalar kHeld = btScalar(0.98);
/// The part of the speeds of turning, squared, that counts: small ones are across the way of sliding, half of
/// them.
constexpr btScalar kAcross = btScalar(0.5);

/// Mean distance from the middle of a line, of that of its ends. Few spheres may tell less of an area.
constexpr btScalar kLine = btScalar(0.5);

bool held(const btManifoldPoint& point) {
  const btScalar most = point.m_combinedFriction * point.m_appliedImpulse;
  const btScalar first = point.m_appliedImpulseLateral1, second = point.m_appliedImpulseLateral2;
  return first * first + second * second < kHeld * most * most;
}

/// How readily a body turns about an axis across the normal through a place that is `height` from its centre
/// along the normal [1/(kg m^2)].
btScalar yieldsAt(const btCollisionObject& object, btScalar height, const btVector3& axis) {
  const btRigidBody* body = btRigidBody::upcast(&object);
  if (body == nullptr || object.isStaticOrKinematicObject() || !(body->getInvMass() > 0)) return 0;
  const btScalar yields = axis.dot(body->getInvInertiaTensorWorld() * axis);
  return yields / (1 + yields * height * height / body->getInvMass());
}

/// The way over a body's surface from where it touched to where it does, which are a chord apart now that it
/// has turned, laid out in the plane in which it touches [m]. The surface bends between both normals as a
/// circle does, along an axis across them.
btVector3 laidOut(const btVector3& chord, const btVector3& old_normal, const btVector3& normal,
                  const btVector3& turn) {
  const btScalar turned = turn.length();
  const btVector3 was = turned > 0 ? old_normal.rotate(turn / turned, turned) : old_normal;
  const btVector3 bend = was.cross(normal);
  const btScalar sine = bend.length();
  btVector3 way = chord;
  if (sine > 0) {
    const btVector3 axis = bend / sine, along = axis.cross(normal);
    const btScalar half = btAtan2(sine, was.dot(normal)) / 2;
    way = way.rotate(axis, half);
    way += along * (along.dot(way) * (half / btSin(half) - 1));
  }
  way -= normal * normal.dot(way);
  // About the normal it has turned half as far, in the mean of the way.
  return way - normal.cross(way) * (turn.dot(normal) / 2);
}

}  // namespace

btScalar mostFriction(const btPersistentManifold& manifold) {
  btScalar friction = 0;
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& point = manifold.getContactPoint(i);
    friction += point.m_combinedFriction * btMax(point.m_appliedImpulse, btScalar(0));
  }
  return friction;
}

btVector3 slipOf(const btManifoldPoint& cached, const Placed& start, const PairMotion& motion,
                 const btVector3& place, const btVector3& normal, btScalar time_step, btScalar largest,
                 btScalar farthest) {
  if (!(cached.m_combinedFriction * cached.m_appliedImpulse > 0)) return btVector3(0, 0, 0);
  const btVector3 was_a = start.a * cached.m_localPointA, was_b = start.b * cached.m_localPointB;
  const btVector3 between = was_a - was_b, apart = between - normal * normal.dot(between);
  const auto way = [&](const btVector3& chord, const btVector3& spin) {
    return laidOut(chord, -cached.m_normalWorldOnB, normal, spin * time_step);
  };
  const btVector3 slip = way(place - was_b, motion.b().spin) - way(place - was_a, motion.a().spin);
  const btScalar length = slip.length();
  if (length > farthest || apart.length() > farthest) return btVector3(0, 0, 0);
  return length > largest ? slip * (largest / length) : slip;
}

btScalar slidingShare(const PairMotion& motion, const ContactPatch& patch,
                      const btPersistentManifold& manifold) {
  btScalar load = 0;
  btVector3 centre(0, 0, 0);
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& point = manifold.getContactPoint(i);
    if (!(point.m_appliedImpulse > 0)) continue;
    if (held(point)) return 1;
    load += point.m_appliedImpulse;
    centre += point.m_positionWorldOnB * point.m_appliedImpulse;
  }
  if (!(load > 0)) return 1;
  centre /= load;
  btScalar rim = 0;
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& point = manifold.getContactPoint(i);
    const btScalar weight = btMax(point.m_appliedImpulse, btScalar(0)) / load;
    rim += point.m_positionWorldOnB.distance(centre) * weight;
  }
  const btVector3 speed = motion.velocityAt(centre);
  const btScalar slide = (speed - patch.normal * speed.dot(patch.normal)).length2();
  const btScalar spin = motion.spin().dot(patch.normal);
  const auto work = [&](btScalar radius) { return slide + kAcross * spin * spin * radius * radius; };
  const btScalar radius = btMax(patch.radius, kLine * rim);
  return radius < rim && spin != 0 ? btSqrt(work(radius) / work(rim)) : btScalar(1);
}

btScalar spinningLever(btScalar depth, btScalar curvature, const btVector3& spin, const btVector3& normal) {
  if (!(depth > 0 && curvature > 0)) return 0;
  const btScalar radius = btSqrt(depth / curvature);
  const btScalar spins = btFabs(spin.dot(normal)) * radius, rolls = spin.cross(normal).length() / curvature;
  return 3 * SIMD_PI / 16 * radius * (spins < rolls ? spins / rolls : btScalar(1));
}

btScalar rockingSpeed(const ContactPoint& point, const btVector3& place, const PairMotion& motion,
                      const btCollisionObject& a, const btCollisionObject& b, btScalar size, btScalar load,
                      btScalar time_step) {
  const btVector3 tilt = motion.spin().cross(point.normal);
  const btScalar all = tilt.length();
  if (all == 0) return 0;
  const Across axes = bendAxes(point);
  const Hill hill(point.bend_a, point.bend_b, point.depth, axes);
  const btScalar height_a = (place - motion.originA()).dot(point.normal),
                 height_b = (motion.originB() - place).dot(point.normal);
  btScalar work = 0;
  for (int i = 0; i < 2; ++i) {
    if (!hill.hasTop(i) || !(hill.fall(i) * size > kFlatTogether)) continue;
    const btVector3& axis = hill.axis(i);
    const auto past = [&](const btCollisionObject& body, btScalar height, const Bend& bend) {
      return body.isStaticOrKinematicObject() ? BT_LARGE_FLOAT : 1 - height * bend.turn(axis, axes).dot(axis);
    };
    const btScalar share = btMin(past(a, height_a, point.bend_a), past(b, height_b, point.bend_b));
    const btScalar along = tilt.dot(axis);
    if (!(share > 0)) continue;
    const btVector3 about = axis.cross(point.normal);
    const btScalar yields = yieldsAt(a, height_a, about) + yieldsAt(b, height_b, about);
    const btScalar lever = share / hill.fall(i), phase2 = load * time_step * lever * yields;
    work += btMin(phase2, btScalar(1)) * lever * along * along;
  }
  return work / all;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
