// Distance, sign and mass properties of mesh solids against brute force and closed forms.
#include <gtest/gtest.h>

#include <thread>

#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "mesh/closest_triangle.hpp"
#include "mesh/triangle.hpp"
#include "mesh/winding_tree.hpp"
#include "mesh_shapes.hpp"

namespace innersphere::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Nearest point of a triangle by projecting onto the plane, then onto the edges, in long double.
long double slowDistance(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  using V = std::array<long double, 3>;
  const auto sub = [](const V& x, const V& y) { return V{x[0] - y[0], x[1] - y[1], x[2] - y[2]}; };
  const auto mul = [](const V& x, const V& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; };
  const auto vec = [](const V& x, const V& y) {
    return V{x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
  };
  const auto wide = [](const Vec3d& x) { return V{x[0], x[1], x[2]}; };
  const std::array<V, 3> corner{wide(a), wide(b), wide(c)};
  const V q = wide(p);
  const V n = vec(sub(corner[1], corner[0]), sub(corner[2], corner[0]));
  long double best = INFINITY;
  bool over = mul(n, n) > 0;
  for (int k = 0; k < 3; ++k) {
    const V& from = corner[k];
    const V edge = sub(corner[(k + 1) % 3], from);
    const V to = sub(q, from);
    over = over && mul(vec(n, edge), to) >= 0;
    long double t = mul(edge, edge) > 0 ? mul(to, edge) / mul(edge, edge) : 0;
    t = std::min(1.0L, std::max(0.0L, t));
    const V away = sub(to, V{t * edge[0], t * edge[1], t * edge[2]});
    best = std::min(best, std::sqrt(mul(away, away)));
  }
  if (over) best = std::min(best, std::abs(mul(n, sub(q, corner[0]))) / std::sqrt(mul(n, n)));
  return best;
}

TEST(MeshTriangle, DistanceMatchesLongDoubleAlsoForNeedles) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 20000; ++trial) {
    const Vec3d a = randomPoint(random, {-1, -1, -1}, {1, 1, 1});
    Vec3d b = randomPoint(random, {-1, -1, -1}, {1, 1, 1});
    Vec3d c = randomPoint(random, {-1, -1, -1}, {1, 1, 1});
    // Every third triangle is thin, down to a line.
    if (trial % 3 == 0) {
      const double width = std::pow(10.0, -(trial / 3 % 18));
      for (int k = 0; k < 3; ++k) c[k] = a[k] + 0.6 * (b[k] - a[k]) + width * c[k];
    }
    const Vec3d p = randomPoint(random, {-2, -2, -2}, {2, 2, 2});
    Vec3d point;
    const double found = std::sqrt(Triangle(a, b, c).closest(p, point));
    EXPECT_NEAR(found, static_cast<double>(slowDistance(p, a, b, c)), 1e-12) << "trial " << trial;
    EXPECT_NEAR(static_cast<double>(slowDistance(point, a, b, c)), 0, 1e-12) << "trial " << trial;
  }
}

// Far from the origin, tiny, and far-away queries, needles, and trees of a leaf that is not full: the tree's
// floats must never decide.
TEST(MeshTree, EqualsBruteForceBitForBit) {
  std::mt19937 random(2);
  for (const double scale : {1.0, 1e-3, 1e5}) {
    for (const double shift : {0.0, 1000.0}) {
      for (const std::size_t count : {1, 3, 4, 6, 19, 1000}) {
        Mesh mesh = torusMesh(1, 0.4, 24, 12);
        append(mesh, boxMesh({-3, -0.2, -0.2}, {-2, 0.2, 0.2}));
        for (int needle = 0; needle < 30; ++needle) {
          const Vec3d from = randomPoint(random, {-2, -2, -2}, {2, 2, 2}),
                      to = randomPoint(random, {-2, -2, -2}, {2, 2, 2});
          const double width = std::pow(10.0, -needle);
          const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
          mesh.vertices.insert(mesh.vertices.end(),
                               {from, to, from + 0.3 * (to - from) + width * Vec3d{1, 2, 3}});
          mesh.triangles.push_back({first, first + 1, first + 2});
        }
        std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
        mesh.triangles.resize(std::min(mesh.triangles.size(), count));
        for (Vec3d& v : mesh.vertices) {
          for (double& x : v) x = scale * (x + shift);
        }
        const ClosestTriangle tree(mesh);
        std::vector<Triangle> triangles;
        for (const auto& t : mesh.triangles) {
          triangles.emplace_back(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
        }
        for (int trial = 0; trial < 600; ++trial) {
          const double reach = trial % 10 == 0 ? 1000 : 2;
          Vec3d p = randomPoint(random, {-reach, -reach, -reach}, {reach, reach, reach});
          if (trial % 7 == 0) p = {0, 0, 0.1 * (trial % 5)};  // as far from many triangles at once
          for (double& x : p) x = scale * (x + shift);
          double best2 = kInfinity;
          Vec3d best{};
          for (const Triangle& triangle : triangles) {
            Vec3d point;
            const double d2 = triangle.closest(p, point);
            if (d2 < best2) {
              best2 = d2;
              best = point;
            }
          }
          const double exact = std::sqrt(best2);
          const ClosestPoint all = tree.closest(p, kInfinity);
          EXPECT_EQ(all.distance, exact);
          EXPECT_EQ(all.point, best);
          EXPECT_EQ(tree.closest(p, exact).distance, exact);
          EXPECT_EQ(tree.closest(p, exact).point, best);
          EXPECT_EQ(tree.closest(p, std::nextafter(exact, 0.0)).distance, kInfinity);
          EXPECT_EQ(tree.closest(p, 3 * exact).point, best);
        }
      }
    }
  }
}

// From places on a surface, to both sides: no triangle reaches into the ball, but one into any that is
// larger.
TEST(MeshTree, EmptyBallsAreAsLargeAsMayBe) {
  constexpr double kLeast = 0.01, kMost = 0.7;
  std::mt19937 random(4);
  for (const double scale : {1.0, 1e5}) {
    Mesh mesh = torusMesh(1, 0.4, 24, 12);
    append(mesh, boxMesh({-3, -0.2, -0.2}, {-2, 0.2, 0.2}));
    append(mesh, boxMesh({-2, -0.2, 0.3}, {2, 0.2, 0.35}));
    for (Vec3d& v : mesh.vertices) v = scale * v;
    const ClosestTriangle tree(mesh);
    const auto distance = [&](const Vec3d& p) {
      double least2 = kInfinity;
      for (const auto& t : mesh.triangles) {
        Vec3d point;
        const Triangle triangle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
        least2 = std::min(least2, triangle.closest(p, point));
      }
      return std::sqrt(least2);
    };
    int none = 0, between = 0, whole = 0;
    for (int trial = 0; trial < 600; ++trial) {
      const Vec3d p =
          randomPoint(random, {-3 * scale, -1.5 * scale, -scale}, {2 * scale, 1.5 * scale, scale});
      const Vec3d at = tree.closest(p, kInfinity).point;
      const Vec3d away = at - p;
      const Vec3d side = ((trial % 2 == 0 ? 1 : -1) / norm(away)) * away;
      const double radius = tree.emptyRadius(at, side, kLeast * scale, kMost * scale);
      if (radius == 0) {
        ++none;
        EXPECT_LT(distance(at + kLeast * scale * side), kLeast * scale);
        continue;
      }
      EXPECT_GE(radius, kLeast * scale);
      EXPECT_GE(distance(at + radius * side), (1 - 2e-6) * radius);
      if (radius == kMost * scale) {
        ++whole;
      } else {
        ++between;
        const double larger = 1.00001 * radius;
        EXPECT_LT(distance(at + larger * side), larger * (1 - 1e-9));
      }
    }
    EXPECT_GT(none, 20);
    EXPECT_GT(between, 20);
    EXPECT_GT(whole, 20);
  }
}

TEST(MeshTree, TheDistanceIsToTheReturnedPoint) {
  const auto solid = makeSolid(torusMesh(1, 0.4, 40, 20), "torus");
  std::mt19937 random(3);
  for (int trial = 0; trial < 1000; ++trial) {
    const Vec3d p = randomPoint(random, {-2, -2, -1}, {2, 2, 1});
    const ClosestPoint c = solid->closestPoint(p);
    EXPECT_NEAR(c.distance, std::hypot(c.point[0] - p[0], c.point[1] - p[1], c.point[2] - p[2]), 1e-14);
  }
}

TEST(MeshSign, MatchesTheClosedFormOfABox) {
  const auto solid = makeSolid(boxMesh({-1, -2, -3}, {1, 2, 3}), "box");
  std::mt19937 random(4);
  for (int trial = 0; trial < 5000; ++trial) {
    Vec3d p = randomPoint(random, {-2, -3, -4}, {2, 3, 4});
    const Vec3d half{1, 2, 3};
    // Every other point a hair off a face.
    if (trial % 2) p[trial / 2 % 3] = half[trial / 2 % 3] * (1 + (trial % 4 == 1 ? 1e-12 : -1e-12));
    bool inside = true;
    for (int k = 0; k < 3; ++k) inside = inside && std::abs(p[k]) < half[k];
    EXPECT_EQ(solid->contains(p), inside) << p[0] << " " << p[1] << " " << p[2];
  }
}

// The tree's dipoles must stay far from turning a sign, and the sign must equal that of the exact sum.
TEST(MeshSign, WindingTreeIsCloseToTheExactSum) {
  Mesh mesh = torusMesh(1, 0.4, 48, 24);
  append(mesh, inverted(torusMesh(1, 0.2, 48, 24)));
  const WindingTree tree(mesh);
  std::mt19937 random(5);
  double worst = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3d p = randomPoint(random, {-1.5, -1.5, -0.5}, {1.5, 1.5, 0.5});
    double exact = 0;
    for (const auto& t : mesh.triangles) {
      exact += windingNumber(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    }
    worst = std::max(worst, std::abs(tree.windingNumber(p) - exact));
  }
  EXPECT_LT(worst, 0.2);
}

// Mostly the nearest triangle tells the side. Where parts cut, touch or hold each other it may not.
TEST(MeshSign, MatchesTheExactSumWherePartsMeet) {
  const Mesh box = boxMesh({0, 0, 0}, {1, 1, 1});
  Mesh cut = torusMesh(1, 0.4, 24, 12), split = box;
  append(cut, boxMesh({0.3, -0.2, -0.3}, {1.9, 0.9, 0.2}));
  split.vertices[split.triangles[0][0]] = {0.4, 0.45, 0.55};  // a dent with sharp edges
  std::vector<Mesh> meshes{cut, split, torusMesh(1, 0.4, 24, 12)};
  for (const Vec3d& low : {Vec3d{1, 0, 0}, Vec3d{1, 0.3, 0.2}, Vec3d{1, 1, 0}, Vec3d{1, 1, 1},
                           Vec3d{0.5, 0, 0}, Vec3d{0.5, 0.5, 0.5}, Vec3d{1 + 1e-11, 0.2, 0}}) {
    meshes.push_back(box);
    append(meshes.back(), boxMesh(low, low + Vec3d{1, 1, 1}));
  }
  meshes.push_back(boxMesh({0, 0, 0}, {3, 3, 3}));
  append(meshes.back(), inverted(boxMesh({1, 1, 1}, {2, 2, 2})));
  append(meshes.back(), boxMesh({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}));

  std::mt19937 random(7);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const Mesh& mesh = meshes[i];
    const auto solid = makeSolid(mesh, "parts");
    const Mesh surface = solid->surface();
    const Bounds box_around = solid->bounds();
    for (int trial = 0; trial < 3000; ++trial) {
      Vec3d p = randomPoint(random, box_around.min, box_around.max);
      if (trial % 4 != 0) {
        // Near a triangle, half of the times near one of its edges, and far more often than not nearer than
        // it is long.
        const auto& t = surface.triangles[random() % surface.triangles.size()];
        const Vec3d u = randomPoint(random, {0, 0, 0}, {1, 1, 1});
        const double b = u[0] * u[1], c = trial % 2 ? 0 : u[0] - b;
        const Vec3d &corner = surface.vertices[t[0]], ab = surface.vertices[t[1]] - corner,
                    ac = surface.vertices[t[2]] - corner;
        p = corner + b * ab + c * ac +
            std::pow(10, -7 * u[2]) * randomPoint(random, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
      }
      if (solid->closestPoint(p).distance < 1e-9) continue;
      double exact = 0;
      for (const auto& t : surface.triangles)
        exact += windingNumber(p, surface.vertices[t[0]], surface.vertices[t[1]], surface.vertices[t[2]]);
      EXPECT_EQ(solid->contains(p), exact > 0.5)
          << "mesh " << i << ": " << p[0] << " " << p[1] << " " << p[2];
    }
  }
}

TEST(MeshMass, BoxAndFarBox) {
  for (const double shift : {0.0, 1e4}) {
    const auto solid = makeSolid(boxMesh({shift, shift, shift}, {shift + 1, shift + 2, shift + 3}), "box");
    const MassProperties mass = solid->massProperties();
    EXPECT_NEAR(mass.volume, 6, 1e-11);
    EXPECT_NEAR(mass.centre_of_mass[0], shift + 0.5, 1e-11);
    EXPECT_NEAR(mass.centre_of_mass[1], shift + 1.0, 1e-11);
    EXPECT_NEAR(mass.centre_of_mass[2], shift + 1.5, 1e-11);
    EXPECT_NEAR(mass.inertia[0], 0.5 * (4 + 9), 1e-10);
    EXPECT_NEAR(mass.inertia[4], 0.5 * (1 + 9), 1e-10);
    EXPECT_NEAR(mass.inertia[8], 0.5 * (1 + 4), 1e-10);
    EXPECT_NEAR(mass.inertia[1], 0, 1e-10);
    EXPECT_NEAR(mass.inertia[5], 0, 1e-10);
  }
}

// Products of inertia have a sign that a symmetric solid does not show: the tetrahedron 0, x, y, z.
TEST(MeshMass, TetrahedronHasTheKnownProducts) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const MassProperties mass = makeSolid(mesh, "corner")->massProperties();
  EXPECT_NEAR(mass.volume, 1.0 / 6, 1e-15);
  EXPECT_NEAR(mass.centre_of_mass[2], 0.25, 1e-15);
  EXPECT_NEAR(mass.inertia[0], 2 * (1.0 / 60 - 1.0 / 96), 1e-15);
  EXPECT_NEAR(mass.inertia[1], -(1.0 / 120 - 1.0 / 96), 1e-15);
}

TEST(MeshSolid, QueriesFromManyThreadsAgree) {
  const auto solid = makeSolid(torusMesh(1, 0.4, 60, 30), "torus");
  const auto sum = [&](double& out) {
    std::mt19937 random(6);
    for (int i = 0; i < 3000; ++i) {
      const Vec3d p = randomPoint(random, {-2, -2, -1}, {2, 2, 1});
      out += solid->closestPoint(p).distance * (solid->contains(p) ? 1 : -1);
    }
  };
  std::array<double, 4> sums{};
  std::vector<std::thread> threads;
  for (double& out : sums) threads.emplace_back(sum, std::ref(out));
  for (std::thread& thread : threads) thread.join();
  for (double out : sums) EXPECT_EQ(out, sums[0]);
}

TEST(MeshSolid, HashFollowsTheGeometryNotTheWayItIsStored) {
  Mesh split;  // the same box with its own corners for each triangle
  const Mesh box = boxMesh();
  for (const auto& t : box.triangles) {
    for (std::uint32_t v : t) split.vertices.push_back(box.vertices[v]);
    const auto n = static_cast<std::uint32_t>(split.vertices.size());
    split.triangles.push_back({n - 3, n - 2, n - 1});
  }
  const std::string hash = makeSolid(box, "a")->hash();
  EXPECT_EQ(hash.size(), 16u);
  EXPECT_EQ(makeSolid(split, "b")->hash(), hash);
  EXPECT_NE(makeSolid(boxMesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.500001}), "c")->hash(), hash);
}

}  // namespace
}  // namespace innersphere::test
