// How far contacts are looked for, and on what they are found.
#include "narrow_phase/contact_settings.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include <btBulletCollisionCommon.h>

#include "narrow_phase/contact_transport.hpp"
#include "test_packings.hpp"

namespace innersphere::test {
namespace {

/// Eight spheres in a cube of 1 m end this far from its corners.
const double kInset = 0.25 * (std::sqrt(3.0) - 1);

std::shared_ptr<PackingShape> cube(double scale = 1) {
  auto shape = makeShape(latticeBox({1, 1, 1}, 2));
  shape->setLocalScaling(btVector3(btScalar(scale), btScalar(scale), btScalar(scale)));
  return shape;
}

TEST(ContactSettings, AreOfTheSmallerThreshold) {
  const auto large = cube(2), small = cube(0.1);
  const double of_small = small->getContactBreakingThreshold(gContactBreakingThreshold);
  ASSERT_LT(of_small, large->getContactBreakingThreshold(gContactBreakingThreshold));
  EXPECT_NEAR(ContactSettings({}, *large, *small, 0).spacing, of_small, 1e-9);
  EXPECT_NEAR(ContactSettings({}, *small, *large, 0).spacing, of_small, 1e-9);
}

TEST(ContactSettings, LookFurtherThanIsNeeded) {
  const auto shape = cube();
  const btSphereShape ball(1);
  const double spacing = ContactSettings({}, *shape, ball, 0).spacing;
  // At least from where Bullet drops contacts.
  EXPECT_NEAR(ContactSettings({}, *shape, ball, 0).separation, spacing, 1e-9);
  EXPECT_NEAR(ContactSettings({}, *shape, ball, 1).separation, 1 + kSearchAgain * spacing, 1e-6);
}

TEST(ContactSettings, AddTheInsetsOfBothPackings) {
  const auto a = cube(2), b = cube(3);
  const ContactSettings settings({}, *a, *b, btScalar(0.5));
  EXPECT_TRUE(settings.on_surfaces);
  EXPECT_NEAR(settings.search_margin_a, settings.separation + 2 * kInset, 1e-5);
  EXPECT_NEAR(settings.search_margin_b, 3 * kInset, 1e-5);
  EXPECT_NEAR(settings.search_margin(), settings.separation + 5 * kInset, 2e-5);
  EXPECT_EQ(settings.prefix_b->count, 8u);
  const btSphereShape ball(1);
  const ContactSettings with_ball({}, *a, ball, btScalar(0.5));
  EXPECT_EQ(with_ball.search_margin_b, 0);
  EXPECT_EQ(with_ball.prefix_b, nullptr);
}

TEST(ContactSettings, AreOfVolumesWhereSomethingAsksForThem) {
  const auto solid = cube();
  const auto imported = makeShape(withoutSurface(latticeBox({1, 1, 1}, 2)));
  ContactOptions stiff, penalty;
  stiff.stiffness = 1e6;
  penalty.response = Response::penalty;
  EXPECT_TRUE(ContactSettings({}, *solid, *solid, 0).on_surfaces);
  EXPECT_FALSE(ContactSettings(stiff, *solid, *solid, 0).on_surfaces);
  EXPECT_FALSE(ContactSettings(penalty, *solid, *solid, 0).on_surfaces);
  EXPECT_FALSE(ContactSettings({}, *solid, *imported, 0).on_surfaces);
  EXPECT_FALSE(ContactSettings({}, *imported, *solid, 0).on_surfaces);
  const ContactSettings volumes(stiff, *solid, *solid, 0);
  EXPECT_EQ(volumes.search_margin(), 0);
  EXPECT_EQ(volumes.estimator, stiff.estimator);
  EXPECT_EQ(ContactSettings({}, *solid, *solid, 0).estimator, Estimator::raw);
}

}  // namespace
}  // namespace innersphere::test
