// Bullet's own ways to collide, which scenes offer to compare with, are good ones.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include <LinearMath/btConvexHullComputer.h>

#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"
#include "scenes/convex_parts.hpp"
#include "scenes/scene.hpp"
#include "scenes/shapes.hpp"
#include "scenes/world.hpp"

namespace innersphere::test {
namespace {

// Six times the signed volume of what is below a face, summed over its fan of triangles.
double sixVolumes(const btConvexHullComputer& hull, int face) {
  const btConvexHullComputer::Edge* edge = &hull.edges[hull.faces[face]];
  const btVector3& first = hull.vertices[edge->getSourceVertex()];
  double sum = 0;
  for (edge = edge->getNextEdgeOfFace(); hull.vertices[edge->getTargetVertex()] != first;
       edge = edge->getNextEdgeOfFace()) {
    sum += double(
        first.dot(hull.vertices[edge->getSourceVertex()].cross(hull.vertices[edge->getTargetVertex()])));
  }
  return sum;
}

double volumeOf(const std::vector<Vec3d>& points) {
  std::vector<double> coordinates;
  for (const Vec3d& p : points) coordinates.insert(coordinates.end(), p.begin(), p.end());
  btConvexHullComputer hull;
  hull.compute(coordinates.data(), 3 * sizeof(double), static_cast<int>(points.size()), 0, 0);
  double sum = 0;
  for (int face = 0; face < hull.faces.size(); ++face) sum += sixVolumes(hull, face);
  return std::fabs(sum) / 6;
}

TEST(ConvexParts, ConvexSolidsAreOnePart) {
  EXPECT_EQ(demo::convexParts(*makeBox({1, 2, 3}), 1e-3).size(), 1u);
  EXPECT_EQ(demo::convexParts(*makeCylinder(1, 2), 1e-2).size(), 1u);
}

TEST(ConvexParts, ThoseOfATorusFillItWithLittleMore) {
  const double ring = 1, tube = 0.25, volume = 2 * M_PI * M_PI * ring * tube * tube;
  std::size_t last = 1;
  for (const double concavity : {0.03, 0.003}) {
    const auto parts = demo::convexParts(*makeTorus(ring, tube), concavity);
    double sum = 0;
    for (const auto& part : parts) sum += volumeOf(part);
    EXPECT_GT(parts.size(), last);
    EXPECT_GT(sum, 0.98 * volume);  // the surface is made of flat triangles
    EXPECT_LT(sum, (1 + 4 * concavity / tube) * volume);
    last = parts.size();
  }
}

TEST(BodyShape, AllOfThemHangInAChain) {
  for (const auto shape : {demo::BodyShape::packing, demo::BodyShape::gimpact, demo::BodyShape::spheres,
                           demo::BodyShape::convex}) {
    demo::SceneOptions options;
    options.bodies.shape = shape;
    options.spheres = 64;
    options.seconds = 0.25;
    const demo::ScenePlay play = demo::play(demo::sceneNamed("chain-hang"), options);
    EXPECT_EQ(play.world->solids().front().other == nullptr, shape == demo::BodyShape::packing);
    // Nothing would hold a link: it would fall by 0.31 m.
    for (std::size_t i = 1; i < play.recording.names.size(); ++i) {
      EXPECT_GT(play.recording.last(i).position[2], play.recording.first(i).position[2] - 0.26) << i;
    }
    EXPECT_GT(play.recording.steps.back().contacts, 0);
  }
}

// Packings of solids far from their origins have frames of their own.
TEST(BodyShape, AllOfThemStartWhereTheyDoWithAMeshAtItsOrigin) {
  const Mesh near = demo::prism(demo::gridOutline({0, 1, 3, 4}, {0, 1, 3}, {"###", "#.."}), 1);
  Mesh far = near;
  for (Vec3d& v : far.vertices) v = {v[0] + 4096, v[1] - 1024, v[2] + 512};
  for (const auto shape : {demo::BodyShape::packing, demo::BodyShape::gimpact, demo::BodyShape::spheres,
                           demo::BodyShape::convex}) {
    const auto started = [shape](const Mesh& mesh) {
      demo::SceneOptions options;
      options.bodies.shape = shape;
      options.solids = {makeSolid(mesh, "angle")};
      options.spheres = 64;
      options.seconds = 0.001;
      options.dt = 0.001;
      return demo::play(demo::sceneNamed("pile"), options);
    };
    const demo::ScenePlay expected = started(near), found = started(far);
    EXPECT_NE(found.world->solids().front().packing->origin, Vec3d{});
    ASSERT_EQ(found.world->bodies().size(), expected.world->bodies().size());
    for (std::size_t i = 0; i < expected.world->bodies().size(); ++i) {
      const auto boxOf = [i](const demo::ScenePlay& play) {
        std::array<btVector3, 2> box;
        play.world->bodies()[i].body->getAabb(box[0], box[1]);
        return box;
      };
      const auto a = boxOf(expected), b = boxOf(found);
      for (int side = 0; side < 2; ++side) EXPECT_LT(a[side].distance(b[side]), 0.01) << i;
    }
  }
}

TEST(BodyShape, PackingsMayComeFromElsewhere) {
  const auto packing = std::make_shared<const Packing>(pack(*makeTorus(1, 0.25), {.spheres = 128}));
  demo::SceneOptions options;
  options.bodies.packing = [&](const Solid&, std::size_t, const Progress&) { return packing; };
  options.spheres = 64;
  options.seconds = 0.01;
  const demo::ScenePlay play = demo::play(demo::sceneNamed("chain-hang"), options);
  EXPECT_EQ(play.world->solids().front().packing, packing);
  EXPECT_EQ(play.world->solids().front().shape->sphereCount(), 64u);
}

}  // namespace
}  // namespace innersphere::test
