// The way out of bodies that are deep in each other, against what their shapes say.
#include "narrow_phase/way_out.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "test_packings.hpp"

namespace innersphere::test {
namespace {

constexpr double kRounding = 1e-4;  // [m]

class Numbers final : public ContactSpheres {
 public:
  std::uint64_t id(std::size_t index) const override { return index; }
  Protrusion protrusion(std::size_t, const btVector3&) const override { return {true, 0}; }
};

std::shared_ptr<PackingShape> cubeOf(double side) {
  auto shape = makeShape(latticeBox({side, side, side}, 4));
  shape->setMargin(0);
  return shape;
}

/// Spheres of A as contacts, without a direction: all of them are inside B.
std::vector<SphereContact> contactsOf(const PlacedPacking& a) {
  std::vector<SphereContact> contacts;
  for (std::size_t i = 0; i < a.count(); ++i) {
    SphereContact contact{};
    contact.sphere = static_cast<decltype(contact.sphere)>(i);
    contact.centroid = toFloats(a.centreOf(i));
    contact.volume = static_cast<float>(4.0 / 3.0 * M_PI * std::pow(double(a.ownRadius(i)), 3));
    contacts.push_back(contact);
  }
  return contacts;
}

struct Case {
  const char* name;
  double side_a, side_b;
  btVector3 place;      ///< of A, B is at the origin
  double length;        ///< of the way
  btVector3 direction;  ///< from A to B; 0 if several are as short
};

class WayOutOf : public testing::TestWithParam<Case> {};

TEST_P(WayOutOf, CubesIsTheShortest) {
  const Case& c = GetParam();
  const auto a = cubeOf(c.side_a), b = cubeOf(c.side_b);
  btTransform at_a = btTransform::getIdentity();
  at_a.setOrigin(c.place);
  const PlacedPacking placed_a(*a, at_a, Estimator::raw, 0),
      placed_b(*b, btTransform::getIdentity(), Estimator::raw, 0);
  std::vector<WeightedPoint> found;
  const std::vector<SphereContact> contacts = contactsOf(placed_a);
  findWayOut({placed_a, placed_b, contacts, Numbers()}, {}, btVector3(0, 0, 0), found);
  ASSERT_FALSE(found.empty());
  double area = 0;
  for (const WeightedPoint& p : found) {
    EXPECT_NEAR(p.point.depth, c.length, kRounding);
    area += p.area;
    if (!c.direction.isZero()) EXPECT_NEAR(p.point.normal.distance(c.direction), 0, kRounding);
    // It is where the way enters B: on a face of B.
    EXPECT_NEAR((p.point.on_b + c.place).absolute()[(p.point.normal.absolute()).maxAxis()], c.side_b / 2,
                kRounding);
  }
  EXPECT_GT(area, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Of, WayOutOf,
    testing::Values(Case{"same_place", 1, 1, {0, 0, 0}, 1, {0, 0, 0}},
                    Case{"beside", 1, 1, {btScalar(0.1), 0, 0}, 0.9, {-1, 0, 0}},
                    Case{"small_in_large", btScalar(0.2), 2, {0, btScalar(0.3), 0}, 0.8, {0, -1, 0}}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace innersphere::test
