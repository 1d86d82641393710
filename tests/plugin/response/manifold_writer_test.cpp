// Which points of a patch a solver is told of.
#include "response/manifold_writer.hpp"

#include <gtest/gtest.h>

#include <btBulletDynamicsCommon.h>

namespace innersphere::test {
namespace {

constexpr btScalar kCurvature = 10, kToTop = btScalar(0.01);  // [1/m], [m]

/// A point of a ball over a plane.
ContactPoint pointAt(btScalar x, btScalar depth, btScalar y = 0) {
  ContactPoint point;
  point.on_b = btVector3(x, y, 0);
  point.normal = btVector3(0, 0, -1);
  point.depth = depth;
  point.bend_a = Bend::round(kCurvature);
  return point;
}

/// Returns the number of points that a SubstepSolver is told of.
int pointsWritten(std::initializer_list<ContactPoint> points) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btSphereShape ball(1);
  btCollisionObject a, b;
  a.setCollisionShape(&ball);
  b.setCollisionShape(&ball);
  ContactPatch patch;
  patch.normal = btVector3(0, 0, -1);
  patch.area = 1;
  for (const ContactPoint& point : points) patch.points[patch.count++] = point;
  const btCollisionObjectWrapper wrapper_a(nullptr, &ball, &a, a.getWorldTransform(), -1, -1);
  const btCollisionObjectWrapper wrapper_b(nullptr, &ball, &b, b.getWorldTransform(), -1, -1);
  btManifoldResult result(&wrapper_a, &wrapper_b);
  SolverSettings solver;
  solver.substeps = true;
  ManifoldWriter writer(&dispatcher);
  writer.write(a, b, {a.getWorldTransform(), b.getWorldTransform()}, {}, btVector3(0, 0, 0), {patch},
               ContactLaw({}, 1, btScalar(1) / 60, 1, solver), btScalar(0.05), &result);
  btManifoldArray manifolds;
  writer.append(manifolds);
  return manifolds.size() == 1 ? manifolds[0]->getNumContacts() : -1;
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

}  // namespace
}  // namespace innersphere::test
