// What a packing says of itself: masses and the errors of its overlap volumes.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "analytic_solids.hpp"
#include "file_scratch.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing_file.hpp"
#include "innersphere/solids.hpp"
#include "mesh_shapes.hpp"
#include "packer/errors_by_depth.hpp"
#include "packer/overlap_errors.hpp"
#include "packer/overlap_trials.hpp"
#include "packer/surface_samples.hpp"
#include "packer/voxels.hpp"
#include "packer_oracles.hpp"

namespace innersphere::test {
namespace {

constexpr Real kBall = 4 * std::numbers::pi_v<Real> / 3;

Packing packed(const Solid& solid, std::size_t spheres, bool overlap_errors = false) {
  PackOptions options;
  options.spheres = spheres;
  options.overlap_errors = overlap_errors;
  return pack(solid, options);
}

/// Volume, centre of mass and inertia of weighted balls, about the origin of their frame.
struct Sums {
  Real volume = 0, first[3] = {}, inertia[3][3] = {};

  explicit Sums(const Packing& packing) {
    for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
      const Sphere& s = packing.spheres[i];
      const Real r = s.radius, m = packing.mass_weights[i] * kBall * r * r * r;
      const Real x[3] = {s.x, s.y, s.z}, squared = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
      volume += m;
      for (int k = 0; k < 3; ++k) {
        first[k] += m * x[k];
        for (int l = 0; l < 3; ++l) {
          inertia[k][l] += m * ((k == l ? squared + 2 * r * r / 5 : 0) - x[k] * x[l]);
        }
      }
    }
  }
};

void expectMassOfTheSolid(const Packing& packing) {
  ASSERT_EQ(packing.mass_weights.size(), packing.spheres.size());
  const MassProperties& solid = packing.solid;
  const Sums sums(packing);
  EXPECT_NEAR(sums.volume / solid.volume, 1, 1e-6);
  const Real size = std::sqrt((solid.inertia[0] + solid.inertia[4] + solid.inertia[8]) / solid.volume);
  Real c[3], squared = 0;
  for (int k = 0; k < 3; ++k) {
    c[k] = sums.first[k] / sums.volume;
    squared += c[k] * c[k];
    EXPECT_NEAR(c[k], solid.centre_of_mass[k], 1e-6 * size);
  }
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 3; ++l) {
      const Real about_centre = sums.inertia[k][l] - sums.volume * ((k == l ? squared : 0) - c[k] * c[l]);
      EXPECT_NEAR(about_centre, solid.inertia[3 * k + l], 1e-6 * size * size * solid.volume);
    }
  }
  for (float w : packing.mass_weights) EXPECT_GT(w, 0);
}

TEST(PackerMeasures, WeightedSpheresWeighLikeTheSolid) {
  for (const char* name : {"box", "lbracket", "torus"}) {
    SCOPED_TRACE(name);
    expectMassOfTheSolid(packed(*makeNamedSolid(name), 300));
  }
  expectMassOfTheSolid(packed(*makeNamedSolid("ball"), 10));
}

TEST(PackerMeasures, MassesThatCannotBeAreNamed) {
  const Packing packing = packed(*makeNamedSolid("box"), 2);
  EXPECT_TRUE(packing.mass_weights.empty());
  ASSERT_EQ(packing.warnings.size(), 2u);  // the first tells of the corners, which are far from two spheres
  EXPECT_NE(packing.warnings[1].find("inertia"), std::string::npos);
}

Packing packedMesh(const Mesh& mesh, std::size_t spheres) {
  return packed(*makeSolid(mesh, "parts"), spheres);
}

TEST(PackerMeasures, PartsWithoutASphereAreNamed) {
  Mesh mesh = boxMesh();
  append(mesh, boxMesh({2, 0, 0}, {2.1, 0.1, 0.1}));
  append(mesh, boxMesh({0, 2, 0}, {0.4, 2.4, 0.4}));
  const Packing few = packedMesh(mesh, 50);
  ASSERT_EQ(few.warnings.size(), 1u);
  EXPECT_NE(few.warnings[0].find("part 2 of 3"), std::string::npos) << few.warnings[0];
  EXPECT_NE(few.warnings[0].find("(2.05, 0.05, 0.05)"), std::string::npos) << few.warnings[0];
  EXPECT_NE(few.warnings[0].find("contacts by the triangles feel it"), std::string::npos) << few.warnings[0];
  EXPECT_TRUE(packedMesh(mesh, 500).warnings.empty());
}

// Spheres in what lies inside a hollow part are not in that part.
TEST(PackerMeasures, AHollowPartWithoutASphereIsNamed) {
  Mesh mesh = boxMesh();
  append(mesh, inverted(boxMesh({-0.49, -0.49, -0.49}, {0.49, 0.49, 0.49})));
  append(mesh, boxMesh({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}));
  const Packing packing = packedMesh(mesh, 40);
  ASSERT_FALSE(packing.warnings.empty());
  EXPECT_NE(packing.warnings.back().find("part 1 of 2"), std::string::npos) << packing.warnings.back();
}

TEST(PackerMeasures, ManyEmptyPartsAreCounted) {
  Mesh mesh = boxMesh();
  for (int i = 0; i < 15; ++i) append(mesh, boxMesh({2, 0.1 * i, 0}, {2.01, 0.1 * i + 0.01, 0.01}));
  const Packing packing = packedMesh(mesh, 20);
  ASSERT_EQ(packing.warnings.size(), 11u);
  EXPECT_EQ(packing.warnings.back(), "5 more parts got no sphere");
}

Pose poseOf(const Eigen::AngleAxisd& turn, const Point& centre, const Point& shift) {
  const Eigen::Matrix3d r = turn.toRotationMatrix();
  return {r, centre - r * centre + shift};
}

TEST(PackerMeasures, SampledOverlapOfCubesIsTheirs) {
  const Cube solid;
  const Container container(solid);
  const double in_cube = std::pow(container.side(), -3);
  const Voxels voxels(container, in_cube, 1 << 20), few(container, in_cube, 1 << 15);
  const Point centre = Point::Constant(0.5);
  for (const Point& shift : {Point(0.5, 0, 0), Point(0.7, 0.3, 0.1), Point(0.97, 0.2, 0), Point(0, 0, 0)}) {
    const auto found = voxels.shared(poseOf(Eigen::AngleAxisd::Identity(), centre, shift / container.side()));
    const double exact = (1 - shift[0]) * (1 - shift[1]) * (1 - shift[2]);
    EXPECT_NEAR(found.fraction / exact, 1, 0.01) << shift.transpose();
    const auto roughly = few.shared(poseOf(Eigen::AngleAxisd::Identity(), centre, shift / container.side()));
    EXPECT_NEAR(roughly.fraction / exact, 1, 0.05) << shift.transpose();
  }
  // Turned by 45 degrees about z, a corner of the copy reaches as deep as its diagonal says.
  const double depth = 0.3;
  const auto corner = voxels.shared(poseOf({std::numbers::pi / 4, Point::UnitZ()}, centre,
                                           Point(0.5 + std::sqrt(0.5) - depth, 0, 0) / container.side()));
  EXPECT_NEAR(corner.fraction / (depth * depth), 1, 0.01);
}

TEST(PackerMeasures, SampledOverlapOfBallsIsALens) {
  const TestBall solid;
  const Container container(solid);
  const double unit = 1 / container.side();
  const Voxels voxels(container, static_cast<double>(kBall) * std::pow(unit, 3), 1 << 20);
  for (double distance : {0.5, 1.0, 1.5, 1.8}) {
    const Point shift = distance * unit * Point(1, 2, -2) / 3;
    const auto found =
        voxels.shared(poseOf({0.7, Point(0.6, 0.8, 0)}, container.fromWorld({0, 0, 0}), shift));
    const double exact = static_cast<double>(lens(1, 1, distance) / kBall);
    EXPECT_LT(std::abs(found.fraction - exact), 6 * found.error + 2e-4 * exact + 2e-5);
    EXPECT_NEAR(found.fraction / exact, 1, 0.01);
  }
}

// One sphere stands for a ball, with the right radius and with a wrong one: both errors are known.
class OverlapErrorsOfABall : public testing::TestWithParam<double> {};

TEST_P(OverlapErrorsOfABall, AreThoseOfItsSphere) {
  const TestBall solid;
  const Container container(solid);
  const double unit = 1 / container.side(), wrong = GetParam();
  const std::vector<Ball> balls{{container.fromWorld({0, 0, 0}), wrong * unit}};
  // A volume-true radius is never the smaller one.
  const OverlapErrors errors = findOverlapErrors(container, {}, SurfaceSamples({}, container), balls,
                                                 {{1, {static_cast<float>(std::max(1.0, wrong))}, 0}},
                                                 static_cast<double>(kBall) * std::pow(unit, 3));
  ASSERT_EQ(errors.prefixes.size(), 1u);
  EXPECT_GE(errors.poses, 200u);
  EXPECT_EQ(errors.shallowest, 0.002);  // it has no surface
  EXPECT_LT(errors.sampling_error, 0.02);
  // The error of the wrong sphere at a distance, and how deep it is there: the rim of a lens is its area.
  const auto error = [&](double distance) {
    const long double found = lens(wrong, wrong, distance), exact = lens(1, 1, distance);
    return static_cast<double>(std::abs(found - exact) / std::max(found, exact));
  };
  const auto depth = [&](double distance) {
    const auto found = static_cast<double>(lens(wrong, wrong, distance));
    const double area = std::numbers::pi * (wrong * wrong - distance * distance / 4);
    return found / std::hypot(area, std::pow(found, 2.0 / 3)) / std::cbrt(static_cast<double>(kBall));
  };
  const OverlapErrors::Prefix& prefix = errors.prefixes[0];
  ASSERT_GE(prefix.raw.copies.size(), 8u);
  EXPECT_TRUE(prefix.raw.planes.empty());
  for (const double distance : {0.6, 1.0, 1.2, 1.4}) {
    const ExpectedError found = expectedError(prefix.raw, depth(distance));
    EXPECT_GT(found.mean, error(distance - 0.4));
    EXPECT_LT(found.bound, error(distance + 0.4));
    EXPECT_LE(found.mean, found.bound + 1e-12);
    if (wrong < 1) {
      EXPECT_LT(expectedError(prefix.volume_true, depth(distance)).mean, 3 * errors.sampling_error + 1e-3);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(PackerMeasures, OverlapErrorsOfABall, testing::Values(0.9, 1.1));

TEST(PackerMeasures, OverlapErrorsAreFoundFromTheSurfaceWhereItIsClosed) {
  const Packing packing = packed(*makeNamedSolid("lbracket"), 256, true);
  EXPECT_EQ(packing.overlap_errors.shallowest, 3e-5);
  EXPECT_EQ(packing.overlap_errors.sampling_error, 0);
}

// The triangles of a torus are chords: they lack 0.8 % of its volume, and deep overlaps are sampled.
TEST(PackerMeasures, OverlapErrorsAreNotFoundFromASurfaceOfAnotherVolume) {
  const Packing packing = packed(*makeNamedSolid("torus"), 256, true);
  EXPECT_EQ(packing.overlap_errors.shallowest, 3e-5);
  EXPECT_GT(packing.overlap_errors.sampling_error, 0);
  EXPECT_LT(packing.overlap_errors.sampling_error, 0.002);
}

TEST(PackerMeasures, OverlapErrorsFallWithMoreSpheres) {
  const Packing packing = packed(*makeNamedSolid("lbracket"), 1024, true);
  const OverlapErrors& errors = packing.overlap_errors;
  ASSERT_EQ(errors.prefixes.size(), packing.volume_true.size());
  const OverlapErrors::Prefix &few = errors.prefixes.front(), &all = errors.prefixes.back();
  EXPECT_EQ(few.count, 64u);
  EXPECT_EQ(all.count, 1024u);
  for (const double depth : {0.03, 0.06, 0.1, 0.2}) {
    const ExpectedError error = expectedError(all.volume_true, depth), raw = expectedError(all.raw, depth);
    EXPECT_LT(raw.mean, expectedError(few.raw, depth).mean);
    EXPECT_LT(error.mean, 0.5 * raw.mean);
    EXPECT_LT(error.mean, error.bound);
  }
  EXPECT_LT(all.volume_true.copies.back().error.mean, 0.02);
}

/// What a plane cuts off from a box with a corner in the origin.
double cutOff(Vec3d size, const Point& normal, double height) {
  double volume = 0;
  Vec3d n;
  for (int k = 0; k < 3; ++k) {  // seen from the corner that is the lowest
    n[k] = std::abs(normal[k]);
    if (normal[k] < 0) height += n[k] * size[k];
  }
  for (int corner = 0; corner < 8; ++corner) {
    double left = height, sign = 1;
    for (int k = 0; k < 3; ++k) {
      if ((corner >> k & 1) == 0) continue;
      left -= n[k] * size[k];
      sign = -sign;
    }
    volume += sign * std::pow(std::max(0.0, left), 3);
  }
  return volume / (6 * n[0] * n[1] * n[2]);
}

/// A sphere in a box stands for it.
class OneSphereInABox : public testing::Test {
 protected:
  static constexpr Vec3d size{1, 0.5, 0.4}, middle{0.4, 0.3, 0.2};
  static constexpr double volume = 0.2, radius = 0.2;

  const std::unique_ptr<Solid> solid = makeSolid(boxMesh({}, size), "box");
  const Container container{*solid};
  const double unit = 1 / container.side(), in_cube = volume * std::pow(unit, 3);
  const Surface surface = container.toSurface(solid->surface());
  const SurfaceSamples samples{solid->surface(), container};
  const std::vector<Ball> balls{{container.fromWorld(middle), radius* unit}};
  const OverlapErrors errors =
      findOverlapErrors(container, surface, samples, balls, {{1, {static_cast<float>(radius)}, 0}}, in_cube);
  const OverlapTrials trials = makeOverlapTrials(container, surface, samples, in_cube, 266, 0);
};

// What planes cut off from both is known.
TEST_F(OneSphereInABox, TellsErrorsOfPlanes) {
  const std::vector<PlaneCut>& planes = trials.planes;
  ASSERT_EQ(planes.size(), 88u);
  std::vector<double> thicknesses;
  for (const OverlapTrial& trial : trials.trials) {
    const double d = (trial.pose.apply(balls[0].centre) - balls[0].centre).norm() / unit;
    const auto shared = static_cast<double>(lens(radius, radius, d));
    if (shared > 0)
      thicknesses.push_back(shared / (std::numbers::pi * (radius * radius - d * d / 4)) / std::cbrt(volume));
  }
  ASSERT_GE(thicknesses.size(), 19u);
  std::sort(thicknesses.rbegin(), thicknesses.rend());
  const double thickest = std::accumulate(thicknesses.begin(), thicknesses.begin() + 19, 0.0) / 19;
  EXPECT_NEAR(errors.prefixes.at(0).raw.thickest, thickest, 1e-5 * thickest);
  std::vector<std::pair<double, double>> found;  // depths and errors
  for (const PlaneCut& plane : planes) {
    const double height = (plane.height - plane.normal.dot(container.fromWorld({}))) / unit;
    const double truth = cutOff(size, plane.normal, height);
    EXPECT_NEAR(plane.truth, truth / volume, 1e-6);
    const double below =
        std::clamp(height - plane.normal.dot(Point(middle[0], middle[1], middle[2])), -radius, radius);
    const double cap =
        std::numbers::pi * (2 * std::pow(radius, 3) / 3 + below * radius * radius - std::pow(below, 3) / 3);
    const double area = std::numbers::pi * (radius * radius - below * below);
    if (cap > 1e-12)
      found.emplace_back(cap / std::hypot(area, std::pow(cap, 2.0 / 3)) / std::cbrt(volume),
                         std::sqrt(2.0) * std::abs(cap - truth) / std::max(cap, truth));
  }
  std::sort(found.begin(), found.end());
  const std::vector<OverlapErrors::AtDepth>& rows = errors.prefixes.at(0).raw.planes;
  const std::size_t runs = found.size() / 19;
  ASSERT_GE(rows.size(), 2u);
  ASSERT_LE(rows.size(), runs);
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {  // planes beyond the sphere are all equally deep
    double largest = 0, mean = 0;
    for (std::size_t k = i * found.size() / runs; k < i * found.size() / runs + 19; ++k) {
      largest = std::max(largest, std::min(1.0, found[k].second));
      mean += std::min(1.0, found[k].second) / 19;
    }
    EXPECT_NEAR(rows[i].error.bound, largest, 1e-5);
    EXPECT_GE(rows[i].error.mean, mean - 1e-5);
  }
}

// What it shares with balls inside the box is known.
TEST_F(OneSphereInABox, TellsErrorsOfBallsInside) {
  const std::vector<Ball>& inside = trials.inside;
  ASSERT_EQ(inside.size(), 88u);
  std::vector<std::pair<double, double>> found;  // volumes and errors
  double least = 1, most = 0;
  for (const Ball& ball : inside) {
    const Vec3d at = container.toWorld(ball.centre);
    double clearance = 1;
    for (std::size_t k = 0; k < 3; ++k) clearance = std::min({clearance, at[k], size[k] - at[k]});
    const double r = ball.radius / unit, part = r / clearance;
    least = std::min(least, part);
    most = std::max(most, part);
    const double whole = 4 * std::numbers::pi / 3 * r * r * r, d = norm(at - middle);
    const auto shared = d < std::abs(r - radius) ? whole : static_cast<double>(lens(radius, r, d));
    found.emplace_back(whole / volume, std::min(1.0, std::sqrt(2.0) * (whole - shared) / whole));
  }
  EXPECT_NEAR(least, 0.1, 0.05);
  EXPECT_GE(least, 0.1 - 1e-6);
  EXPECT_NEAR(most, 1, 0.05);
  EXPECT_LE(most, 1 + 1e-6);
  std::sort(found.begin(), found.end());
  const std::vector<OverlapErrors::AtDepth>& rows = errors.prefixes.at(0).volume_true.inside;
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_TRUE(errors.prefixes.at(0).raw.inside.empty());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double largest = 0, mean = 0, at = 0;
    for (std::size_t k = i * found.size() / 4; k < i * found.size() / 4 + 19; ++k) {
      largest = std::max(largest, found[k].second);
      mean += found[k].second / 19;
      at += std::log(found[k].first) / 19;
    }
    EXPECT_NEAR(rows[i].depth, std::exp(at), 1e-5 * std::exp(at));
    EXPECT_EQ(rows[i].volume, rows[i].depth);
    EXPECT_NEAR(rows[i].error.bound, largest, 1e-5);
    EXPECT_GE(rows[i].error.mean, mean - 1e-5);
    EXPECT_EQ(rows[i].power, 0.5);
  }
}

// Copies of a blade never get as deep into each other as it gets into a thick body.
TEST(PackerMeasures, ThickBodiesAreForetoldByPlanes) {
  const Packing packing = packed(*makeNamedSolid("blade"), 1024, true);
  const OverlapErrors::Estimate& blade = packing.overlap_errors.prefixes.back().volume_true;
  ASSERT_GT(blade.thickest, 0);
  for (const double depth : {0.3, 0.6}) {
    const ExpectedError thin = expectedError(blade, depth, 0.9 * blade.thickest),
                        thick = expectedError(blade, depth, 1.1 * blade.thickest);
    EXPECT_EQ(thin.mean, expectedError(blade, depth).mean);
    EXPECT_LT(thick.mean, 0.6 * thin.mean);
    EXPECT_LT(thick.bound, thin.bound);
  }
  // Of what is shallower than all that planes cut off they know nothing.
  for (const double times : {0.5, 0.99}) {
    const double depth = times * blade.planes.front().depth;
    EXPECT_EQ(expectedError(blade, depth, 1.1 * blade.thickest).mean, expectedError(blade, depth).mean);
  }
}

// The limit of a mean is as many times the mean at all depths: that of a normal distribution, from the
// scatter of all poses. The mean of as many others scatters, too.
TEST(PackerMeasures, ErrorsAreForetoldFromTheScatterOfAllDepths) {
  std::vector<Finding> findings;
  double squares = 0;
  const auto isLarge = [](std::size_t i) { return i % 19 % 2 == 1; };
  for (std::size_t i = 0; i < 285; ++i) {
    const double mean = 0.4 / static_cast<double>(1 + i / 19),
                 part = i / 19 % 2 == 0 ? 0.1 : 0.6;            // every second depth scatters less
    const double one = isLarge(i) ? 1 + part : 1 - 0.9 * part;  // ten of them and nine of those: 1
    findings.push_back({0.01 * std::exp(0.01 * static_cast<double>(i)), mean * one, 0.1});
    squares += (one - 1) * (one - 1) / (15 * 18);
  }
  const std::vector<OverlapErrors::AtDepth> rows = errorsByDepth(findings);
  ASSERT_EQ(rows.size(), 15u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double mean = 0.4 / static_cast<double>(1 + i), largest = (i % 2 == 0 ? 1.1 : 1.6) * mean;
    const double limit = mean * std::exp(1.645 * std::sqrt(2 * squares / 19));
    EXPECT_NEAR(rows[i].error.mean, std::min(limit, largest), 1e-4 * mean) << i;
    EXPECT_NEAR(rows[i].error.bound, largest, 1e-12);
  }
}

// The means of others are below the limit in 19 of 20 cases, also of errors that scatter as much as they are
// large.
TEST(PackerMeasures, MeansOfOthersAreBelowTheirLimit) {
  std::mt19937 random(1);
  std::exponential_distribution<double> any(10);
  std::size_t above = 0, all = 0;
  for (int packing = 0; packing < 200; ++packing) {
    std::vector<Finding> findings;
    for (std::size_t i = 0; i < 285; ++i)
      findings.push_back({0.01 * std::exp(0.01 * static_cast<double>(i)), any(random), 0.1});
    for (const OverlapErrors::AtDepth& at : errorsByDepth(findings)) {
      double mean = 0;
      for (int i = 0; i < 19; ++i) mean += any(random) / 19;
      above += mean > at.error.mean;
      ++all;
    }
  }
  EXPECT_EQ(all, 3000u);
  EXPECT_NEAR(static_cast<double>(above) / static_cast<double>(all), 0.05, 0.02);
}

// Errors of many parts cancel, so that they fall with the volume; where all parts err alike they do not.
TEST(PackerMeasures, ErrorsFallWithTheVolumeAsTheyWereFoundTo) {
  const auto rowsWith = [](double power, double scatter) {
    std::vector<Finding> findings;
    for (std::size_t i = 0; i < 285; ++i) {
      const double volume = 0.01 * std::exp(0.1 * static_cast<double>(i % 19)),
                   times = i / 19 % 2 == 0 ? 1 + scatter : 1 - scatter;
      findings.push_back({0.01 * std::exp(0.01 * static_cast<double>(i)),
                          0.01 * std::pow(volume, -power) * (i % 2 == 0 ? times : 2 - times), volume});
    }
    return errorsByDepth(findings);
  };
  for (const OverlapErrors::AtDepth& at : rowsWith(0.25, 0)) {
    EXPECT_NEAR(at.power, 0.25, 0.05);
    EXPECT_NEAR(at.volume, 0.01 * std::exp(0.9), 1e-6);
  }
  // Less a standard error: 0.3 over the root of the squares of 0.1 * (k - 9), of 95 poses or of 57 at the
  // ends.
  const double squares = 0.01 * 570;
  const std::vector<OverlapErrors::AtDepth> rows = rowsWith(0, 0.3);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t runs = 1 + std::min<std::size_t>(i, 2) + std::min<std::size_t>(rows.size() - 1 - i, 2);
    EXPECT_NEAR(rows[i].power, -0.31 / std::sqrt(squares * static_cast<double>(runs)), 0.03) << i;
  }
  for (const OverlapErrors::AtDepth& at : rowsWith(0.25, 0.3)) {
    EXPECT_GT(at.power, 0.1);
    EXPECT_LT(at.power, 0.24);
  }
  // Walls that lie along walls: where they share more, more is left out.
  for (const OverlapErrors::AtDepth& at : rowsWith(-0.25, 0)) EXPECT_NEAR(at.power, -0.25, 0.08);
  for (const OverlapErrors::AtDepth& at : rowsWith(-1, 0)) EXPECT_EQ(at.power, -0.5);
  for (const OverlapErrors::AtDepth& at : rowsWith(1, 0)) EXPECT_EQ(at.power, 0.5);

  const OverlapErrors::Estimate estimate{
      {{0.1, {0.2, 0.4}, 0.01, 0.5}, {0.4, {0.1, 0.3}, 0.04, 0}}, 1, {}, {}, {}};
  EXPECT_NEAR(expectedError(estimate, 0.1, 0, 0.04).mean, 0.1, 1e-12);
  EXPECT_NEAR(expectedError(estimate, 0.1, 0, 0.04).bound, 0.2, 1e-12);
  EXPECT_EQ(expectedError(estimate, 0.1, 0, 1e-6).bound, 1);
  EXPECT_EQ(expectedError(estimate, 0.4, 0, 1e-6).mean, 0.1);
  const OverlapErrors::Estimate rising{{{0.1, {0.2, 0.4}, 0.01, -0.5}}, 1, {}, {}, {}};
  EXPECT_NEAR(expectedError(rising, 0.1, 0, 0.04).mean, 0.4, 1e-12);
  EXPECT_NEAR(expectedError(rising, 0.1, 0, 0.0025).bound, 0.2, 1e-12);
  const double between = expectedError(estimate, 0.2).mean;  // the volume there is 0.02, the power a quarter
  EXPECT_NEAR(expectedError(estimate, 0.2, 0, 0.32).mean, between / 2, 1e-12);
}

// Copies nearly upon the solid: a third moved only, a third turned only, a third both. What a box shares with
// one that is moved only is known.
TEST(PackerMeasures, CopiesNearlyUponTheSolidShareWhatTheirSurfacesDo) {
  const Vec3d size{1, 0.5, 0.4};
  const auto solid = makeSolid(boxMesh({}, size), "box");
  const Container container(*solid);
  const double unit = 1 / container.side();
  const OverlapTrials trials =
      makeOverlapTrials(container, container.toSurface(solid->surface()),
                        SurfaceSamples(solid->surface(), container), 0.2 * std::pow(unit, 3), 0, 39);
  ASSERT_EQ(trials.deep.size(), 39u);
  int moved = 0, turned = 0;
  for (const OverlapTrial& trial : trials.deep) {
    EXPECT_GT(trial.truth.fraction, 0.4);
    EXPECT_LT(trial.truth.fraction, 1);
    if (trial.pose.rotation.isIdentity()) {
      ++moved;
      double shared = 1;
      for (int k = 0; k < 3; ++k) shared *= 1 - std::abs(trial.pose.shift[k]) / (unit * size[k]);
      EXPECT_NEAR(trial.truth.fraction, shared, 1e-6);
    } else {  // about a point of the solid
      const Eigen::Vector3d axis = Eigen::AngleAxisd(trial.pose.rotation).axis();
      turned += std::abs(axis.dot(trial.pose.shift)) < 1e-9;
    }
  }
  EXPECT_EQ(moved, 13);
  EXPECT_EQ(turned, 13);
}

/// 40 copies that find 46 to 99 % and have these errors at these volumes.
template <class ErrorAt>
OverlapErrors::Estimate foretoldOfDeep(const ErrorAt& error_at) {
  std::vector<Finding> findings;
  for (int i = 0; i < 40; ++i) {
    const double volume = 0.46 + 0.53 * i / 39;
    findings.push_back({volume, error_at(volume, i), volume});
  }
  return {{}, 0, {}, errorsOfDeep(findings), {}};
}

// Errors may rise with the volume, or fall to nothing where a thin solid comes upon itself.
TEST(PackerMeasures, ErrorsOfDeepCopiesGoWithTheVolume) {
  const auto expectForetold = [](const auto& error_at) {
    const OverlapErrors::Estimate estimate =
        foretoldOfDeep([&](double volume, int) { return error_at(volume); });
    for (double volume = 0.5; volume < 0.98; volume += 0.01) {
      const ExpectedError expected = expectedError(estimate, 0.3, 0, volume, volume);
      EXPECT_GT(expected.mean, 0.98 * error_at(volume)) << volume;
      EXPECT_LT(expected.mean, 1.8 * error_at(volume)) << volume;
      EXPECT_GT(expected.bound, expected.mean);
    }
  };
  expectForetold([](double volume) { return 0.05 * volume * volume * volume; });
  expectForetold([](double volume) { return 0.8 * (1.02 - volume); });
  expectForetold([](double volume) { return 0.05 + 2 * (volume - 0.45) * (1 - volume); });
}

// The limit of a mean is that of a normal distribution: the means of a run of five and of 19 others scatter.
TEST(PackerMeasures, ErrorsOfDeepCopiesAreForetoldFromTheirScatter) {
  for (const double part : {0.1, 0.25}) {
    const OverlapErrors::Estimate estimate =
        foretoldOfDeep([part](double, int i) { return 0.04 * (1 + part * (i * 3 % 5 - 2)); });
    ASSERT_GT(estimate.deep.size(), 10u);
    const double variance = 10 * part * part / 4,
                 limit = std::exp(1.645 * std::sqrt(variance * (1.0 / 5 + 1.0 / 19)));
    for (const OverlapErrors::AtDepth& at : estimate.deep) {
      EXPECT_NEAR(at.error.mean, 0.04 * std::min(limit, 1 + 2 * part), 1e-9);
      EXPECT_NEAR(at.error.bound, 0.04 * (1 + 2 * part), 1e-12);
    }
  }
}

// Spheres that meet themselves find up to 1.2 times what there is. A query finds all, whatever they share:
// any error up to that where the sum has just come down to it, half of it in the mean.
TEST(PackerMeasures, DeepCopiesThatFindAllErrByAnyPartOfTheLargestError) {
  std::vector<Finding> findings;
  const auto error = [](double found) { return 0.1 * found * found; };
  for (int i = 0; i < 40; ++i) {
    const double found = 0.5 + 0.7 * i / 39;
    findings.push_back({found, error(found), found});
  }
  const OverlapErrors::Estimate estimate{{}, 0, {}, errorsOfDeep(findings), {}};
  ASSERT_GT(estimate.deep.size(), 10u);
  const ExpectedError nearly = expectedError(estimate, 0.3, 0, 0.999, 0.999),
                      all = expectedError(estimate, 0.3, 0, 1, 1);
  EXPECT_GT(nearly.mean, error(0.999));
  EXPECT_LT(nearly.mean, 1.2 * error(1));
  EXPECT_GT(nearly.bound, nearly.mean);
  EXPECT_NEAR(all.mean, nearly.mean / 2, 0.01 * error(1));
  EXPECT_NEAR(all.bound, nearly.bound, 0.01 * error(1));
  findings.resize(9);
  EXPECT_TRUE(errorsOfDeep(findings).empty());
}

// Copies of thin walls that find less than 45 % are foretold by those like them, not by the copies of all
// depths.
TEST(PackerMeasures, DeepCopiesCountFromTheFirstOfThem) {
  std::vector<Finding> findings;
  for (int i = 0; i < 40; ++i) findings.push_back({0.2 + 0.02 * i, 0.3, 0.2 + 0.02 * i});
  const OverlapErrors::Estimate thin{{{0.1, {0.01, 0.02}}}, 0, {}, errorsOfDeep(findings), {}};
  EXPECT_NEAR(expectedError(thin, 0.1, 0, 0.3, 0.3).bound, 0.3, 1e-9);
  EXPECT_EQ(expectedError(thin, 0.1, 0, 0.19, 0.19).bound, 0.02);
  // None found less than 60 %: from 45 % on.
  findings.erase(findings.begin(), findings.begin() + 20);
  const OverlapErrors::Estimate thick{{{0.1, {0.01, 0.02}}}, 0, {}, errorsOfDeep(findings), {}};
  EXPECT_EQ(expectedError(thick, 0.1, 0, 0.44, 0.44).bound, 0.02);
  EXPECT_NEAR(expectedError(thick, 0.1, 0, 0.46, 0.46).bound, 0.3, 1e-9);
}

// A third of the copies of a box have a face flat on a face of it: they are turned about one of its axes.
TEST(PackerMeasures, FacesOfCopiesLieFlatOnFaces) {
  const auto solid = makeSolid(boxMesh({}, {1, 0.5, 0.4}), "box");
  const Container container(*solid);
  const OverlapTrials trials = makeOverlapTrials(container, container.toSurface(solid->surface()),
                                                 SurfaceSamples(solid->surface(), container),
                                                 0.2 * std::pow(container.side(), -3), 60, 0);
  EXPECT_GE(trials.trials.size(), 58u);
  int flat = 0;
  for (const OverlapTrial& trial : trials.trials)
    flat += std::abs(trial.pose.rotation.cwiseAbs().maxCoeff() - 1) < 1e-9;
  EXPECT_GE(flat, 19);
}

// As of the first files that know them.
TEST(PackerMeasures, OneRowOfDeepCopiesHoldsForAllVolumes) {
  const OverlapErrors::Estimate estimate{{}, 0, {}, {{0.7, {0.1, 0.2}, 0.7, -2}}, {}};
  EXPECT_NEAR(expectedError(estimate, 0.1, 0, 0.9, 0.9).mean, 0.1 * 0.81 / 0.49, 1e-12);
  EXPECT_NEAR(expectedError(estimate, 0.1, 0, 0.5, 0.5).bound, 0.2 * 0.25 / 0.49, 1e-12);
}

// What a packing at a program's start leaves out: nothing but the errors, and a file is read back without
// them.
TEST(PackerMeasures, OverlapErrorsCanBeLeftOut) {
  const auto solid = makeNamedSolid("lbracket");
  PackOptions options;
  options.spheres = 256;
  const Packing with = pack(*solid, options);
  options.overlap_errors = false;
  const Packing without = pack(*solid, options);
  EXPECT_FALSE(with.overlap_errors.prefixes.empty());
  EXPECT_TRUE(without.overlap_errors.prefixes.empty());
  EXPECT_EQ(without.overlap_errors.poses, 0u);

  const Scratch scratch;
  const auto written = [&](Packing packing, const char* name) {
    packing.overlap_errors = {};
    writePacking(packing, scratch.path(name));
    return bytesOf(scratch.path(name));
  };
  EXPECT_EQ(written(with, "with.cbor"), written(without, "without.cbor"));
  const Packing read = readPacking(scratch.path("without.cbor"));
  EXPECT_TRUE(read.overlap_errors.prefixes.empty());
  EXPECT_EQ(read.spheres.size(), 256u);
  EXPECT_EQ(read.volume_true.size(), 3u);
}

}  // namespace
}  // namespace innersphere::test
