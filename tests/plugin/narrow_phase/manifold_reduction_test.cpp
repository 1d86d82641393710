// Which points bear a contact, where that can be said by hand.
#include "narrow_phase/manifold_reduction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace innersphere::test {
namespace {

using Kind = WeightedPoint::Kind;
constexpr double kSpacing = 0.01;
const btVector3 kUp(0, 0, 1);

btVector3 leaning(double degrees, double around = 0) {
  const double angle = degrees * M_PI / 180, turn = around * M_PI / 180;
  return btVector3(btScalar(std::sin(angle) * std::cos(turn)), btScalar(std::sin(angle) * std::sin(turn)),
                   btScalar(std::cos(angle)));
}

WeightedPoint pointAt(double x, double y, double depth, std::uint64_t id, const btVector3& normal = kUp,
                      Kind kind = Kind::faces) {
  WeightedPoint p{};
  p.point.on_b.setValue(btScalar(x), btScalar(y), 0);
  p.point.normal = normal;
  p.point.depth = btScalar(depth);
  p.point.id = id;
  p.kind = kind;
  p.area = btScalar(0.5);
  p.centre = p.point.on_b;
  p.radius = btScalar(0.1);
  return p;
}

std::vector<ContactPatch> reduce(std::vector<WeightedPoint> found, std::vector<std::uint64_t> old_ids = {}) {
  ReductionScratch scratch;
  std::vector<ContactPatch> patches;
  reduceToManifolds(found, old_ids, btScalar(kSpacing), {}, scratch, patches);
  return patches;
}

std::set<std::uint64_t> idsOf(const ContactPatch& patch) {
  std::set<std::uint64_t> ids;
  for (int i = 0; i < patch.count; ++i) ids.insert(patch.points[i].id);
  return ids;
}

/// A rectangle of 2 m x 1 m, its corners first, and points inside of it.
std::vector<WeightedPoint> rectangle(double depth) {
  std::vector<WeightedPoint> found{pointAt(-1, -0.5, depth, 1), pointAt(1, -0.5, depth, 2),
                                   pointAt(1, 0.5, depth, 3), pointAt(-1, 0.5, depth, 4)};
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> x(-0.7, 0.7), y(-0.35, 0.35);
  for (std::uint64_t i = 0; i < 30; ++i) found.push_back(pointAt(x(rng), y(rng), depth, 100 + i));
  return found;
}

TEST(ReduceToManifolds, KeepsTheCornersOfAFace) {
  const std::vector<WeightedPoint> found = rectangle(0.001);
  const std::vector<ContactPatch> patches = reduce(found);
  ASSERT_EQ(patches.size(), 1u);
  EXPECT_EQ(idsOf(patches[0]), (std::set<std::uint64_t>{1, 2, 3, 4}));
  EXPECT_NEAR(patches[0].area, 0.5 * double(found.size()), 1e-4);
  EXPECT_NEAR(patches[0].normal.distance(kUp), 0, 1e-6);
  double x = 0;
  for (const WeightedPoint& p : found) x += p.point.on_b.x() / double(found.size());
  EXPECT_NEAR(patches[0].centre.x(), x, 1e-5);
}

TEST(ReduceToManifolds, KeepsTheDeepestPoint) {
  std::vector<WeightedPoint> found = rectangle(0.001);
  found[20].point.depth = btScalar(0.0012);
  const std::vector<ContactPatch> patches = reduce(found);
  ASSERT_EQ(patches[0].count, kPatchPoints);
  EXPECT_EQ(patches[0].points[0].id, found[20].point.id);
}

TEST(ReduceToManifolds, KeepsNoPointThatIsFarFromTouching) {
  // The corners hang 5 mm over the ground, half of the spacing.
  std::vector<WeightedPoint> found = rectangle(0.001);
  for (std::size_t i = 0; i < 4; ++i) found[i].point.depth = btScalar(-0.005);
  const std::set<std::uint64_t> ids = idsOf(reduce(found)[0]);
  for (const std::uint64_t corner : {1u, 2u, 3u, 4u}) EXPECT_EQ(ids.count(corner), 0u);
}

TEST(ReduceToManifolds, MakesOnePointOfThoseThatAreClose) {
  std::vector<WeightedPoint> found;
  for (std::uint64_t i = 0; i < 10; ++i) found.push_back(pointAt(0.0009 * double(i), 0, 0.001, i));
  EXPECT_EQ(reduce(found)[0].count, 1);
  found.push_back(pointAt(0.03, 0, 0.001, 77));
  EXPECT_EQ(reduce(found)[0].count, 2);
}

TEST(ReduceToManifolds, GroupsByNormals) {
  std::vector<WeightedPoint> found{pointAt(0, 0, 0.003, 1), pointAt(1, 0, 0.002, 2, leaning(10)),
                                   pointAt(0, 1, 0.001, 3, leaning(20))};
  const std::vector<ContactPatch> patches = reduce(found);
  ASSERT_EQ(patches.size(), 2u);
  EXPECT_EQ(idsOf(patches[0]), (std::set<std::uint64_t>{1, 2}));
  EXPECT_EQ(idsOf(patches[1]), (std::set<std::uint64_t>{3}));
}

TEST(ReduceToManifolds, LosesNoAreaWhereManifoldsAreMerged) {
  std::vector<WeightedPoint> found;
  for (std::uint64_t i = 0; i < 24; ++i)
    found.push_back(pointAt(double(i), 0, 0.001, i, leaning(60, 15.0 * double(i))));
  for (std::uint64_t i = 0; i < 8; ++i)
    found.push_back(pointAt(double(i), 1, 0.001, 50 + i, leaning(25, 45.0 * double(i))));
  const std::vector<ContactPatch> patches = reduce(found);
  EXPECT_LE(patches.size(), 8u);
  double area = 0;
  for (const ContactPatch& patch : patches) {
    area += patch.area;
    EXPECT_GT(patch.count, 0);
    EXPECT_NEAR(patch.normal.length(), 1, 1e-5);
  }
  EXPECT_NEAR(area, 0.5 * double(found.size()), 1e-4);
}

TEST(ReduceToManifolds, PrefersPointsOfTheStepBefore) {
  // A line of three: the far ends are 1 and 1.2 from the deepest.
  const std::vector<WeightedPoint> found{pointAt(0, 0, 0.0011, 1), pointAt(-1, 0, 0.001, 2),
                                         pointAt(1.2, 0, 0.001, 3)};
  const ContactPatch fresh = reduce(found)[0], kept = reduce(found, {2})[0];
  EXPECT_EQ(fresh.points[1].id, 3u);
  EXPECT_EQ(kept.points[1].id, 2u);
  // Not where another one spans a third more.
  std::vector<WeightedPoint> wider = found;
  wider[2].point.on_b.setX(btScalar(1.4));
  EXPECT_EQ(reduce(wider, {2})[0].points[1].id, 3u);
}

TEST(ReduceToManifolds, HasTheRadiusOfAllItsArea) {
  // Two patches of radius 0.1 m, 2 m apart: root mean square of sqrt(1 + 0.01).
  std::vector<WeightedPoint> found{pointAt(-1, 0, 0.001, 1), pointAt(1, 0, 0.001, 2)};
  EXPECT_NEAR(reduce(found)[0].radius, std::sqrt(1.01), 1e-5);
}

TEST(ReduceToManifolds, OfNothingAreNone) {
  EXPECT_TRUE(reduce({}).empty());
}

std::vector<std::uint64_t> idsLeft(std::vector<WeightedPoint> found) {
  ReductionScratch scratch;
  keepLeastWaysOut(btScalar(kSpacing), scratch, found);
  std::vector<std::uint64_t> ids;
  for (const WeightedPoint& p : found) ids.push_back(p.point.id);
  return ids;
}

using Ids = std::vector<std::uint64_t>;

TEST(KeepLeastWaysOut, DropsACrossingWhereAFaceIsLessDeep) {
  EXPECT_EQ(idsLeft({pointAt(0, 0, 0.1, 1, leaning(90), Kind::crossing), pointAt(0, 0, 0.02, 2)}), Ids{2});
}

TEST(KeepLeastWaysOut, KeepsTheFaceBesideALessDeepCrossing) {
  EXPECT_EQ(idsLeft({pointAt(0, 0, 0.01, 1, leaning(90), Kind::crossing), pointAt(0, 0, 0.02, 2)}),
            (Ids{1, 2}));
}

TEST(KeepLeastWaysOut, KeepsTheLeastOfSeveralCrossings) {
  EXPECT_EQ(idsLeft({pointAt(0, 0, 0.05, 1, leaning(90), Kind::crossing),
                     pointAt(0, 0, 0.03, 2, leaning(90, 90), Kind::crossing),
                     pointAt(0, 0, 0.04, 3, leaning(30), Kind::crossing)}),
            Ids{2});
}

TEST(KeepLeastWaysOut, DropsEdgesBesideACrossing) {
  EXPECT_EQ(idsLeft({pointAt(0, 0, 0.05, 1, leaning(90), Kind::crossing),
                     pointAt(0.01, 0, 0.01, 2, kUp, Kind::edge)}),
            Ids{1});
}

TEST(KeepLeastWaysOut, LeavesWhatIsFarAway) {
  // Three depths and the spacing are 0.31 m.
  EXPECT_EQ(idsLeft({pointAt(0, 0, 0.1, 1, kUp, Kind::crossing), pointAt(1, 0, 0.02, 2, leaning(90))}),
            (Ids{1, 2}));
}

TEST(KeepLeastWaysOut, LeavesAllWhereNothingCrosses) {
  EXPECT_EQ(
      idsLeft({pointAt(0, 0, 0.1, 1, leaning(90), Kind::edge), pointAt(0, 0, 0.02, 2, kUp, Kind::corner)}),
      (Ids{1, 2}));
}

WeightedPoint endingAt(double x, double depth, std::uint64_t id, double beyond_end) {
  WeightedPoint p = pointAt(x, 0, depth, id);
  p.beyond_end = btScalar(beyond_end);
  return p;
}

std::set<std::uint64_t> idsBeforeEnds(std::vector<WeightedPoint> found) {
  dropBeyondEnds(found);
  std::set<std::uint64_t> ids;
  for (const WeightedPoint& p : found) ids.insert(p.point.id);
  return ids;
}

TEST(DropBeyondEnds, DropsAFaceBesideSomethingDeeperOnTheWay) {
  EXPECT_EQ(idsBeforeEnds({endingAt(0, 0.01, 1, 0.3), pointAt(0.29, 0, 0.011, 2)}),
            std::set<std::uint64_t>{2});
  // Either way.
  EXPECT_EQ(idsBeforeEnds({pointAt(-0.29, 0, 0.011, 2), endingAt(0, 0.01, 1, 0.3)}),
            std::set<std::uint64_t>{2});
}

TEST(DropBeyondEnds, KeepsAFaceWhereNothingDeeperIsOnTheWay) {
  const std::set<std::uint64_t> both{1, 2};
  EXPECT_EQ(idsBeforeEnds({endingAt(0, 0.01, 1, 0.3), pointAt(0.31, 0, 0.011, 2)}), both);
  EXPECT_EQ(idsBeforeEnds({endingAt(0, 0.01, 1, 0.3), pointAt(0.1, 0, 0.009, 2)}), both);
  EXPECT_EQ(idsBeforeEnds({pointAt(0, 0, 0.01, 1), pointAt(0.1, 0, 0.011, 2)}), both);
}

TEST(DropBeyondEnds, KeepsFacesThatEndBesideEachOther) {
  EXPECT_EQ(idsBeforeEnds({endingAt(0, 0.01, 1, 0.3), endingAt(0.1, 0.011, 2, 0.2)}),
            (std::set<std::uint64_t>{1, 2}));
}

/// A place of a solid that rises over a plane by the bends of its surface, `x` and `y` from the top.
WeightedPoint onHill(double x, double y, double depth, double bend_x, double bend_y, std::uint64_t id) {
  const Across axes(kUp);
  const btVector3 way(btScalar(x), btScalar(y), 0);
  const btVector3 slope(btScalar(-bend_x * x), btScalar(-bend_y * y), 0);
  const double fall = -double(slope.dot(way)) / 2;
  WeightedPoint p = pointAt(x, y, depth - fall, id, (kUp - slope / 2).normalized());
  const double xx = bend_x * double(axes.x.x() * axes.x.x()) + bend_y * double(axes.x.y() * axes.x.y());
  const double yy = bend_x * double(axes.y.x() * axes.y.x()) + bend_y * double(axes.y.y() * axes.y.y());
  const double xy = bend_x * double(axes.x.x() * axes.y.x()) + bend_y * double(axes.x.y() * axes.y.y());
  p.point.bend_a = {btScalar(xx), btScalar(xy), btScalar(yy)};
  p.bends = true;
  p.slope = slope;
  p.is_top = fall == 0;
  return p;
}

StepAhead stepOfSlowBodies() {
  StepAhead step;
  step.size = 10;
  return step;
}

std::set<std::uint64_t> idsKept(std::vector<WeightedPoint> found,
                                const StepAhead& step = stepOfSlowBodies()) {
  constexpr double kSeparation = 0.01;
  keepTops(btScalar(kSeparation), step, found);
  std::set<std::uint64_t> ids;
  for (const WeightedPoint& p : found) ids.insert(p.point.id);
  return ids;
}

TEST(Tops, BearAloneOnTheirHill) {
  // The same top twice, a hair apart, and places around it, up to 30 degrees beside.
  std::vector<WeightedPoint> found{onHill(0, 0, 0.01, 4, 2, 1), onHill(0, 0, 0.0099, 4, 2, 2)};
  found[1].point.on_b.setX(btScalar(1e-4));
  for (std::uint64_t i = 0; i < 12; ++i)
    found.push_back(onHill(0.12 * std::cos(i), 0.12 * std::sin(i), 0.01, 4, 2, 10 + i));
  EXPECT_EQ(idsKept(found), std::set<std::uint64_t>{1});
}

TEST(Tops, LeaveOtherHillsFacesAndCornersAlone) {
  WeightedPoint other = onHill(0, 0, 0.001, 4, 2, 2);
  other.point.on_b.setX(btScalar(0.3));
  WeightedPoint beside_other = onHill(0.05, 0, 0.001, 4, 2, 3);
  beside_other.point.on_b.setX(btScalar(0.35));
  other.is_top = false;  // its top is not known, so it may bear
  const WeightedPoint corner = pointAt(0.05, 0, 0.005, 4, kUp, Kind::corner);
  const std::vector<WeightedPoint> found{onHill(0, 0, 0.01, 4, 2, 1), other, beside_other, corner};
  EXPECT_EQ(idsKept(found), (std::set<std::uint64_t>{1, 2, 3, 4}));
}

TEST(Tops, OfALineLeaveItsEndsAlone) {
  // A cylinder along y on a plane: the top at its middle is as deep as its ends.
  const std::vector<WeightedPoint> found{onHill(0, 0, 0.01, 4, 0, 1), onHill(0.002, 0.5, 0.01, 4, 0, 2),
                                         onHill(0.05, 0.001, 0.01, 4, 0, 3)};
  EXPECT_EQ(idsKept(found), (std::set<std::uint64_t>{1, 2}));
}

TEST(Tops, OfALineDropItsSidesAsFarAsTheyReach) {
  // Tops at both ends; places beside it are between them, or beyond: one not by more than it is beside, and
  // one by far.
  const std::vector<WeightedPoint> found{
      onHill(0, -0.5, 0.01, 4, 0, 1), onHill(0, 0.5, 0.01, 4, 0, 2), onHill(0.05, 0.2, 0.01, 4, 0, 3),
      onHill(-0.05, -0.52, 0.01, 4, 0, 4), onHill(0.05, 0.7, 0.01, 4, 0, 5)};
  EXPECT_EQ(idsKept(found), (std::set<std::uint64_t>{1, 2, 5}));
}

TEST(Tops, OfSeveralHillsBearWithTheirSidesWhereBodiesHaveSunkIn) {
  StepAhead step;
  step.size = 2;  // the depth is 0.5 % of it
  WeightedPoint other = onHill(0, 0, 0.009, 4, 2, 3);
  other.point.on_b.setX(btScalar(0.4));
  EXPECT_EQ(idsKept({onHill(0, 0, 0.01, 4, 2, 1), onHill(0.1, 0, 0.01, 4, 2, 2), other}, step),
            (std::set<std::uint64_t>{1, 2, 3}));
}

TEST(Tops, OfTheOnlyHillBearWithItsSidesWhereTheStepDrivesBodiesInDeep) {
  const auto keptAtSpeed = [](double speed) {
    StepAhead step;
    step.size = 1;  // the depth is 1 % of it
    step.time_step = btScalar(0.01);
    BodyVelocity down;
    down.linear = -kUp * btScalar(speed);
    step.motion = PairMotion({0, 0, 0}, {}, {0, 0, 0}, down);
    return idsKept({onHill(0, 0, 0.01, 4, 2, 1), onHill(0.1, 0, 0.01, 4, 2, 2)}, step);
  };
  EXPECT_EQ(keptAtSpeed(0), std::set<std::uint64_t>{1});
  EXPECT_EQ(keptAtSpeed(1.5), std::set<std::uint64_t>{1});       // 2.5 % after the step
  EXPECT_EQ(keptAtSpeed(2.5), (std::set<std::uint64_t>{1, 2}));  // 3.5 %
}

TEST(Tops, AreNotAllOfWhatSweptBodiesMayMeet) {
  StepAhead step = stepOfSlowBodies();
  step.motion = PairMotion({0, 0, 0}, {}, {0, 0, 0}, {}, true);
  EXPECT_EQ(idsKept({onHill(0, 0, 0.01, 4, 2, 1), onHill(0.1, 0, 0.01, 4, 2, 2)}, step),
            (std::set<std::uint64_t>{1, 2}));
}

}  // namespace
}  // namespace innersphere::test
