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
