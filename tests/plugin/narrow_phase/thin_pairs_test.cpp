// Thin solids that touch each other are told where they are deepest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "local_overlap.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"
#include "turned_meshes.hpp"

namespace innersphere::test {
namespace {

constexpr double kDegree = M_PI / 180;

/// A bar along x of 0.1 m, so wide along y, of 2 mm at the one edge and `thin` at the other.
Mesh barMesh(double width, double thin) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    const double z = (i & 2 ? thin : 0.002) / 2;
    mesh.vertices.push_back({i & 1 ? 0.05 : -0.05, (i & 2 ? 0.5 : -0.5) * width, i & 4 ? z : -z});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

Mesh meshOf(const std::string& solid) {
  if (solid == "cup") return cupMesh(8);
  return solid == "plate" ? barMesh(0.08, 0.002) : barMesh(0.03, 0.0002);
}

double wallOf(const std::string& solid) {
  return solid == "cup" ? 0.001 : 0.002;
}

/// 256 spheres by falling radius or all over the surface, or what the tool chooses.
std::shared_ptr<PackingShape> shapeOf(const std::string& name, const std::string& kind) {
  static std::map<std::pair<std::string, std::string>, std::shared_ptr<PackingShape>> shapes;
  std::shared_ptr<PackingShape>& shape = shapes[{name, kind}];
  if (!shape) {
    const std::unique_ptr<Solid> solid = makeSolid(meshOf(name), name);
    PackOptions options;
    options.spheres = 256;
    options.overlap_errors = false;
    if (kind != "radius") options.order = SphereOrder::coverage;
    if (kind == "default") {
      options.spheres = 0;
      options.gap = 0.01 * norm(solid->bounds().max - solid->bounds().min);
    }
    shape = makeShape(pack(*solid, options));
  }
  return shape;
}

const Surface& surfaceOf(const PackingShape& shape) {
  return shape.model().packing().surface;
}

double sizeOf(const PackingShape& shape) {
  btVector3 min, max;
  shape.getAabb(btTransform::getIdentity(), min, max);
  return double(max.distance(min));
}

Vec3d toDouble(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

/// All contacts of a pair: normals lead from A to B.
struct FindAll : btCollisionWorld::ContactResultCallback {
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* object0, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    const bool swapped = object0->getCollisionObject() != a;
    const btVector3& on_b = swapped ? point.getPositionWorldOnA() : point.getPositionWorldOnB();
    found.push_back({-double(point.getDistance()), (swapped ? 1.0 : -1.0) * toDouble(point.m_normalWorldOnB),
                     toDouble(on_b)});
    return 0;
  }
  const btCollisionObject* a = nullptr;
  std::vector<LocalOverlap> found;
};

class Placements {
 public:
  Placements(const PackingShape& a, const PackingShape& b, double deepest)
      : a_(surfaceOf(a)), b_(surfaceOf(b)), deepest_(deepest) {}

  /// A meets B along a random line, somewhere, and goes on, or stops before, by a random way.
  std::pair<btTransform, btTransform> next() {
    for (;;) {
      const btTransform at_b(turn(), btVector3(0, 0, 0));
      btTransform at_a(turn(), btVector3(0, 0, 0));
      const double depth = deepest_ * uniform_(rng_);
      const Vec3d way = direction();
      PlacedMesh a(a_, at_a);
      const PlacedMesh b(b_, at_b);
      const Vec3d start = placeOn(b) - placeOn(a) - 1.0 * way;
      a.move(start);
      const std::optional<Touch> touch = firstTouch(a, b, way);
      if (!touch || dot(touch->normal, way) < kSteepest) continue;
      const Vec3d at = start + (touch->way + depth / dot(touch->normal, way)) * way;
      at_a.setOrigin(btVector3(btScalar(at[0]), btScalar(at[1]), btScalar(at[2])));
      return {at_a, at_b};
    }
  }

 private:
  static constexpr double kSteepest = 0.3;

  Vec3d direction() {
    const Vec3d v{normal_(rng_), normal_(rng_), normal_(rng_)};
    return (1 / norm(v)) * v;
  }
  btQuaternion turn() {
    const Vec3d v = direction();
    return btQuaternion(btVector3(btScalar(v[0]), btScalar(v[1]), btScalar(v[2])),
                        btScalar(M_PI * uniform_(rng_)));
  }
  Vec3d placeOn(const PlacedMesh& mesh) {
    const auto& t = mesh.triangles[rng_() % mesh.triangles.size()];
    const double u = std::fabs(uniform_(rng_)), v = (1 - u) * std::fabs(uniform_(rng_));
    return (1 - u - v) * mesh.corners[t[0]] + u * mesh.corners[t[1]] + v * mesh.corners[t[2]];
  }

  const Surface &a_, &b_;
  double deepest_;
  std::mt19937 rng_{1};
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

/// What is wrong with what was found; empty if that is the truth.
std::string faultOf(const std::vector<LocalOverlap>& found, const LocalOverlap& truth, double tolerance) {
  if (found.empty()) return "none";
  double deepest = -1;
  bool right = false;
  for (const LocalOverlap& f : found) {
    deepest = std::max(deepest, f.depth);
    const double angle = std::atan2(norm(cross(f.normal, truth.normal)), dot(f.normal, truth.normal));
    right = right || (std::fabs(f.depth - truth.depth) < tolerance && angle < kDegree &&
                      norm(f.on_b - truth.on_b) < tolerance);
  }
  if (deepest > truth.depth + tolerance) return "deeper";
  if (right) return "";
  return deepest < truth.depth - tolerance ? "shallow" : "beside";
}

/// If it is set, placements are counted, with packings of all kinds.
const char* const wanted = std::getenv("INNERSPHERE_PLACEMENTS");

class ThinPairs
    : public testing::TestWithParam<std::tuple<std::pair<std::string, std::string>, std::string>> {};

/// Surfaces are up to a quarter of the wall in each other or apart.
TEST_P(ThinPairs, MeetWhereTheyAreDeepest) {
  const auto& [names, kind] = GetParam();
  const std::shared_ptr<PackingShape> a = shapeOf(names.first, kind), b = shapeOf(names.second, kind);
  const double wall = std::min(wallOf(names.first), wallOf(names.second)), tolerance = 1e-5 * sizeOf(*a);
  TestWorld world;
  btRigidBody& body_a = world.add(a, 1, btVector3(0, 0, 0));
  btRigidBody& body_b = world.add(b, 0, btVector3(0, 0, 0));
  Placements random(*a, *b, wall / 4);
  std::map<std::string, int> faults;
  int tried = 0, missed = 0;
  for (int i = 0; i < (wanted != nullptr ? std::atoi(wanted) : 12); ++i) {
    const auto [at_a, at_b] = random.next();
    body_a.setWorldTransform(a->bodyTransform(at_a));
    body_b.setWorldTransform(b->bodyTransform(at_b));
    const PlacedMesh mesh_a(surfaceOf(*a), a->meshTransform(body_a.getWorldTransform()));
    const PlacedMesh mesh_b(surfaceOf(*b), b->meshTransform(body_b.getWorldTransform()));
    const std::optional<LocalOverlap> truth = localOverlap(mesh_a, mesh_b, 2 * wall);
    if (!truth) continue;
    ++tried;
    FindAll found;
    found.a = &body_a;
    found.m_closestDistanceThreshold = btScalar(wall / 2);
    world.world.contactPairTest(&body_a, &body_b, found);
    const std::string fault = faultOf(found.found, *truth, tolerance);
    if (fault.empty()) continue;
    ++missed;
    ++faults[fault];
  }
  RecordProperty("tried", tried);
  for (const auto& [fault, count] : faults) RecordProperty(fault, count);
  // Where another way out is nearly as short, or a wall ends in a thin edge.
  EXPECT_LE(20 * missed, tried);
  EXPECT_GT(tried, 0);
}

std::string nameOf(const testing::TestParamInfo<ThinPairs::ParamType>& info) {
  const auto& [names, kind] = info.param;
  return names.first + "_on_" + names.second + "_" + kind;
}

/// The others take long to be packed.
std::vector<std::string> kinds() {
  if (wanted == nullptr) return {"radius"};
  return {"radius", "coverage", "default"};
}

using Pair = std::pair<std::string, std::string>;
INSTANTIATE_TEST_SUITE_P(All, ThinPairs,
                         testing::Combine(testing::Values(Pair("plate", "plate"), Pair("blade", "blade"),
                                                          Pair("cup", "plate"), Pair("cup", "cup")),
                                          testing::ValuesIn(kinds())),
                         nameOf);

}  // namespace
}  // namespace innersphere::test
