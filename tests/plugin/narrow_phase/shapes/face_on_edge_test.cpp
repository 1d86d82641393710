// A face of a packing that lies on an edge: the edge bears it along the normal of the face.
#include "narrow_phase/shapes/face_on_edge.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test_packings.hpp"

namespace innersphere::test {
namespace {

constexpr double kRounding = 2e-5;

/// A cube of 1 m, its lower face at z = 0, and an edge along y below one of its spheres.
class FaceOnEdge : public testing::Test {
 protected:
  static constexpr double kBelow =
      0.005;  ///< of the edge under the face [m], less than a tenth of the sphere

  FaceOnEdge()
      : body_(*cube(), btTransform(btQuaternion::getIdentity(), btVector3(3, 4, btScalar(0.5))),
              Estimator::raw, btScalar(0.2)) {}
  static std::shared_ptr<PackingShape> cube() {
    static const std::shared_ptr<PackingShape> shape = [] {
      auto made = makeShape(latticeBox({1, 1, 1}, 4));
      made->setMargin(0);
      return made;
    }();
    return shape;
  }
  /// Sphere 0 is at (-0.375, -0.375, -0.375) from the middle; the edge lies `aside` from there.
  NearSphere seenFrom(double aside) const {
    NearSphere near;
    near.sphere = 0;
    const btVector3 to_edge(btScalar(aside), 0, btScalar(-0.125 - kBelow));
    near.distance = to_edge.length();
    near.normal = -to_edge / near.distance;
    return near;
  }
  PlacedPacking body_;
};

TEST_F(FaceOnEdge, IsTheFaceOverTheNearestPoint) {
  FaceOver face;
  ASSERT_TRUE(faceOver(body_, seenFrom(0.1), face));
  EXPECT_NEAR(face.normal.distance(btVector3(0, 0, -1)), 0, kRounding);
  EXPECT_EQ(face.curvature, 0);
  // Far beside the cube there is none.
  EXPECT_FALSE(faceOver(body_, seenFrom(-0.6), face));
}

// As the leading edge of a box that slides from one tile to the next.
TEST_F(FaceOnEdge, IsTheFaceThatTheEdgeIsInByLess) {
  const btVector3 edge(btScalar(-0.499), btScalar(-0.375), btScalar(-0.49999));
  for (std::uint32_t i = 0; i < body_.count(); ++i) {
    NearSphere near;
    near.sphere = i;
    near.normal = body_.centreOf(i) - edge;
    near.distance = near.normal.length();
    if (near.distance > 0.5 || body_.isFeeler(i)) continue;
    near.normal /= near.distance;
    FaceOver face;
    ASSERT_TRUE(faceOver(body_, near, face));
    EXPECT_NEAR(face.normal.distance(btVector3(0, 0, -1)), 0, kRounding) << body_.centreOf(i).z();
  }
}

TEST_F(FaceOnEdge, BearsAlongItsNormal) {
  for (const double aside : {-0.05, 0.05, 0.1}) {
    NearSphere near = seenFrom(aside);
    layFaceOn(body_, 0, near, [](const btVector3&, const btVector3&, btScalar) { return true; });
    EXPECT_NEAR(near.normal.distance(btVector3(0, 0, 1)), 0, kRounding);
    EXPECT_NEAR(near.distance, 0.125 + kBelow, kRounding);
    EXPECT_NEAR(near.aside.distance(btVector3(btScalar(aside), 0, 0)), 0, kRounding);
    EXPECT_TRUE(near.isOnEdge());
  }
}

TEST_F(FaceOnEdge, OfABallIsNotLaidOnIt) {
  const std::shared_ptr<PackingShape> ball = makeShape(singleBall(0.5));
  const PlacedPacking body(*ball, btTransform::getIdentity(), Estimator::raw, btScalar(0.2));
  NearSphere seen;
  seen.normal = btVector3(btScalar(0.6), 0, btScalar(0.8));
  seen.distance = btScalar(0.49);
  FaceOver face;
  ASSERT_TRUE(faceOver(body, seen, face));
  EXPECT_NEAR(face.curvature, 2, 0.01);
  NearSphere near = seen;
  layFaceOn(body, 50, near, [](const btVector3&, const btVector3&, btScalar) { return true; });
  EXPECT_EQ(near.normal, seen.normal);
  EXPECT_EQ(near.curvature, 50);
  layFaceOn(body, BT_LARGE_FLOAT, near, [](const btVector3&, const btVector3&, btScalar) { return true; });
  EXPECT_NEAR(near.curvature, 1e3 / body.searchRadius(0), 1) << "no sharper than what counts";
}

TEST_F(FaceOnEdge, DoesNotLieOnAnEdgeThatIsNotOutermost) {
  NearSphere near = seenFrom(0.1);
  const NearSphere before = near;
  btVector3 asked_at(0, 0, 0), asked_along(0, 0, 0);
  layFaceOn(body_, 0, near, [&](const btVector3& place, const btVector3& direction, btScalar) {
    asked_at = place;
    asked_along = direction;
    return false;
  });
  EXPECT_EQ(near.distance, before.distance);
  EXPECT_FALSE(near.isOnEdge());
  // It was asked at the edge, towards the cube.
  EXPECT_NEAR(asked_at.distance(btVector3(btScalar(-0.275), btScalar(-0.375), btScalar(-0.5 - kBelow))), 0,
              kRounding);
  EXPECT_NEAR(asked_along.distance(btVector3(0, 0, 1)), 0, kRounding);
}

}  // namespace
}  // namespace innersphere::test
