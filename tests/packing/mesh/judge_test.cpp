// What is wrong with a mesh: found, named, mended where that is safe, refused where not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "mesh_oracles.hpp"
#include "mesh_shapes.hpp"

namespace innersphere::test {
namespace {

std::string joined(const MeshReport& report) {
  std::string all;
  for (const std::string& note : report.notes) all += note + "\n";
  return all;
}

void expectRefused(const Mesh& mesh, const std::string& hint, MeshReport* report = nullptr) {
  try {
    makeSolid(mesh, "thing", {}, report);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::not_a_solid);
    EXPECT_NE(std::string(error.what()).find(hint), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("thing"), std::string::npos) << error.what();
  }
}

std::unique_ptr<Solid> repaired(const Mesh& mesh, MeshReport* report = nullptr) {
  MeshOptions options;
  options.repair = true;
  return makeSolid(mesh, "thing", options, report);
}

TEST(MeshJudge, OpenEdgesAreCountedAndPlaced) {
  Mesh mesh = boxMesh({-1, -1, -1}, {1, 1, 1});
  mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);  // the top, 8 m around
  append(mesh, boxMesh({3, 0, 0}, {4, 1, 1}));
  mesh.triangles.pop_back();  // a smaller hole
  MeshReport report;
  expectRefused(mesh, "7 open edges in 2 loops", &report);
  EXPECT_EQ(report.open_edges, 7u);
  EXPECT_EQ(report.open_loops, 2u);
  EXPECT_EQ(report.components, 2u);
  EXPECT_EQ(report.open_at[2], 1);
  EXPECT_EQ(std::abs(report.open_at[0]), 1);
}

TEST(MeshJudge, RepairClosesTheHole) {
  Mesh mesh = boxMesh({-1, -1, -1}, {1, 1, 1});
  mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);
  MeshReport report;
  const auto solid = repaired(mesh, &report);
  EXPECT_NE(joined(report).find("1 hole"), std::string::npos) << joined(report);
  EXPECT_NEAR(solid->massProperties().volume, 8, 1e-12);
  EXPECT_TRUE(solid->contains({0, 0, 0.99}));
  EXPECT_FALSE(solid->contains({0, 0, 1.01}));
  EXPECT_NEAR(solid->closestPoint({0.3, 0.2, 0.9}).distance, 0.1, 1e-15);
}

// The ends of a pipe are rings, not one lid over another.
TEST(MeshJudge, RepairLeavesThePipeOpen) {
  constexpr int kOuter = 12, kInner = 7;
  Mesh mesh;
  const auto wall = [&](int n, double radius, bool outwards) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      for (double z : {0.0, 3.0})
        mesh.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
    for (int i = 0; i < n; ++i) {
      const std::uint32_t a = first + 2 * i, b = first + 2 * ((i + 1) % n);
      for (std::array<std::uint32_t, 3> t : {std::array{a, b, b + 1}, std::array{a, b + 1, a + 1}}) {
        if (!outwards) std::swap(t[0], t[1]);
        mesh.triangles.push_back(t);
      }
    }
    return 0.5 * n * radius * radius * std::sin(2 * std::numbers::pi / n);
  };
  const double ring = wall(kOuter, 1, true) - wall(kInner, 0.5, false);
  expectRefused(mesh, "38 open edges in 4 loops");
  MeshReport report;
  const auto solid = repaired(mesh, &report);
  EXPECT_NE(joined(report).find("4 holes closed with 38 triangles"), std::string::npos) << joined(report);
  EXPECT_NEAR(solid->massProperties().volume, 3 * ring, 1e-12);
  EXPECT_NEAR(solid->closestPoint({0, 0, 2.99}).distance, 0.5 * std::cos(std::numbers::pi / kInner), 1e-12);
  EXPECT_NEAR(solid->closestPoint({0, 0.75, 2.9}).distance, 0.1, 1e-12);
  EXPECT_TRUE(solid->contains({0, 0.75, 2.9}));
  EXPECT_FALSE(solid->contains({0, 0, 2.9}));
}

// Parts of a mesh that were refined for themselves: one has vertices on the edges of the other.
TEST(MeshJudge, AVertexOnAnEdgeIsNoHole) {
  Mesh mesh = boxMesh({-1, -1, -1}, {1, 1, 1});
  const auto vertex = [&](std::uint32_t a, std::uint32_t b, double part) {
    mesh.vertices.push_back(mesh.vertices[a] + part * (mesh.vertices[b] - mesh.vertices[a]));
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  };
  for (Vec3d& v : mesh.vertices) v = {0.6 * v[0] - 0.8 * v[1], 0.8 * v[0] + 0.6 * v[1], v[2]};
  // Two neighbours of triangle {3, 7, 5}.
  std::erase(mesh.triangles, std::array<std::uint32_t, 3>{5, 7, 6});
  std::erase(mesh.triangles, std::array<std::uint32_t, 3>{1, 3, 5});
  const std::uint32_t p = vertex(5, 7, 1.0 / 3), q = vertex(3, 5, 0.1), r = vertex(3, 5, 1 / 1.1);
  mesh.triangles.insert(mesh.triangles.end(), {{5, p, 6}, {p, 7, 6}, {1, 3, q}, {1, q, r}, {1, r, 5}});
  MeshReport report;
  const auto solid = makeSolid(mesh, "thing", {}, &report);
  EXPECT_NE(joined(report).find("2 edges split"), std::string::npos) << joined(report);
  EXPECT_NEAR(solid->massProperties().volume, 8, 1e-12);
  EXPECT_EQ(solid->surface().triangles.size(), 12u + 3 + 3);
}

// Three boxes that share no vertex and cut each other: after repair a point counts once however often it is
// enclosed.
TEST(MeshJudge, RepairCountsOverlapsOnce) {
  Mesh mesh = boxMesh({0, 0, 0}, {2, 1, 1});
  append(mesh, boxMesh({1, 0.25, 0.25}, {3, 0.75, 0.75}));
  append(mesh, boxMesh({0.5, 0.5, 0.5}, {1, 1.5, 1.5}));
  mesh.triangles.pop_back();
  const auto solid = repaired(mesh);
  EXPECT_NEAR(solid->massProperties().volume, 2 + 0.25 + 0.5 * (1 - 0.25), 0.02);
  std::mt19937 random(31);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3d p = randomPoint(random, {-0.2, -0.2, -0.2}, {3.2, 1.7, 1.7});
    const auto in = [&](const Vec3d& low, const Vec3d& high) {
      for (int k = 0; k < 3; ++k) {
        if (p[k] <= low[k] || p[k] >= high[k]) return false;
      }
      return true;
    };
    EXPECT_EQ(solid->contains(p), in({0, 0, 0}, {2, 1, 1}) || in({1, 0.25, 0.25}, {3, 0.75, 0.75}) ||
                                      in({0.5, 0.5, 0.5}, {1, 1.5, 1.5}));
  }
}

TEST(MeshJudge, ShellsThatCutEachOtherAreNamedAndCountOnce) {
  Mesh mesh = boxMesh({0, 0, 0}, {2, 1, 1});
  append(mesh, boxMesh({1, 0.25, 0.25}, {3, 0.75, 0.75}));
  MeshReport report;
  const auto solid = makeSolid(mesh, "cross", {}, &report);
  EXPECT_GT(report.cuts, 0u);
  EXPECT_NE(joined(report).find("cut each other"), std::string::npos) << joined(report);
  EXPECT_NEAR(solid->massProperties().volume, 2.25, 0.01);
  EXPECT_TRUE(solid->contains({1.5, 0.5, 0.5}));
  EXPECT_NEAR(solid->closestPoint({1.5, 0.5, 0.5}).distance, 0.25, 1e-15);
}

// Their faces touch in planes, so no triangle passes through another.
TEST(MeshJudge, FlushOverlapsCountOnceToo) {
  Mesh mesh = boxMesh({0, 0, 0}, {2, 1, 1});
  append(mesh, boxMesh({1, 0, 0}, {3, 1, 1}));
  MeshReport report;
  const auto solid = makeSolid(mesh, "flush", {}, &report);
  EXPECT_EQ(report.cuts, 0u);
  EXPECT_NEAR(solid->massProperties().volume, 3, 0.05);
  EXPECT_NEAR(solid->massProperties().centre_of_mass[0], 1.5, 0.02);
  EXPECT_NE(joined(report).find("shells share 3"), std::string::npos) << joined(report);  // 1 of 3 m^3
}

TEST(MeshJudge, ShellsThatTouchShareNothing) {
  Mesh mesh = boxMesh({0, 0, 0}, {2, 1, 1});
  append(mesh, boxMesh({2, 0.25, 0.25}, {3, 0.75, 0.75}));
  MeshReport report;
  const auto solid = makeSolid(mesh, "beside", {}, &report);
  EXPECT_NEAR(solid->massProperties().volume, 2.25, 1e-12);
  EXPECT_EQ(joined(report), "");
}

TEST(MeshJudge, InsideOutIsTurned) {
  MeshReport report;
  const auto solid = makeSolid(inverted(torusMesh(1, 0.4, 24, 12)), "torus", {}, &report);
  EXPECT_TRUE(report.inside_out);
  EXPECT_NE(joined(report).find("inside-out"), std::string::npos);
  EXPECT_GT(solid->massProperties().volume, 0);
  EXPECT_TRUE(solid->contains({1, 0, 0}));
  EXPECT_FALSE(solid->contains({0, 0, 0}));
}

TEST(MeshJudge, FlippedTrianglesAreTurned) {
  Mesh mesh = torusMesh(1, 0.4, 24, 12);
  const double volume = volumeOf(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 5) {
    std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  }
  MeshReport report;
  const auto solid = makeSolid(mesh, "torus", {}, &report);
  EXPECT_GT(report.flipped_edges, 100u);
  EXPECT_FALSE(report.inside_out);
  EXPECT_NEAR(solid->massProperties().volume, volume, 1e-12);
}

TEST(MeshJudge, MoebiusAndKleinAreRefused) {
  // A Klein bottle: a torus grid whose last column is joined to the first upside down.
  constexpr int n = 12, m = 8;
  Mesh mesh;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / m;
      mesh.vertices.push_back(
          {std::cos(u) * (2 + std::cos(v)), std::sin(u) * (2 + std::cos(v)), std::sin(v) + 0.1 * u});
    }
  }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>(i < n ? i * m + j % m : (2 * m - j) % m);
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  expectRefused(mesh, "one side");
}

TEST(MeshJudge, CavityStaysHollow) {
  Mesh mesh = boxMesh({-2, -2, -2}, {2, 2, 2});
  append(mesh, inverted(boxMesh({-1, -1, -1}, {1, 1, 1})));
  append(mesh, boxMesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));  // a loose part in the cavity
  for (const bool turn_all : {false, true}) {
    MeshReport report;
    const auto solid = makeSolid(turn_all ? inverted(mesh) : mesh, "hollow", {}, &report);
    EXPECT_EQ(report.components, 3u);
    EXPECT_EQ(report.inside_out, turn_all);
    EXPECT_NE(joined(report).find("hollow"), std::string::npos) << joined(report);
    EXPECT_NEAR(solid->massProperties().volume, 64 - 8 + 1, 1e-12);
    EXPECT_TRUE(solid->contains({0, 0, 0}));
    EXPECT_FALSE(solid->contains({0.75, 0, 0}));
    EXPECT_TRUE(solid->contains({1.5, 0, 0}));
    EXPECT_NEAR(solid->closestPoint({1.4, 0, 0}).distance, 0.4, 1e-15);
  }
}

TEST(MeshJudge, OneShellInsideOutAmongSeveral) {
  Mesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
  append(mesh, inverted(boxMesh({2, 0, 0}, {3, 1, 1})));
  MeshReport report;
  const auto solid = makeSolid(mesh, "pair", {}, &report);
  EXPECT_FALSE(report.inside_out);
  EXPECT_NE(joined(report).find("1 shell of 2"), std::string::npos) << joined(report);
  EXPECT_NEAR(solid->massProperties().volume, 2, 1e-12);
  EXPECT_TRUE(solid->contains({2.5, 0.5, 0.5}));
}

TEST(MeshJudge, ShellInsideMaterialIsDropped) {
  Mesh mesh = boxMesh({-2, -2, -2}, {2, 2, 2});
  append(mesh, boxMesh({-1, -1, -1}, {1, 1, 1}));
  MeshReport report;
  const auto solid = makeSolid(mesh, "nested", {}, &report);
  EXPECT_NE(joined(report).find("removed"), std::string::npos) << joined(report);
  EXPECT_NEAR(solid->massProperties().volume, 64, 1e-12);
  EXPECT_NEAR(solid->closestPoint({0, 0, 0}).distance, 2, 1e-15);
}

TEST(MeshJudge, ShellWithItsCornersInsideAnotherStays) {
  Mesh mesh = torusMesh(1, 0.3, 32, 16);
  append(mesh, boxMesh({-0.7, -0.7, -0.1}, {0.7, 0.7, 0.1}));  // a floor whose corners end in the wall
  MeshReport report;
  const auto solid = makeSolid(mesh, "tray", {}, &report);
  EXPECT_EQ(joined(report).find("removed"), std::string::npos) << joined(report);
  EXPECT_TRUE(solid->contains({0, 0, 0}));
}

TEST(MeshJudge, DegenerateTrianglesGo) {
  Mesh mesh = boxMesh();
  mesh.triangles.push_back({0, 0, 1});
  mesh.vertices.push_back(mesh.vertices[3]);
  mesh.triangles.push_back({3, 8, 1});  // collapses once equal positions are welded
  MeshReport report;
  const auto solid = makeSolid(mesh, "box", {}, &report);
  EXPECT_EQ(report.degenerate, 2u);
  EXPECT_EQ(report.triangles, 12u);
  EXPECT_EQ(report.vertices, 8u);
  EXPECT_NEAR(solid->massProperties().volume, 1, 1e-14);
}

TEST(MeshJudge, TrianglesThatAreThereTwiceCountOnce) {
  Mesh twice = boxMesh();
  append(twice, boxMesh());  // with vertices of their own
  for (std::size_t t = 12; t < 24; ++t) {
    auto& corners = twice.triangles[t];
    std::rotate(corners.begin(), corners.begin() + 1, corners.end());
  }
  MeshReport report;
  const auto solid = makeSolid(twice, "box", {}, &report);
  EXPECT_EQ(report.duplicates, 12u);
  EXPECT_NE(joined(report).find("12 triangles removed that are there more than once"), std::string::npos)
      << joined(report);
  EXPECT_NEAR(solid->massProperties().volume, 1, 1e-14);
}

TEST(MeshJudge, MeshesForBothSidesLoseOne) {
  Mesh both = boxMesh();
  append(both, inverted(boxMesh()));
  std::mt19937 random(33);
  std::shuffle(both.triangles.begin(), both.triangles.end(), random);
  MeshReport report;
  const auto solid = makeSolid(both, "box", {}, &report);
  EXPECT_EQ(report.duplicates, 12u);
  EXPECT_NE(joined(report).find("faces the other way"), std::string::npos) << joined(report);
  EXPECT_NEAR(solid->massProperties().volume, 1, 1e-14);
  EXPECT_TRUE(solid->contains({0, 0, 0}));
}

// The same surface twice, cut into triangles along the other diagonals: no triangle is there twice.
TEST(MeshJudge, SurfacesThatAreThereTwiceCountOnce) {
  Mesh twice = boxMesh(), other = boxMesh();
  for (std::size_t t = 0; t < 12; t += 2) {
    auto &a = other.triangles[t], &b = other.triangles[t + 1];
    std::set<std::uint32_t> corners(a.begin(), a.end());
    corners.insert(b.begin(), b.end());
    std::uint32_t apex_a = 0, apex_b = 0;
    for (std::uint32_t v : corners) {
      if (std::find(a.begin(), a.end(), v) == a.end()) apex_b = v;
      if (std::find(b.begin(), b.end(), v) == b.end()) apex_a = v;
    }
    while (a[0] != apex_a) std::rotate(a.begin(), a.begin() + 1, a.end());
    const std::uint32_t from = a[1], to = a[2];
    a = {apex_a, from, apex_b};
    b = {apex_a, apex_b, to};
  }
  append(twice, other);
  const auto solid = makeSolid(twice, "box");
  EXPECT_NEAR(solid->massProperties().volume, 1, 0.05);
}

TEST(MeshJudge, BodiesAreSplitWithTheirCavities) {
  Mesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
  append(mesh, inverted(boxMesh({5.25, 0.25, 0.25}, {5.75, 0.75, 0.75})));
  append(mesh, boxMesh({5, 0, 0}, {6, 1, 1}));
  append(mesh, boxMesh({5.4, 0.4, 0.4}, {5.6, 0.6, 0.6}));  // loose in the hollow
  const auto bodies = splitBodies(makeSolid(mesh, "three")->surface());
  ASSERT_EQ(bodies.size(), 3u);
  EXPECT_NEAR(volumeOf(bodies[0]), 1, 1e-12);
  EXPECT_NEAR(volumeOf(bodies[1]), 1 - 0.125, 1e-12);
  EXPECT_NEAR(volumeOf(bodies[2]), 0.008, 1e-12);
  for (const Mesh& body : bodies) EXPECT_TRUE(isClosedManifold(body));
}

// Corners that differ in the last digits are welded only because the mesh is open otherwise.
TEST(MeshJudge, NearlyEqualCornersAreWeldedIfOpen) {
  Mesh split;
  const Mesh box = boxMesh();
  std::mt19937 random(32);
  for (const auto& t : box.triangles) {
    for (std::uint32_t v : t) {
      Vec3d p = box.vertices[v];
      for (double& x : p) x += std::uniform_real_distribution<double>(-1e-8, 1e-8)(random);
      split.vertices.push_back(p);
    }
    const auto n = static_cast<std::uint32_t>(split.vertices.size());
    split.triangles.push_back({n - 3, n - 2, n - 1});
  }
  MeshReport report;
  const auto solid = makeSolid(split, "box", {}, &report);
  EXPECT_EQ(report.vertices, 8u);
  EXPECT_NE(joined(report).find("merged"), std::string::npos) << joined(report);
  EXPECT_NEAR(solid->massProperties().volume, 1, 1e-6);
}

// Triangles that share no vertex, as of a file with few digits.
TEST(MeshJudge, RepairWeldsWhatIsNearlyClosed) {
  const Mesh torus = torusMesh(1, 0.3, 40, 20);
  const double diagonal = 2 * std::sqrt(2 * 1.3 * 1.3 + 0.3 * 0.3);
  std::mt19937 random(41);
  for (const double part : {1e-6, 1e-5, 4e-5}) {
    Mesh split;
    for (const auto& t : torus.triangles) {
      for (std::uint32_t v : t) {
        const double way =
            part * diagonal / 4;  // of each coordinate, so that none are farther apart than 0.87 parts
        split.vertices.push_back(torus.vertices[v] +
                                 randomPoint(random, {-way, -way, -way}, {way, way, way}));
      }
      const auto n = static_cast<std::uint32_t>(split.vertices.size());
      split.triangles.push_back({n - 3, n - 2, n - 1});
      if (n % 2 == 0) std::swap(split.triangles.back()[0], split.triangles.back()[1]);
    }
    expectRefused(split, "ask for repair: vertices within 0.0003726 m");
    MeshReport report;
    const auto solid = repaired(split, &report);
    EXPECT_EQ(report.vertices, torus.vertices.size()) << joined(report);
    EXPECT_EQ(report.open_edges, 0u);
    EXPECT_NEAR(solid->massProperties().volume / volumeOf(torus), 1, 20 * part);
    // A hole beside is still one, and what is farther apart is not welded.
    split.triangles.pop_back();
    repaired(split, &report);
    EXPECT_EQ(report.open_edges, 3u) << joined(report);
  }
  Mesh gap = boxMesh();  // its top is as high above its sides as two walls may be apart
  for (auto& t : gap.triangles) {
    const bool is_top = std::all_of(t.begin(), t.end(), [&](auto v) { return gap.vertices[v][2] > 0; });
    for (std::uint32_t& v : t) {
      if (!is_top) continue;
      gap.vertices.push_back(gap.vertices[v] + Vec3d{0, 0, 4e-4});
      v = static_cast<std::uint32_t>(gap.vertices.size() - 1);
    }
  }
  MeshReport report;
  expectRefused(gap, "8 open edges", &report);
  repaired(gap, &report);
  EXPECT_EQ(report.open_edges, 8u) << joined(report);
}

TEST(MeshJudge, TouchingSolidsAreNamedNotRefused) {
  Mesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
  append(mesh, boxMesh({1, 1, 0}, {2, 2, 1}));  // they share an edge
  MeshReport report;
  const auto solid = makeSolid(mesh, "steps", {}, &report);
  EXPECT_EQ(report.non_manifold_edges, 1u);
  EXPECT_NEAR(solid->massProperties().volume, 2, 1e-12);
  EXPECT_TRUE(solid->contains({1.001, 1.001, 0.5}));
  EXPECT_FALSE(solid->contains({1.001, 0.999, 0.5}));
}

TEST(MeshJudge, FinOnAnEdgeIsRefused) {
  Mesh mesh = boxMesh();
  mesh.vertices.push_back({2, 0, 0});
  mesh.triangles.push_back({1, 3, 8});
  MeshReport report;
  expectRefused(mesh, "open edge", &report);
  EXPECT_EQ(report.non_manifold_edges, 1u);
  EXPECT_NEAR(repaired(mesh)->massProperties().volume, 1, 1e-6);
}

TEST(MeshJudge, SheetsEncloseNothing) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
  expectRefused(mesh, "no volume");
  expectRefused(boxMesh({0, 0, 0}, {1, 1, 1e-14}), "no volume");
}

// 1e7 and 1e7 + 1 are numbers of single precision, whoever has written them; 1e7 + 0.1 is none.
TEST(MeshJudge, PlacesThatSinglePrecisionMayHaveSpoiltAreNoted) {
  const auto notes = [](double x) {
    MeshReport report;
    makeSolid(boxMesh({x, x, x}, {x + 1, x + 1, x + 1}), "box", {}, &report);
    return report.notes;
  };
  ASSERT_EQ(notes(1e7).size(), 1u);
  EXPECT_NE(notes(1e7)[0].find("its numbers are those of single precision"), std::string::npos)
      << notes(1e7)[0];
  EXPECT_TRUE(notes(1e7 + 0.1).empty());
}

TEST(MeshJudge, OddUnitsAreNoted) {
  const auto noted = [](double size) {
    MeshReport report;
    makeSolid(boxMesh({0, 0, 0}, {size, size, size}), "box", {}, &report);
    return !report.notes.empty();
  };
  EXPECT_TRUE(noted(150));
  EXPECT_TRUE(noted(0.001));
  EXPECT_FALSE(noted(1));
  EXPECT_FALSE(noted(0.03));
}

TEST(MeshJudge, NothingUsable) {
  const auto codeOf = [](const Mesh& mesh) {
    try {
      makeSolid(mesh, "thing");
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::cancelled;
  };
  EXPECT_EQ(codeOf({}), ErrorCode::empty_input);
  EXPECT_EQ(codeOf({{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 1}}}), ErrorCode::empty_input);
  EXPECT_EQ(codeOf({{{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}}, {{0, 1, 2}}}), ErrorCode::not_finite);
  EXPECT_EQ(codeOf({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}}), ErrorCode::bad_argument);
}

}  // namespace
}  // namespace innersphere::test
