// The scene library: what demos, tests and benchmarks run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "body_shape.hpp"
#include "innersphere/contact_options.hpp"
#include "innersphere/progress.hpp"
#include "innersphere/solid.hpp"
#include "recording.hpp"
#include "solver_choice.hpp"
#include "truth.hpp"

namespace innersphere::demo {

class SceneWorld;

/// What a caller chooses; each scene uses what makes sense for it.
struct SceneOptions {
  double seconds = 0;       ///< simulated time; 0: the scene's own
  double dt = 0;            ///< time step [s]; 0: the scene's own
  std::size_t spheres = 0;  ///< of each solid's packing; 0: the scene's own
  std::uint64_t seed = 1;   ///< of random places and orientations
  bool plain = false;       ///< Bullet as its HelloWorld has it, see Stepping::plain; `dt` is then 1/60 s
  /// To use instead of the scene's own solids, scaled to its size; see Scene::takes_solids.
  std::vector<std::shared_ptr<const Solid>> solids;
  ContactOptions contact;
  BodyOptions bodies;
  SolverChoice solver;
  Progress progress;  ///< packing takes a while
};

/// A scene fills a world with bodies and says what has to come of it.
struct Scene {
  std::string name;         ///< short, lower case: what the command line calls it
  std::string title;        ///< a few words, for people
  std::string description;  ///< one sentence
  std::string guards;       ///< one sentence: what is broken where its truth is missed
  void (*build)(SceneWorld& world, const SceneOptions& options);
  double seconds = 5;          ///< simulated time that shows all of it
  double dt = 1.0 / 240;       ///< time step that it is meant for [s]
  std::size_t spheres = 1000;  ///< of each packing
  double stiffness = 0;        ///< of compliant contacts [N/m^3]; 0: ContactOptions' own
  bool takes_solids = false;   ///< works with a user's solids
};

const std::vector<Scene>& scenes();

/// Throws Error bad_argument with the known names.
const Scene& sceneNamed(const std::string& name);

/// Of those that take a user's solids, with commas between them.
std::string namesOfScenesThatTakeSolids();

/// The options with the scene's own values where the caller has none. Throws Error bad_argument if the scene
/// cannot use them.
SceneOptions completed(const Scene& scene, SceneOptions options);

/// A scene that ran.
struct ScenePlay {
  SceneOptions options;  ///< completed
  std::unique_ptr<SceneWorld> world;
  Recording recording;
  std::vector<Verdict> verdicts;

  ScenePlay();
  ScenePlay(ScenePlay&&) noexcept;
  ~ScenePlay();
};

/// Builds a scene, steps it, and compares it with its truth. Throws Error: bad_argument, cancelled, and what
/// pack() throws.
ScenePlay play(const Scene& scene, const SceneOptions& options);

}  // namespace innersphere::demo
