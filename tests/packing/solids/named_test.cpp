// The generated meshes: closed, wound outwards, free of cuts, of the right genus and volume; nut and bolt
// mate.
#include <gtest/gtest.h>

#include "innersphere/error.hpp"
#include "innersphere/solids.hpp"
#include "mesh_oracles.hpp"
#include "mesh_shapes.hpp"
#include "solids/named_meshes.hpp"

namespace innersphere::test {
namespace {

constexpr double kPi = std::numbers::pi;

struct Generated {
  const char* name;
  Mesh (*generate)();
  long euler;
  double volume;     ///< closed form of the smooth solid; 0 if there is none
  double tolerance;  ///< relative, for the facets
};

void PrintTo(const Generated& solid, std::ostream* out) {
  *out << solid.name;
}

// Area of a polygon in polar form, for the cross-section of the gear.
double gearVolume() {
  const double tooth = 2 * kPi / 16;
  const auto sector = [](double r, double s, double angle) { return r * s * std::sin(angle) / 2; };
  const double root = 3 * sector(0.42, 0.42, 0.5 / 3 * tooth);
  const double flanks = 2 * sector(0.42, 0.52, 0.13 * tooth);
  const double tip = 2 * sector(0.52, 0.52, 0.12 * tooth);
  const double bore = 3 * sector(0.2, 0.2, 0.5 / 3 * tooth) + 2 * sector(0.2, 0.2, 0.13 * tooth) +
                      2 * sector(0.2, 0.2, 0.12 * tooth);
  return 16 * (root + flanks + tip - bore) * 0.25;
}

// Mean of the squared radius of the thread: root and crest lines and the flanks between.
double threadArea(double clearance) {
  const double crest = 0.3 + clearance, root = crest - 0.068;
  const double flank = (crest * crest + crest * root + root * root) / 3;
  return kPi * (crest * crest / 9 + root * root * 2 / 9 + flank * 2 / 3);
}

const double kHexagonArea = 2 * std::sqrt(3) * 0.425 * 0.425;

double frustum(double bottom, double top, double height) {
  return kPi * height / 3 * (bottom * bottom + bottom * top + top * top);
}

std::vector<Generated> generated() {
  const double bowl = 2 * kPi / 3 * (0.125 - std::pow(0.42, 3)) + kPi * kPi * 0.46 * 0.04 * 0.04;
  const double link = 2 * kPi * kPi * 0.25 * 0.08 * 0.08 + 1.2 * kPi * 0.08 * 0.08;
  return {
      {"link", linkMesh, 0, link, 0.02},
      {"bowl", bowlMesh, 2, bowl, 0.01},
      {"gear", gearMesh, 0, gearVolume(), 1e-12},
      {"lbracket", lbracketMesh, 2, 0.51 * 0.3, 1e-12},
      {"tray", trayMesh, 2, 4 - 1.6 * 1.6 * 0.8, 1e-12},
      {"knot", knotMesh, 0, 0, 0},
      {"nut", nutMesh, 0, 0.375 * (kHexagonArea - threadArea(0.01)), 0.02},
      {"bolt", boltMesh, 2, 0.25 * kHexagonArea + 0.75 * threadArea(0), 0.01},
      {"chazelle", chazelleMesh, 2, 0, 0},
      {"cup", cupMesh, 2, frustum(0.35, 0.4, 0.9) - frustum(0.35 + 0.05 * 0.04 / 0.9 - 0.008, 0.392, 0.86),
       0.01},
      {"pan", panMesh, 2, frustum(0.4, 0.5, 0.15) - frustum(0.4 + 0.1 / 15 - 0.006, 0.494, 0.14), 0.01},
      {"blade", bladeMesh, 2, 0, 0},
      {"horn", hornMesh, 2, kPi * 0.15 * 0.15 * 0.5 * 2 * kPi / 9, 0.02},
  };
}

class SolidsGenerated : public testing::TestWithParam<Generated> {};

TEST_P(SolidsGenerated, IsACleanClosedMesh) {
  MeshReport report;
  makeSolid(GetParam().generate(), GetParam().name, {}, &report);
  for (const std::string& note : report.notes) ADD_FAILURE() << note;
  EXPECT_EQ(report.components, 1u);

  const auto solid = makeNamedSolid(GetParam().name);
  const Mesh mesh = solid->surface();
  EXPECT_TRUE(isClosedManifold(mesh));
  EXPECT_EQ(eulerCharacteristic(mesh), GetParam().euler);
  EXPECT_EQ(selfIntersections(mesh), 0u);
  const double volume = solid->massProperties().volume;
  EXPECT_GT(volume, 0);
  EXPECT_NEAR(volumeOf(mesh) / volume, 1, 1e-5);
  const double expected = GetParam().volume > 0 ? GetParam().volume : volume;
  EXPECT_NEAR(volume / expected, 1, GetParam().tolerance);
}

INSTANTIATE_TEST_SUITE_P(All, SolidsGenerated, testing::ValuesIn(generated()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(SolidsOracle, SeesMeshesThatCutThemselves) {
  Mesh mesh = boxMesh();
  append(mesh, boxMesh({0.2, 0.2, 0.2}, {1.2, 1.3, 1.4}));
  EXPECT_GT(selfIntersections(mesh), 0u);
  EXPECT_EQ(selfIntersections(boxMesh()), 0u);
}

// Each vertex of one thread is out of the other part, and no farther from it than the clearance.
TEST(SolidsNamed, NutFitsOnTheBoltWhereverTheThreadLetsIt) {
  const auto nut = makeNamedSolid("nut");
  const auto bolt = makeNamedSolid("bolt");
  const Mesh nut_mesh = nutMesh();
  for (const double height : {0.0, 0.03, 0.125, 0.2, 0.3}) {
    const double angle = 2 * kPi * height / 0.125;
    const double c = std::cos(angle), s = std::sin(angle);
    double nearest = 1, farthest = 0;
    for (const Vec3d& v : nut_mesh.vertices) {
      const double radius = std::hypot(v[0], v[1]);
      if (radius > 0.32 || v[2] < 0.01 || v[2] > 0.36) continue;
      const Vec3d p{c * v[0] - s * v[1], s * v[0] + c * v[1], v[2] + height};
      EXPECT_FALSE(bolt->contains(p));
      const double distance = bolt->closestPoint(p).distance;
      nearest = std::min(nearest, distance);
      farthest = std::max(farthest, distance);
    }
    EXPECT_GT(nearest, 0.003) << height;
    EXPECT_LT(farthest, 0.012) << height;
  }
  // Half a pitch off, the threads cut each other.
  int inside = 0;
  for (const Vec3d& v : nut_mesh.vertices) inside += bolt->contains({v[0], v[1], v[2] + 0.0625});
  EXPECT_GT(inside, 100);
}

// The wedges stay apart at the saddle, so its middle is inside, and each wedge is open.
TEST(SolidsNamed, ChazelleIsSolidOnTheSaddleAndOpenInTheWedges) {
  const auto solid = makeNamedSolid("chazelle");
  for (double x = -0.45; x < 0.5; x += 0.05) {
    for (double y = -0.45; y < 0.5; y += 0.05) EXPECT_TRUE(solid->contains({x, y, 1.2 * x * y}));
  }
  for (const double x : {-0.3, -0.1, 0.1, 0.3}) {
    for (double y = -0.45; y < 0.5; y += 0.1) {
      EXPECT_FALSE(solid->contains({x, y, 1.2 * x * y - 0.041}));
      EXPECT_FALSE(solid->contains({y, x, 1.2 * x * y + 0.041}));
    }
  }
}

TEST(SolidsNamed, EveryNameMakesASolidOfThatName) {
  for (const std::string& name : namedSolids()) {
    const auto solid = makeNamedSolid(name);
    EXPECT_EQ(solid->name(), name);
    EXPECT_GT(solid->massProperties().volume, 0) << name;
    EXPECT_FALSE(solid->hash().empty()) << name;
    const Bounds box = solid->bounds();
    const Vec3d size = box.max - box.min;
    const double longest = *std::max_element(size.begin(), size.end());
    EXPECT_LE(longest, 2.01) << name;
    EXPECT_GE(longest, 0.5) << name;
  }
}

TEST(SolidsNamed, UnknownNameListsTheKnownOnes) {
  try {
    makeNamedSolid("teapot");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    EXPECT_NE(std::string(error.what()).find("lbracket"), std::string::npos);
  }
}

}  // namespace
}  // namespace innersphere::test
