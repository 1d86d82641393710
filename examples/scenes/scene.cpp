#include "scene.hpp"

#include <cmath>

#include "innersphere/error.hpp"
#include "world.hpp"

namespace innersphere::demo {

const Scene& sceneNamed(const std::string& name) {
  std::string known;
  for (const Scene& scene : scenes()) {
    if (scene.name == name) return scene;
    known += (known.empty() ? "" : ", ") + scene.name;
  }
  throw Error(ErrorCode::bad_argument, "there is no scene \"" + name + "\"; the scenes are " + known);
}

std::string namesOfScenesThatTakeSolids() {
  std::string names;
  for (const Scene& scene : scenes()) {
    if (scene.takes_solids) names += (names.empty() ? "" : ", ") + scene.name;
  }
  return names;
}

SceneOptions completed(const Scene& scene, SceneOptions options) {
  if (!options.solids.empty() && !scene.takes_solids) {
    throw Error(ErrorCode::bad_argument, "the scene " + scene.name +
                                             " has solids of its own; yours can be used in " +
                                             namesOfScenesThatTakeSolids());
  }
  if (options.plain && options.dt != 0 && std::abs(options.dt * kPlainRate - 1) > 1e-6) {
    throw Error(ErrorCode::bad_argument,
                "a plain world is stepped 60 times a second: leave out the time step");
  }
  if (options.plain) options.dt = 1 / kPlainRate;
  if (options.seconds == 0) options.seconds = scene.seconds;
  if (options.dt == 0) options.dt = scene.dt;
  if (options.spheres == 0) options.spheres = scene.spheres;
  if (options.contact.stiffness == 0) options.contact.stiffness = scene.stiffness;
  stepsIn(options.seconds, options.dt);  // a wrong time shows before anything is packed
  return options;
}

ScenePlay::ScenePlay() = default;
ScenePlay::ScenePlay(ScenePlay&&) noexcept = default;
ScenePlay::~ScenePlay() = default;

ScenePlay play(const Scene& scene, const SceneOptions& options) {
  ScenePlay result;
  result.options = completed(scene, options);
  result.world = std::make_unique<SceneWorld>(result.options.contact, result.options.bodies,
                                              result.options.plain ? Stepping::plain : Stepping::careful,
                                              result.options.solver);
  result.world->film.title = scene.title;
  scene.build(*result.world, result.options);
  result.recording =
      record(*result.world, result.options.seconds, result.options.dt, result.options.progress);
  result.verdicts = judge(result.world->truths, result.recording);
  return result;
}

}  // namespace innersphere::demo
