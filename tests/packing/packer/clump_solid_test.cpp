// Clumps: spheres that may overlap, whose union is near to a solid. Where closed forms tell which spheres are
// best they are found, and what is said of the others is what points tell.
#include "innersphere/clump_solid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "../file_scratch.hpp"
#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing_file.hpp"
#include "innersphere/solids.hpp"

namespace innersphere::test {
namespace {

constexpr double kPi = std::numbers::pi;

Covering clumpOf(const Solid& solid, std::size_t spheres, double outside_weight = 1) {
  ClumpOptions options;
  options.spheres = spheres;
  options.outside_weight = outside_weight;
  return clumpSolid(solid, options);
}

Vec3d centreOf(const Sphere& s) {
  return {s.x, s.y, s.z};
}

bool holds(const Sphere& s, const Vec3d& p) {
  return norm(p - centreOf(s)) <= double{s.radius};
}

bool holds(const Covering& clump, const Vec3d& p) {
  return std::any_of(clump.spheres.begin(), clump.spheres.end(),
                     [&](const Sphere& s) { return holds(s, p); });
}

// Where the union grows no more with the radius, the part of the sphere's area that is outside of the cube
// counts as much as the one inside: six caps with 3 (r - 1/2) / r of it.
TEST(ClumpSolid, TheBestSphereOfACubeIsFound) {
  const auto box = makeBox({1, 1, 1});
  for (const double weight : {1.0, 4.0, 20.0}) {
    const Covering clump = clumpOf(*box, 1, weight);
    ASSERT_EQ(clump.spheres.size(), 1u);
    const Sphere& s = clump.spheres[0];
    EXPECT_NEAR(s.radius, 1.5 / (3 - 1 / (1 + weight)), 0.01) << weight;
    EXPECT_LT(norm(centreOf(s)), 0.01);

    const double r = s.radius, caps = 6 * kPi / 3 * std::pow(r - 0.5, 2) * (2 * r + 0.5);
    const double ball = 4 * kPi / 3 * r * r * r;
    EXPECT_NEAR(clump.outside, caps, 0.005);
    EXPECT_NEAR(clump.inside, ball - caps, 0.005);
    EXPECT_NEAR(clump.united.volume, ball, 1e-4 * ball);
    EXPECT_NEAR(clump.united.inertia[4], 0.4 * ball * r * r, 1e-4);
    EXPECT_NEAR(clump.united.inertia[1], 0, 1e-6);
    EXPECT_LT(norm(clump.united.centre_of_mass - centreOf(s)), 1e-6);
    EXPECT_NEAR(clump.overhang_max, r - 0.5, 0.003);
    EXPECT_NEAR(clump.gap_max, std::sqrt(0.75) - r, 0.02);
    EXPECT_TRUE(clump.mass_weights.empty());
  }
}

/// Two balls on the x axis that overlap: their distance is exact on both sides.
struct TwoBalls {
  double x[2] = {-0.3, 0.5}, r[2] = {0.8, 0.5};

  double operator()(const Vec3d& p) const {
    const double a = norm(p - Vec3d{x[0], 0, 0}) - r[0], b = norm(p - Vec3d{x[1], 0, 0}) - r[1];
    if (std::min(a, b) >= 0) return std::min(a, b);
    // The nearest point is that of a sphere, unless the other one holds that, or it is on the circle of both.
    const double d = x[1] - x[0], along = (d * d + r[0] * r[0] - r[1] * r[1]) / (2 * d);
    const double circle = std::sqrt(r[0] * r[0] - along * along), off = std::hypot(p[1], p[2]);
    double nearest = std::hypot(p[0] - x[0] - along, off - circle);
    for (int i = 0; i < 2; ++i) {
      const Vec3d from = p - Vec3d{x[i], 0, 0};
      const Vec3d at = Vec3d{x[i], 0, 0} + r[i] / std::max(norm(from), 1e-12) * from;
      if (norm(at - Vec3d{x[1 - i], 0, 0}) >= r[1 - i])
        nearest = std::min(nearest, std::abs(norm(from) - r[i]));
    }
    return -nearest;
  }

  double volume() const {
    const double d = x[1] - x[0], sum = r[0] + r[1];
    const double lens =
        kPi * (sum - d) * (sum - d) * (d * d + 2 * d * sum - 3 * (r[0] - r[1]) * (r[0] - r[1])) / (12 * d);
    return 4 * kPi / 3 * (std::pow(r[0], 3) + std::pow(r[1], 3)) - lens;
  }
};

TEST(ClumpSolid, TwoBallsThatOverlapAreFound) {
  const TwoBalls balls;
  const auto solid = makeDistanceSolid("two balls", balls, {{-1.1, -0.8, -0.8}, {1, 0.8, 0.8}});
  const Covering clump = clumpOf(*solid, 2);
  ASSERT_EQ(clump.spheres.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    const auto nearest =
        std::min_element(clump.spheres.begin(), clump.spheres.end(), [&](const Sphere& a, const Sphere& b) {
          return std::abs(a.x - balls.x[i]) < std::abs(b.x - balls.x[i]);
        });
    EXPECT_LT(norm(centreOf(*nearest) - Vec3d{balls.x[i], 0, 0}), 0.01) << i;
    EXPECT_NEAR(nearest->radius, balls.r[i], 0.01) << i;
  }
  EXPECT_NEAR(clump.united.volume, balls.volume(), 0.01 * balls.volume());
  EXPECT_GT(clump.inside, 0.99);
  EXPECT_LT(clump.outside, 0.01);
}

TEST(ClumpSolid, MoreSpheresThanNeededDoNoHarm) {
  const Covering clump = clumpOf(*makeBall(2), 20);
  EXPECT_LE(clump.spheres.size(), 20u);
  EXPECT_GT(clump.inside, 0.995);
  EXPECT_LT(clump.outside, 0.005);
}

// A cube around it has few cells across the rod. 64 balls of its thickness fill a third of it.
TEST(ClumpSolid, AThinRodIsFilled) {
  const Covering clump = clumpOf(*makeBox({1, 0.01, 0.01}), 64);
  EXPECT_GT(clump.inside - clump.outside, 64 * kPi / 6 * 0.01);
}

TEST(ClumpSolid, ASheetHasNone) {
  try {
    clumpOf(*makeBox({1, 1, 1e-6}), 8);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::no_sphere_fits);
  }
}

/// How far a point is outside of the box of this size around the origin.
double outside(const Vec3d& size, const Vec3d& p) {
  Vec3d out;
  for (int k = 0; k < 3; ++k) out[k] = std::max(0.0, std::abs(p[k]) - size[k] / 2);
  return norm(out);
}

// Far away, so that the spheres have a frame of their own.
TEST(ClumpSolid, SaysOfItsUnionWhatPointsTell) {
  const Vec3d size{1, 0.8, 0.5}, there{1000, -200, 30};
  Mesh mesh = makeBox(size)->surface();
  for (Vec3d& v : mesh.vertices) v = v + there;
  const Covering clump = clumpOf(*makeSolid(std::move(mesh), "box"), 24);
  ASSERT_EQ(clump.spheres.size(), 24u);
  const Vec3d to_box = clump.origin - there;
  EXPECT_GT(norm(clump.origin), 0);

  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> part(-0.5, 0.5);
  const int points = 400000;
  const Vec3d cube{1.5, 1.5, 1.5};
  double inside = 0, all = 0, volume = cube[0] * cube[1] * cube[2] / points;
  Vec3d first{}, second{}, mixed{};
  for (int i = 0; i < points; ++i) {
    Vec3d p;
    for (int k = 0; k < 3; ++k) p[k] = part(random) * cube[k];
    const Vec3d x = p - to_box;
    if (!holds(clump, x)) continue;
    all += volume;
    if (outside(size, p) == 0) inside += volume;
    first = first + volume * x;
    for (int k = 0; k < 3; ++k) {
      second[k] += volume * x[k] * x[k];
      mixed[k] += volume * x[k] * x[(k + 1) % 3];
    }
  }
  const double solid = size[0] * size[1] * size[2];
  EXPECT_NEAR(clump.solid.volume, solid, 1e-9);
  EXPECT_LT(norm(clump.solid.centre_of_mass + to_box), 1e-9);
  EXPECT_NEAR(clump.inside, inside / solid, 0.01);
  EXPECT_NEAR(clump.outside, (all - inside) / solid, 0.01);
  EXPECT_NEAR(clump.united.volume, all, 0.01 * all);
  const Vec3d c = (1 / all) * first;
  EXPECT_LT(norm(clump.united.centre_of_mass - c), 0.003);
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3, m = (k + 2) % 3;
    const double ll = second[l] - all * c[l] * c[l], mm = second[m] - all * c[m] * c[m];
    EXPECT_NEAR(clump.united.inertia[4 * k], ll + mm, 0.02 * (ll + mm));
    EXPECT_NEAR(clump.united.inertia[3 * k + l], all * c[k] * c[l] - mixed[k], 0.02 * (ll + mm));
  }

  double sum = 0, area = 0, most = 0;
  std::normal_distribution<double> normal;
  for (const Sphere& s : clump.spheres) {
    for (int i = 0; i < 3000; ++i) {
      const Vec3d way{normal(random), normal(random), normal(random)};
      const Vec3d p = centreOf(s) + double{s.radius} / norm(way) * way;
      const auto inOther = [&](const Sphere& other) { return &other != &s && holds(other, p); };
      if (std::any_of(clump.spheres.begin(), clump.spheres.end(), inOther)) continue;
      const double weight = double{s.radius} * s.radius, out = outside(size, p + to_box);
      sum += weight * out;
      area += weight;
      most = std::max(most, out);
    }
  }
  EXPECT_NEAR(clump.overhang_mean, sum / area, 0.05 * sum / area);
  EXPECT_NEAR(clump.overhang_max, most, 0.1 * most);

  double gaps = 0, gap = 0;
  int samples = 0;
  for (int i = 0; i < 60000; ++i) {
    Vec3d p;
    for (int k = 0; k < 3; ++k) p[k] = part(random) * size[k];
    // A face by its area.
    const double faces[] = {size[1] * size[2], size[2] * size[0], size[0] * size[1]};
    const int k = std::discrete_distribution<int>(std::begin(faces), std::end(faces))(random);
    p[k] = (i % 2 ? 0.5 : -0.5) * size[k];
    double nearest = 10;
    for (const Sphere& s : clump.spheres)
      nearest = std::min(nearest, norm(p - to_box - centreOf(s)) - double{s.radius});
    gaps += std::max(0.0, nearest);
    gap = std::max(gap, nearest);
    ++samples;
  }
  EXPECT_NEAR(clump.gap_mean, gaps / samples, 0.05 * gaps / samples);
  EXPECT_NEAR(clump.gap_max, gap, 0.1 * gap);

  // With these densities the spheres weigh like the solid.
  ASSERT_EQ(clump.mass_weights.size(), clump.spheres.size());
  double mass = 0, zz = 0;
  Vec3d moment{};
  for (std::size_t i = 0; i < clump.spheres.size(); ++i) {
    const Sphere& s = clump.spheres[i];
    const double r = s.radius, m = clump.mass_weights[i] * 4 * kPi / 3 * r * r * r;
    const Vec3d p = centreOf(s) + to_box;
    EXPECT_GT(m, 0);
    mass += m;
    moment = moment + m * p;
    zz += m * (p[0] * p[0] + p[1] * p[1] + 0.4 * r * r);
  }
  EXPECT_NEAR(mass, solid, 1e-5 * solid);
  EXPECT_LT(norm(moment), 1e-5 * solid);
  EXPECT_NEAR(zz, solid / 12 * (size[0] * size[0] + size[1] * size[1]), 1e-5 * solid);
}

TEST(ClumpSolid, ComesNearerThanSpheresThatDoNotOverlap) {
  for (const std::string name : {"box", "gear", "link", "knot"}) {
    const auto solid = makeNamedSolid(name);
    PackOptions options;
    options.spheres = 32;
    options.overlap_errors = false;
    const double left_out = 1 - pack(*solid, options).quality.density;
    const Covering clump = clumpOf(*solid, 32), careful = clumpOf(*solid, 32, 10);
    EXPECT_LT(1 - clump.inside + clump.outside, 0.75 * left_out) << name;
    EXPECT_LT(careful.outside, clump.outside / 2) << name;
    EXPECT_LT(careful.outside, 0.01) << name;
    EXPECT_LT(1 - careful.inside, left_out) << name;
  }
}

TEST(ClumpSolid, IsTheSameForAnyNumberOfThreads) {
  const auto solid = makeNamedSolid("gear");
  ClumpOptions options;
  options.spheres = 16;
  options.threads = 1;
  const Covering one = clumpSolid(*solid, options);
  options.threads = 3;
  const Covering three = clumpSolid(*solid, options);
  ASSERT_EQ(one.spheres.size(), three.spheres.size());
  for (std::size_t i = 0; i < one.spheres.size(); ++i) {
    const Sphere &a = one.spheres[i], &b = three.spheres[i];
    EXPECT_TRUE(a.x == b.x && a.y == b.y && a.z == b.z && a.radius == b.radius);
  }
  EXPECT_EQ(one.inside, three.inside);
  EXPECT_EQ(one.overhang_mean, three.overhang_mean);
  EXPECT_EQ(one.united.inertia, three.united.inertia);
  EXPECT_EQ(one.mass_weights, three.mass_weights);
}

TEST(ClumpSolid, IsNotTakenForAPacking) {
  const Scratch scratch;
  const Covering clump = clumpOf(*makeBox({1, 1, 1}), 4);
  writeCovering(clump, scratch.path("box.json"));
  try {
    readPacking(scratch.path("box.json"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_format);
    EXPECT_NE(std::string(error.what()).find("clump"), std::string::npos);
  }
  EXPECT_THROW(writeCovering(clump, scratch.path("box.cbor")), Error);
}

TEST(ClumpSolid, IsReadBackBitForBit) {
  const Scratch scratch;
  const auto gear = makeNamedSolid("gear");
  const Covering clump = clumpOf(*gear, 20);
  const std::string path = scratch.path("gear.json");
  writeCovering(clump, path);
  const Covering read = readCovering(path).value();
  EXPECT_EQ(read.kind, CoveringKind::clump);
  ASSERT_EQ(read.spheres.size(), 20u);
  for (std::size_t i = 0; i < 20; ++i) {
    const Sphere &a = read.spheres[i], &b = clump.spheres[i];
    EXPECT_TRUE(a.x == b.x && a.y == b.y && a.z == b.z && a.radius == b.radius) << i;
  }
  for (const auto number : {&Covering::inside, &Covering::outside, &Covering::overhang_mean,
                            &Covering::overhang_max, &Covering::gap_mean, &Covering::gap_max})
    EXPECT_EQ(read.*number, clump.*number);
  EXPECT_EQ(read.origin, clump.origin);
  EXPECT_EQ(read.solid.inertia, clump.solid.inertia);
  EXPECT_EQ(read.united.centre_of_mass, clump.united.centre_of_mass);
  EXPECT_EQ(read.mass_weights, clump.mass_weights);
  EXPECT_EQ(read.provenance.options, clump.provenance.options);

  writePacking(pack(*gear, {.spheres = 5, .overlap_errors = false}), scratch.path("packing.json"));
  EXPECT_FALSE(readCovering(scratch.path("packing.json")));
  EXPECT_THROW(readCovering(scratch.path("none.json")), Error);
}

TEST(ClumpSolid, NoBytesInItsFileDoHarm) {
  const Scratch scratch;
  writeCovering(clumpOf(*makeBox({1, 2, 3}), 2), scratch.path("box.json"));
  const std::string good = bytesOf(scratch.path("box.json"));
  int refused = 0;
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (const char c : {'[', '"', '9', '-'}) {
      std::string bytes = good;
      bytes[i] = c;
      try {
        readCovering(scratch.write("bad.json", bytes));
      } catch (const Error& error) {
        EXPECT_TRUE(error.code() == ErrorCode::bad_format || error.code() == ErrorCode::unsupported_version);
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 1000);
}

TEST(ClumpSolid, NamesBadOptions) {
  const auto box = makeBox({1, 1, 1});
  const auto codeOf = [&](const ClumpOptions& options, const Progress& progress = {}) {
    try {
      clumpSolid(*box, options, progress);
    } catch (const Error& error) {
      return std::optional(error.code());
    }
    return std::optional<ErrorCode>();
  };
  ClumpOptions options;
  for (const std::size_t spheres : {std::size_t{0}, std::size_t{1001}}) {
    options = {};
    options.spheres = spheres;
    EXPECT_EQ(codeOf(options), ErrorCode::bad_argument);
  }
  for (const double weight : {0.5, 101.0, std::nan("")}) {
    options = {};
    options.outside_weight = weight;
    EXPECT_EQ(codeOf(options), ErrorCode::bad_argument);
  }
  options = {};
  options.threads = -1;
  EXPECT_EQ(codeOf(options), ErrorCode::bad_argument);
  options = {};
  options.spheres = 2;
  double reached = 0;
  EXPECT_EQ(codeOf(options, [&](const char*, double fraction) { return (reached = fraction) < 0.4; }),
            ErrorCode::cancelled);
  EXPECT_LT(reached, 0.6);
}

}  // namespace
}  // namespace innersphere::test
