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

double lowestOf(const Faller& faller, const BodyState& state) {
  const auto& [x, y, z, w] = state.rotation;
  const btVector3 down = vec(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y));  // row of z
  double lowest = 1e30;
  for (const auto& v : faller.packing->surface.vertices) {
    lowest = std::min(lowest, double(down.dot(faller.to_body * vec(v[0], v[1], v[2]))));
  }
  return state.position[2] + lowest;
}

std::vector<double> depthsOf(const std::vector<Faller>& fallers, double height, const Recording& r) {
  std::vector<double> depths;
  for (const Faller& faller : fallers)
    depths.push_back((height - lowestOf(faller, r.last(faller.body))) / faller.size);
  return depths;
}

}  // namespace

void expectNoneInFloor(SceneWorld& world, double height, double seconds) {
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

}  // namespace innersphere::demo
