#include "floor.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "bullet_math.hpp"
#include "recording.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr double kAllowed = 0.005;  // of the size

// A body that may be in the floor. The solid outlives the recording's judgement with the packing.
struct Faller {
  std::size_t body;
  double size;  // [m]
  std::shared_ptr<const Packing> packing;
  btTransform to_body;  // from the frame of the mesh
};

using Height = std::function<double(double x, double y)>;

// How far the deepest corner is in the floor [m].
double depthOf(const Faller& faller, const Height& height, const BodyState& state) {
  const auto& [x, y, z, w] = state.rotation;
  const btTransform body(btQuaternion(btScalar(x), btScalar(y), btScalar(z), btScalar(w)),
                         vec(state.position[0], state.position[1], state.position[2]));
  const btTransform world = body * faller.to_body;
  double deepest = -1e30;
  for (const auto& v : faller.packing->surface.vertices) {
    const btVector3 corner = world * vec(v[0], v[1], v[2]);
    deepest = std::max(deepest, height(corner.x(), corner.y()) - corner.z());
  }
  return deepest;
}

std::vector<double> depthsOf(const std::vector<Faller>& fallers, const Height& height, const Recording& r) {
  std::vector<double> depths;
  for (const Faller& faller : fallers)
    depths.push_back(depthOf(faller, height, r.last(faller.body)) / faller.size);
  return depths;
}

}  // namespace

void expectNoneInFloor(SceneWorld& world, const Height& height, double seconds) {
  std::vector<Faller> fallers;
  for (std::size_t i = 0; i < world.bodies().size(); ++i) {
    const SceneSolid* solid = world.solidOf(i);
    if (solid == nullptr || !world.bodies()[i].moves()) continue;
    fallers.push_back({i, solid->size, solid->packing, solid->shape->principalTransform()});
  }
  const char* source = "bodies rest on the floor; 0.5 % of their size";
  world.expect({"bodies in the floor at the end", "", Truth::Kind::equal, 0, 0, source,
                [=](const Recording& r) {
                  const std::vector<double> depths = depthsOf(fallers, height, r);
                  return double(std::count_if(depths.begin(), depths.end(),
                                              [](double depth) { return depth > kAllowed; }));
                },
                seconds});
  world.expect({"deepest body in the floor at the end, over its size", "", Truth::Kind::at_most, kAllowed, 0,
                source,
                [=](const Recording& r) {
                  const std::vector<double> depths = depthsOf(fallers, height, r);
                  return *std::max_element(depths.begin(), depths.end());
                },
                seconds});
}

void expectNoneInFloor(SceneWorld& world, double seconds) {
  expectNoneInFloor(
      world, [](double, double) { return 0.0; }, seconds);
}

}  // namespace innersphere::demo
