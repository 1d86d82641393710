// Contacts that move along with their bodies, against where those of the moved bodies are in closed form.
#include "narrow_phase/contact_transport.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test_packings.hpp"

namespace innersphere::test {
namespace {

constexpr btScalar kWide = 100;  ///< a spacing that lets contacts move as far as they like [m]

btTransform at(const btVector3& place, const btQuaternion& turn = btQuaternion::getIdentity()) {
  return btTransform(turn, place);
}

ContactPoint contactOf(const btVector3& on_b, const btVector3& normal, double depth, const Bend& bend_a,
                       const Bend& bend_b) {
  ContactPoint point;
  point.on_b = on_b;
  point.normal = normal;
  point.depth = btScalar(depth);
  point.bend_a = bend_a;
  point.bend_b = bend_b;
  point.bend_x = Across(normal).x;
  return point;
}

/// The contact of two balls, or of a ball and a plane.
ContactPoint contactOf(const btVector3& on_b, const btVector3& normal, double depth, double curvature_a,
                       double curvature_b) {
  return contactOf(on_b, normal, depth, Bend::round(btScalar(curvature_a)),
                   Bend::round(btScalar(curvature_b)));
}

/// A surface with this normal that bends by `along` in one direction, and by `across` in the other.
Bend bendOf(const btVector3& normal, const btVector3& direction, double along, double across) {
  const Across axes(normal);
  const double x = double(direction.dot(axes.x)), y = double(direction.dot(axes.y));
  return {btScalar(along * x * x + across * y * y), btScalar((along - across) * x * y),
          btScalar(along * y * y + across * x * x)};
}

/// Carries points of one patch from one place of the bodies to another.
std::vector<ContactPoint> carried(const PackingShape& a, const std::vector<ContactPoint>& points,
                                  const Placed& then, const Placed& now, btScalar spacing = kWide) {
  ContactTransport transport;
  ContactPatch patch;
  patch.normal = points[0].normal;
  for (const ContactPoint& point : points) patch.points[patch.count++] = point;
  transport.patches = {patch};
  transport.noteDepths(then, 1);
  transport.carryTo(now, a, spacing);
  return {transport.patches[0].points.begin(), transport.patches[0].points.begin() + patch.count};
}

struct Errors {
  double place, normal, depth;
};

Errors errorsOf(const ContactPoint& found, const btVector3& on_b, const btVector3& normal, double depth) {
  return {found.on_b.distance(on_b), found.normal.distance(normal), std::fabs(found.depth - depth)};
}

/// Half of the motion leaves a quarter of the error, but for rounding.
void expectSecondOrder(const Errors& whole, const Errors& half) {
  constexpr double kRounding = 3e-6;
  EXPECT_LT(half.place, whole.place / 3 + kRounding);
  EXPECT_LT(half.normal, whole.normal / 3 + kRounding);
  EXPECT_LT(half.depth, whole.depth / 3 + kRounding);
}

class TwoBalls : public testing::Test {
 protected:
  static constexpr double kA = 1, kB = 0.5;

  /// B slides around A, and both turn; all of it in proportion to `way` [m].
  Errors errorsAt(double way, double depth) const {
    const btVector3 up(0, 0, 1);
    const Placed then{at({3, 2, 1}), at(btVector3(3, 2, 1) + up * btScalar(kA + kB - depth))};
    const btVector3 move(btScalar(way), btScalar(0.4 * way), btScalar(-0.1 * way));
    const Placed now{
        at(then.a.getOrigin() + btVector3(btScalar(-0.3 * way), 0, 0),
           btQuaternion(btVector3(1, 2, 0).normalized(), btScalar(0.8 * way))),
        at(then.b.getOrigin() + move, btQuaternion(btVector3(0, 1, 1).normalized(), btScalar(-way)))};
    const ContactPoint point = contactOf(up * btScalar(kA - depth), up, depth, 1 / kA, 1 / kB);
    const btVector3 apart = now.b.getOrigin() - now.a.getOrigin();
    const btVector3 normal = apart.normalized();
    return errorsOf(carried(*shape_, {point}, then, now)[0], apart - normal * btScalar(kB), normal,
                    kA + kB - double(apart.length()));
  }

  std::shared_ptr<PackingShape> shape_ = makeShape(singleBall(kA));
};

// Of second order in the motion and in the depth, which the curvatures know nothing of.
TEST_F(TwoBalls, HaveTheirContactBetweenTheirCentres) {
  const double way = 0.04;
  expectSecondOrder(errorsAt(way, 0), errorsAt(way / 2, 0));
  expectSecondOrder(errorsAt(way, way / 4), errorsAt(way / 2, way / 8));
  const Errors errors = errorsAt(way, way / 4);
  EXPECT_LT(errors.place, way * way);
  EXPECT_LT(errors.normal, way * way);
  EXPECT_LT(errors.depth, way * way);
}

TEST_F(TwoBalls, StayAsTheyAreWhereTheyDoNotMove) {
  const Errors none = errorsAt(0, 0.01);
  EXPECT_LT(none.place, 1e-6);
  EXPECT_LT(none.depth, 1e-6);
}

TEST_F(TwoBalls, TurnTogetherWithTheWorld) {
  constexpr double kDepth = 0.01;
  // As one rigid body: the contact turns along, and is as deep.
  const btVector3 up(0, 0, 1);
  const Placed then{at({0, 0, 0}), at(up * btScalar(kA + kB - kDepth))};
  const btTransform motion(btQuaternion(btVector3(1, 1, 0).normalized(), btScalar(0.7)), btVector3(4, 5, 6));
  const Placed now{motion * then.a, motion * then.b};
  const ContactPoint point = contactOf(up * btScalar(kA - kDepth), up, kDepth, 1 / kA, 1 / kB);
  const ContactPoint found = carried(*shape_, {point}, then, now)[0];
  EXPECT_NEAR(found.normal.distance(motion.getBasis() * up), 0, 1e-5);
  EXPECT_NEAR(found.on_b.distance(motion.getBasis() * point.on_b), 0, 1e-5);
  EXPECT_NEAR(found.depth, kDepth, 1e-5);
}

TEST_F(TwoBalls, AreAsDeepAsBeforeWhereOneSlidesAroundTheOther) {
  // B's middle goes on the circle around A's, and neither turns.
  constexpr double kDepth = 0.01;
  const btVector3 up(0, 0, 1);
  const double apart = kA + kB - kDepth;
  const auto depthAt = [&](double angle) {
    const Placed then{at({0, 0, 0}), at(up * btScalar(apart))};
    const Placed now{at({0, 0, 0}),
                     at({btScalar(apart * std::sin(angle)), 0, btScalar(apart * std::cos(angle))})};
    return double(
        carried(*shape_, {contactOf(up * btScalar(kA - kDepth), up, kDepth, 1 / kA, 1 / kB)}, then, now)[0]
            .depth);
  };
  EXPECT_NEAR(depthAt(0.1), kDepth, 1e-4);  // of fourth order
  EXPECT_NEAR(depthAt(0.05), kDepth, 1e-5);
}

/// Two rings, each through the other, that touch where their tubes cross. Their surfaces are saddles there.
class LinkedRings : public testing::Test {
 protected:
  static constexpr double kRing = 1, kTube = 0.25;

  struct Circle {
    explicit Circle(const btTransform& frame) : frame(frame) {}
    btVector3 at(double t) const { return frame * (across(t) * btScalar(kRing)); }
    btVector3 speed(double t) const { return frame.getBasis() * across(t + M_PI / 2) * btScalar(kRing); }
    btVector3 bend(double t) const { return frame.getBasis() * across(t) * btScalar(-kRing); }
    static btVector3 across(double t) { return {btScalar(std::cos(t)), btScalar(std::sin(t)), 0}; }
    btTransform frame;
  };
  /// Newton's method to where the middles of the tubes are nearest, from s on A and t on B.
  static ContactPoint exact(const Placed& placed, double s, double t) {
    const Circle a(placed.a), b(placed.b);
    for (int i = 0; i < 20; ++i) {
      const btVector3 p = b.at(t) - a.at(s), u = a.speed(s), v = b.speed(t);
      const double slope_s = double(-p.dot(u)), slope_t = double(p.dot(v));
      const double ss = double(u.dot(u) - p.dot(a.bend(s))), tt = double(v.dot(v) + p.dot(b.bend(t)));
      const double st = double(-u.dot(v)), det = ss * tt - st * st;
      s -= (tt * slope_s - st * slope_t) / det;
      t -= (ss * slope_t - st * slope_s) / det;
    }
    const btVector3 apart = b.at(t) - a.at(s), normal = apart.normalized();
    return contactOf(b.at(t) - normal * btScalar(kTube) - placed.a.getOrigin(), normal,
                     2 * kTube - double(apart.length()), Bend(), Bend());
  }

  /// B slides and turns, in proportion to `way` [m].
  Errors errorsAt(double way, double depth) const {
    // A stands in the plane of x and z, its lowest place at (0, 0, -1); B hangs above it, across.
    const btTransform a(btQuaternion(btVector3(1, 0, 0), btScalar(M_PI / 2)), btVector3(3, 2, 1));
    const btTransform b(btQuaternion(btVector3(0, 1, 0), btScalar(M_PI / 2)),
                        a.getOrigin() + btVector3(0, 0, btScalar(-2 * kRing + 2 * kTube - depth)));
    const Placed then{a, b};
    const btTransform motion(btQuaternion(btVector3(2, 1, -1).normalized(), btScalar(0.7 * way)),
                             btVector3(btScalar(way), btScalar(-0.5 * way), btScalar(0.1 * way)));
    const Placed now{a * btTransform(btQuaternion(btVector3(0, 1, 2).normalized(), btScalar(-way))),
                     b * motion};
    const double s = -M_PI / 2, t = M_PI;
    ContactPoint point = exact(then, s, t);
    EXPECT_NEAR(point.depth, depth, 1e-6);
    EXPECT_NEAR(point.normal.z(), 1, 1e-6);
    const double inner = -1 / (kRing - kTube);
    point.bend_a = bendOf(point.normal, btVector3(1, 0, 0), inner, 1 / kTube);
    point.bend_b = bendOf(point.normal, btVector3(0, 1, 0), inner, 1 / kTube);
    const ContactPoint expected = exact(now, s, t);
    return errorsOf(carried(*shape_, {point}, then, now)[0], expected.on_b, expected.normal,
                    double(expected.depth));
  }

  std::shared_ptr<PackingShape> shape_ = makeShape(singleBall(1));
};

TEST_F(LinkedRings, TouchWhereTheirTubesCross) {
  for (const double depth : {0.0, 0.01, -0.01}) {
    SCOPED_TRACE(depth);
    const double way = 0.02;
    expectSecondOrder(errorsAt(way, depth), errorsAt(way / 2, depth));
    const Errors errors = errorsAt(way, depth);
    EXPECT_LT(errors.place, 10 * way * way);
    EXPECT_LT(errors.normal, 10 * way * way);
    EXPECT_LT(errors.depth, way * way / 10);
  }
}

class OnAPlane : public testing::Test {
 protected:
  static constexpr double kRadius = 0.4, kDepth = 0.002;
  const btVector3 down{0, 0, -1};
  const btVector3 below{0, 0, btScalar(-(kRadius - kDepth))};

  /// Of a rolling body, in closed form: the parabola differs from the circle in the fourth order.
  static double depthErrorAt(double angle) {
    const double drop = 1 - std::cos(angle);
    return kRadius * drop * drop / 2;
  }
  Placed rolledBy(double angle, double slip = 0) const {
    return {at({btScalar(kRadius * angle + slip), 0, btScalar(kRadius - kDepth)},
               btQuaternion(btVector3(0, 1, 0), btScalar(angle))),
            at({0, 0, 0})};
  }
};

TEST_F(OnAPlane, ARollingBallKeepsItsContactBelowIt) {
  const auto ball = makeShape(singleBall(kRadius));
  const ContactPoint point = contactOf(below, down, kDepth, 1 / kRadius, 0);
  const auto errorsAt = [&](double angle, double slip) {
    return errorsOf(carried(*ball, {point}, rolledBy(0), rolledBy(angle, slip))[0], below, down, kDepth);
  };
  expectSecondOrder(errorsAt(0.2, 0), errorsAt(0.1, 0));
  expectSecondOrder(errorsAt(0.2, 0.04), errorsAt(0.1, 0.02));
  EXPECT_NEAR(errorsAt(0.2, 0).depth, depthErrorAt(0.2), 1e-6);
  EXPECT_LT(errorsAt(0.2, 0).place, 0.01);
  EXPECT_LT(errorsAt(0.2, 0).normal, 1e-6);  // the plane's
}

TEST_F(OnAPlane, ARollingCylinderKeepsItsLineBelowIt) {
  // Its axis is y. Two points bear it; their curvature is that across the line.
  const auto body = makeShape(latticeBox({0.5, 1, 0.5}, 2));
  std::vector<ContactPoint> points;
  for (const double y : {-0.5, 0.5})
    points.push_back(contactOf(below + btVector3(0, btScalar(y), 0), down, kDepth,
                               bendOf(down, btVector3(0, 1, 0), 0, 1 / kRadius), Bend()));
  const auto worst = [&](double angle) {
    const std::vector<ContactPoint> found = carried(*body, points, rolledBy(0), rolledBy(angle));
    Errors errors{0, 0, 0};
    for (std::size_t i = 0; i < 2; ++i) {
      const Errors e = errorsOf(found[i], points[i].on_b, down, kDepth);
      errors = {std::max(errors.place, e.place), std::max(errors.normal, e.normal),
                std::max(errors.depth, e.depth)};
    }
    return errors;
  };
  expectSecondOrder(worst(0.2), worst(0.1));
  EXPECT_NEAR(worst(0.2).depth, depthErrorAt(0.2), 1e-6);
  EXPECT_LT(worst(0.2).place, 0.01);
}

// Not those that its normal would have: a crest is where the bend was told beside it, and at 45 degrees these
// change from one normal to the next.
TEST_F(OnAPlane, APointIsCarriedInAxesOfItsOwn) {
  const auto body = makeShape(latticeBox({0.5, 1, 0.5}, 2));
  for (const double turned : {0.0, 0.5, 1.0, M_PI / 2}) {
    const btVector3 x{btScalar(std::cos(turned)), btScalar(std::sin(turned)), 0}, y = down.cross(x);
    const btVector3 bent(1, 0, 0);  // a cylinder about y
    const btScalar to_x = bent.dot(x), to_y = bent.dot(y), bend = 1 / btScalar(kRadius);
    ContactPoint point = contactOf(below, down, kDepth, Bend{}, Bend{});
    point.bend_a = {bend * to_x * to_x, bend * to_x * to_y, bend * to_y * to_y};
    point.bend_x = x;
    const ContactPoint found = carried(*body, {point}, rolledBy(0), rolledBy(0.2))[0];
    const Errors errors = errorsOf(found, below, down, kDepth);
    EXPECT_NEAR(errors.depth, depthErrorAt(0.2), 1e-6) << turned;
    EXPECT_LT(errors.place, 0.01) << turned;
  }
}

TEST_F(OnAPlane, ACornerIsAsDeepAsItsPlace) {
  // A cube tilts and slides: its corner goes along, and the plane's normal stays. That is exact.
  const auto cube = makeShape(latticeBox({1, 1, 1}, 2));
  const btVector3 corner(btScalar(0.5), btScalar(-0.5), btScalar(-0.5));
  ContactPoint point = contactOf(corner + btVector3(0, 0, btScalar(kDepth)), down, kDepth, 0, 0);
  point.turn_a = 0;
  const Placed then{at({0, 0, btScalar(0.5 - kDepth)}), at({0, 0, 0})};
  const btQuaternion tilt(btVector3(1, 2, 0).normalized(), btScalar(0.1));
  const Placed now{at({btScalar(0.2), 0, btScalar(0.52)}, tilt), at({0, 0, 0})};
  const ContactPoint found = carried(*cube, {point}, then, now)[0];
  const double height = 0.52 + double((btMatrix3x3(tilt) * corner).z());
  EXPECT_NEAR(found.depth, -height, 1e-6);
  EXPECT_NEAR(found.normal.distance(down), 0, 1e-6);
  EXPECT_NEAR(found.on_b.z(), -0.52, 1e-6);
}

TEST_F(OnAPlane, AFaceTakesItsNormalAlong) {
  const auto cube = makeShape(latticeBox({1, 1, 1}, 2));
  ContactPoint point = contactOf(btVector3(0, 0, btScalar(-0.5)), down, 0, 0, 0);
  point.turn_a = 1;
  const Placed then{at({0, 0, btScalar(0.5)}), at({0, 0, 0})};
  const btQuaternion tilt(btVector3(0, 1, 0), btScalar(0.05));
  const Placed now{at({0, 0, btScalar(0.5)}, tilt), at({0, 0, 0})};
  const btVector3 turned = btMatrix3x3(tilt) * down;
  EXPECT_NEAR(carried(*cube, {point}, then, now)[0].normal.distance(turned), 0, 1e-6);
  point.turn_a = btScalar(0.5);
  const btVector3 between = (turned + down).normalized();
  EXPECT_NEAR(carried(*cube, {point}, then, now)[0].normal.distance(between), 0, 1e-6);
}

TEST_F(OnAPlane, SamplesTurnWithThePacking) {
  ContactTransport transport;
  transport.samples.patches.push_back({down, 1, 1, 0});
  const Placed then{at({0, 0, 0}), at({0, 0, 0})};
  transport.noteDepths(then, 1);
  const btQuaternion turn(btVector3(1, 0, 0), SIMD_HALF_PI);
  transport.turnTo({at({0, 0, 0}, turn), at({0, 0, 0})});
  EXPECT_NEAR(transport.samples.patches[0].normal.distance(btMatrix3x3(turn) * down), 0, 1e-6);
}

}  // namespace
}  // namespace innersphere::test
