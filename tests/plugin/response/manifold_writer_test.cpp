// Which points of a patch a solver is told of.
#include "response/manifold_writer.hpp"

#include <gtest/gtest.h>

#include <btBulletDynamicsCommon.h>

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

namespace innersphere::test {
namespace {

constexpr btScalar kCurvature = 10, kToTop = btScalar(0.01);  // [1/m], [m]
constexpr btScalar kTimeStep = btScalar(1e-3);

/// A point of a ball over a plane.
ContactPoint pointAt(btScalar x, btScalar depth, btScalar y = 0) {
  ContactPoint point;
  point.on_b = btVector3(x, y, 0);
  point.normal = btVector3(0, 0, -1);
  point.depth = depth;
  point.bend_a = Bend::round(kCurvature);
  return point;
}

/// Writes one patch of points between bodies that lie at the origin. `see` gets the manifold.
template <class See>
void write(std::initializer_list<ContactPoint> points, const PairMotion& motion, const SolverSettings& solver,
           const See& see) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btSphereShape ball(1);
  btCollisionObject a, b;
  a.setCollisionShape(&ball);
  b.setCollisionShape(&ball);
  ContactPatch patch;
  patch.normal = points.begin()->normal;
  patch.area = 1;
  for (const ContactPoint& point : points) patch.points[patch.count++] = point;
  const btCollisionObjectWrapper wrapper_a(nullptr, &ball, &a, a.getWorldTransform(), -1, -1);
  const btCollisionObjectWrapper wrapper_b(nullptr, &ball, &b, b.getWorldTransform(), -1, -1);
  btManifoldResult result(&wrapper_a, &wrapper_b);
  ManifoldWriter writer(&dispatcher);
  writer.write(a, b, {a.getWorldTransform(), b.getWorldTransform()}, motion, btVector3(0, 0, 0), {patch},
               ContactLaw({}, 1, kTimeStep, 1, solver), btScalar(0.05), &result);
  btManifoldArray manifolds;
  writer.append(manifolds);
  ASSERT_EQ(manifolds.size(), 1);
  see(*manifolds[0]);
}

/// Returns the number of points that a SubstepSolver is told of.
int pointsWritten(std::initializer_list<ContactPoint> points) {
  SolverSettings solver;
  solver.substeps = true;
  int count = -1;
  write(points, {}, solver, [&](const btPersistentManifold& manifold) { count = manifold.getNumContacts(); });
  return count;
}

TEST(ManifoldWriter, LeavesASlopeToTheTopOfItsOwnHillAlone) {
  const btScalar below = kCurvature * kToTop * kToTop / 2;
  ContactPoint slope = pointAt(0, btScalar(-0.002) - below);
  slope.to_top = btVector3(kToTop, 0, 0);
  slope.below_top = below;
  const ContactPoint top = pointAt(kToTop, btScalar(-0.002));
  const ContactPoint elsewhere = pointAt(btScalar(0.2), 0);
  EXPECT_EQ(pointsWritten({top, slope}), 1);
  EXPECT_EQ(pointsWritten({elsewhere, slope}), 2);  // of another hill, which may never come down here
  EXPECT_EQ(pointsWritten({elsewhere, top, slope}), 2);
  EXPECT_EQ(pointsWritten({pointAt(kToTop, 0, btScalar(0.3)), slope}), 2);
  // A ridge, and what is one but for rounding.
  for (const btScalar along : {btScalar(0), kCurvature * SIMD_EPSILON}) {
    slope.bend_a.yy = along;
    EXPECT_EQ(pointsWritten({pointAt(kToTop, 0, btScalar(0.3)), slope}), 1);
  }
}

using Vector = Eigen::Vector3d;

struct Moves {
  Vector origin, linear, spin;
  BodyVelocity velocity() const {
    BodyVelocity velocity;
    velocity.linear = toBullet(linear);
    velocity.spin = toBullet(spin);
    return velocity;
  }
  static btVector3 toBullet(const Vector& v) {
    return btVector3(btScalar(v.x()), btScalar(v.y()), btScalar(v.z()));
  }
  /// Where a point of the body is after some time.
  Vector after(double time, const Vector& point) const {
    const Eigen::AngleAxisd turn(spin.norm() * time, spin.norm() > 0 ? spin.normalized() : Vector::UnitX());
    return origin + linear * time + turn * (point - origin);
  }
  Vector velocityAt(const Vector& point) const { return linear + spin.cross(point - origin); }
};

/// A ball of 0.1 m over the ground of a hollow of a radius [m].
class Hollows : public testing::TestWithParam<double> {
 protected:
  static constexpr double kGap = 2e-4, kBall = 0.1, kTurn = 6e-3;  // [m], [m], the largest angle [rad]

  /// Returns by how much their gap will be less than the plane between them says [m]: their centres move with
  /// the bodies, on circles.
  double nearer(const Moves& ball, const Moves& hollow) const {
    const Vector ball_centre(0, 0, kBall + kGap), hollow_centre(0, 0, GetParam());
    const double dt = double(kTimeStep);
    const double gap =
        GetParam() - kBall - (ball.after(dt, ball_centre) - hollow.after(dt, hollow_centre)).norm();
    const double approach = (hollow.velocityAt(Vector::Zero()) - ball.velocityAt(Vector::Zero())).z();
    return kGap - approach * dt - gap;
  }

  /// Returns by how much less than that the gap is that a solver is told.
  double told(const Moves& ball, const Moves& hollow, bool ball_is_a) const {
    ContactPoint point;
    point.normal = btVector3(0, 0, ball_is_a ? btScalar(-1) : btScalar(1));
    point.depth = btScalar(-kGap);
    const Bend round = Bend::round(btScalar(1 / kBall)), inside = Bend::round(btScalar(-1 / GetParam()));
    point.bend_a = ball_is_a ? round : inside;
    point.bend_b = ball_is_a ? inside : round;
    const Moves &a = ball_is_a ? ball : hollow, &b = ball_is_a ? hollow : ball;
    const PairMotion motion(Moves::toBullet(a.origin), a.velocity(), Moves::toBullet(b.origin), b.velocity());
    double gap = -1;
    write({point}, motion, SolverSettings(), [&](const btPersistentManifold& manifold) {
      gap = double(manifold.getContactPoint(0).getDistance());
    });
    return kGap - gap;
  }
};

// Each is of the order of an angle squared, and known but for that of its cube. Curvatures are those of
// surfaces that touch.
TEST_P(Hollows, BendAndTurnAsTheirCentresGo) {
  const Vector at_centre(0, 0, kBall), aside(0.2, -0.1, -0.3), none(0, 0, 0);
  const Moves still{none, none, none}, slides{at_centre, {0.3, 0.2, 0.01}, none},
      rolls{at_centre, {0.3, 0.2, 0}, {-2, 3, 0}}, tilts{aside, none, {5, -2, 1}},
      both{aside, {-0.1, 0.2, 0.02}, {-3, 4, 2}};
  const std::pair<Moves, Moves> cases[] = {{slides, still}, {rolls, still}, {still, tilts},
                                           {slides, tilts}, {rolls, both},  {tilts, both}};
  for (const auto& [ball, hollow] : cases) {
    const double expected = nearer(ball, hollow);
    SCOPED_TRACE(testing::Message() << "spins " << ball.spin.transpose() << "; " << hollow.spin.transpose());
    for (const bool ball_is_a : {true, false})
      EXPECT_NEAR(told(ball, hollow, ball_is_a), expected, 0.1 * std::abs(expected) + kGap * kTurn * kTurn);
  }
}

INSTANTIATE_TEST_SUITE_P(Radii, Hollows, testing::Values(0.2, 0.5, 20.0, 1e4));

}  // namespace
}  // namespace innersphere::test
