// The direction of contact where it is known: of balls, of a face on an edge, of tilted faces.
#include "narrow_phase/contact_normal.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace innersphere::test {
namespace {

constexpr double kRounding = 1e-5;
const btVector3 kUp(0, 0, 1);

btVector3 leaning(double degrees) {
  const double angle = degrees * M_PI / 180;
  return btVector3(btScalar(std::sin(angle)), 0, btScalar(std::cos(angle)));
}

ProbedSample sampleOf(const btVector3& normal_a, const btVector3& normal_b, double curvature_a = 0,
                      double curvature_b = 0) {
  ProbedSample sample;
  sample.direction = kUp;
  sample.points.normal_a = normal_a;
  sample.points.normal_b = normal_b;
  sample.points.curvature_a = btScalar(curvature_a);
  sample.points.curvature_b = btScalar(curvature_b);
  return sample;
}

/// Faces that go on as far as a test says.
class Faces : public FaceExtents {
 public:
  Faces(double a, double b) : distances_{btScalar(a), btScalar(b)} {}
  EdgeDistances edgeDistances(const OpposedPoints&, const btVector3& towards) const override {
    towards_ = towards;
    return distances_;
  }
  const btVector3& askedTowards() const { return towards_; }

 private:
  EdgeDistances distances_;
  mutable btVector3 towards_{0, 0, 0};
};

/// Surfaces that are straight along an axis each, as tubes.
class Tubes : public SurfaceProbe {
 public:
  Tubes(const btVector3& axis_a, double curvature_a, const btVector3& axis_b, double curvature_b)
      : axis_a_(axis_a), axis_b_(axis_b), a_(btScalar(curvature_a)), b_(btScalar(curvature_b)) {}
  bool probeLine(std::size_t, const btVector3&, const btVector3&, OpposedPoints&) const override {
    return false;
  }
  btVector3 lineStart(std::size_t) const override { return {0, 0, 0}; }
  btScalar reach(std::size_t) const override { return 0; }
  bool nearest(std::size_t, btVector3&, OpposedPoints&) const override { return false; }
  btScalar meets(bool, const btVector3&, const btVector3&) const override { return -1; }
  Bend bend(bool of_a, const OpposedPoints&, const Across& axes) const override {
    return of_a ? Bend::about(axis_a_, axes, a_) : Bend::about(axis_b_, axes, b_);
  }

 private:
  btVector3 axis_a_, axis_b_;
  btScalar a_, b_;
};

TEST(Opposed, MeansLessThan20Degrees) {
  EXPECT_TRUE(opposed(sampleOf(kUp, leaning(19)).points));
  EXPECT_FALSE(opposed(sampleOf(kUp, leaning(21)).points));
}

TEST(ContactNormal, BesideTheDeepestPointOfTwoBallsIsThatOfTheirCentres) {
  // Balls of 1 m and 0.4 m, one over the other, at a line 0.05 m beside that of their centres.
  const double shift = 0.05, a = 1 / 1.0, b = 1 / 0.4;
  const auto normal = [&](double curvature) {
    const double sine = shift * curvature;
    return btVector3(btScalar(sine), 0, btScalar(std::sqrt(1 - sine * sine)));
  };
  const ProbedSample sample = sampleOf(normal(a), normal(-b), a, b);
  EXPECT_NEAR(ContactNormal({sample}, nullptr).at(sample).distance(kUp), 0, kRounding);
  EXPECT_NEAR(normalAlone(sample.points, kUp).distance(kUp), 0, kRounding);
}

TEST(ContactNormal, IsThatOfTheFlatSurfaceWhereTheOtherIsCurved) {
  const ProbedSample on_b = sampleOf(leaning(10), kUp, 2, 0), on_a = sampleOf(kUp, leaning(10), 0, 2);
  EXPECT_NEAR(ContactNormal({on_b}, nullptr).at(on_b).distance(kUp), 0, kRounding);
  EXPECT_NEAR(ContactNormal({on_a}, nullptr).at(on_a).distance(kUp), 0, kRounding);
}

TEST(ContactNormal, OfTiltedFacesIsThatOfTheFaceThatGoesOn) {
  const ProbedSample sample = sampleOf(kUp, leaning(6));
  const Faces ends_a(0.01, 1), ends_b(1, 0.01), alike(1, 1);
  EXPECT_NEAR(ContactNormal({sample}, &ends_a).at(sample).distance(leaning(6)), 0, kRounding);
  EXPECT_NEAR(ContactNormal({sample}, &ends_b).at(sample).distance(kUp), 0, kRounding);
  // Neither ends sooner: half of each.
  EXPECT_NEAR(ContactNormal({sample}, &alike).at(sample).distance(leaning(3)), 0, kRounding);
  // Only the distance of B is known: its face is taken as endless.
  EXPECT_NEAR(ContactNormal({sample}, nullptr).at(sample).distance(leaning(6)), 0, kRounding);
  // Edges are looked for where the contact gets deeper: to where B's normal leans.
  EXPECT_NEAR(ends_a.askedTowards().distance(leaning(93)), 0, kRounding);
}

TEST(ContactNormal, OfAnEdgeIsThatOfTheFaceItLiesOn) {
  // Both faces of A beside its edge, on one face of B.
  const std::vector<ProbedSample> samples{sampleOf(leaning(45), kUp), sampleOf(leaning(-45), kUp)};
  const Faces alike(1, 1);
  for (const FaceExtents* extents :
       {static_cast<const FaceExtents*>(&alike), static_cast<const FaceExtents*>(nullptr)}) {
    const ContactNormal normal(samples, extents);
    for (const ProbedSample& sample : samples) {
      EXPECT_NEAR(normal.at(sample).distance(kUp), 0, kRounding);
    }
  }
  // And the other way round.
  const std::vector<ProbedSample> upside_down{sampleOf(kUp, leaning(45)), sampleOf(kUp, leaning(-45))};
  EXPECT_NEAR(ContactNormal(upside_down, nullptr).at(upside_down[0]).distance(kUp), 0, kRounding);
  EXPECT_NEAR(ContactNormal(upside_down, &alike).at(upside_down[1]).distance(kUp), 0, kRounding);
}

TEST(ContactNormal, OfTwoEdgesIsTheDirectionOfTheProbe) {
  const std::vector<ProbedSample> samples{sampleOf(leaning(45), leaning(-45)),
                                          sampleOf(leaning(-45), leaning(45))};
  const Faces alike(1, 1);
  EXPECT_NEAR(ContactNormal(samples, &alike).at(samples[0]).distance(kUp), 0, kRounding);
  EXPECT_NEAR(normalAlone(samples[0].points, kUp).distance(kUp), 0, kRounding);
}

TEST(ContactNormal, OfCrossingTubesIsThatOfTheirTop) {
  // Tubes of 0.2 m and 0.05 m one over the other, whose axes cross at any angle, at a line beside the middle.
  for (const double degrees : {90.0, 45.0, 20.0}) {
    const double angle = degrees * M_PI / 180, ra = 0.2, rb = 0.05;
    const btVector3 axis_a(1, 0, 0), axis_b(btScalar(std::cos(angle)), btScalar(std::sin(angle)), 0);
    const Tubes tubes(axis_a, 1 / ra, axis_b, 1 / rb);
    const btVector3 place(btScalar(0.004), btScalar(0.006), 0);
    const auto normal = [&](const btVector3& axis, double radius) {
      const btVector3 aside = (place - axis * place.dot(axis)) / btScalar(radius);
      return aside + kUp * btSqrt(1 - aside.length2());
    };
    const ProbedSample sample = sampleOf(normal(axis_a, ra), normal(axis_b, -rb), 1 / ra / 2, 1 / rb / 2);
    EXPECT_NEAR(ContactNormal({sample}, nullptr, &tubes).at(sample).distance(kUp), 0, 1e-3) << degrees;
  }
}

TEST(ContactNormal, OfATubeBesideARodIsThatOfTheRod) {
  // The tube runs around the rod, a ring: along the rod, which is straight, it leans by any angle.
  const btVector3 around(1, 0, 0), along(0, 1, 0);
  for (const double lean : {5.0, 15.0, 40.0}) {
    const double angle = lean * M_PI / 180;
    const btVector3 leans(0, btScalar(std::sin(angle)), btScalar(std::cos(angle)));
    const Tubes ring(along, 20, around, 60);
    const ProbedSample sample = sampleOf(kUp, leans, 10, 30);
    const Faces endless(BT_LARGE_FLOAT, BT_LARGE_FLOAT), ends_above(1, BT_LARGE_FLOAT);
    for (const Faces* faces : {&endless, &ends_above})
      EXPECT_NEAR(ContactNormal({sample}, faces, &ring).at(sample).distance(kUp), 0, 0.1 * angle) << lean;
  }
}

TEST(ContactNormal, IsAUnitVector) {
  for (const double lean : {0.0, 3.0, 12.0, 18.0, 40.0, 80.0}) {
    for (const double curvature : {0.0, 0.5, -0.2}) {
      const std::vector<ProbedSample> samples{sampleOf(kUp, leaning(lean), curvature, 1)};
      EXPECT_NEAR(ContactNormal(samples, nullptr).at(samples[0]).length(), 1, kRounding);
      EXPECT_NEAR(normalAlone(samples[0].points, kUp).length(), 1, kRounding);
    }
  }
}

}  // namespace
}  // namespace innersphere::test
