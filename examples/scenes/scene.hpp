// The scene library: what demos, tests and benchmarks run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "innersphere/contact_options.hpp"
#include "innersphere/progress.hpp"
#include "innersphere/solid.hpp"

namespace innersphere::demo {

class SceneWorld;

/// What a caller chooses; each scene uses what makes sense for it.
struct SceneOptions {
  std::uint64_t seed = 1;      ///< of random places and orientations
  std::size_t spheres = 1000;  ///< of each solid's packing
  /// To use instead of the scene's own solids, scaled to its size.
  std::vector<std::shared_ptr<const Solid>> solids;
  ContactOptions contact;
  Progress progress;  ///< packing takes a while
};

/// A scene fills a world with bodies; stepping is up to the caller.
struct Scene {
  std::string name;
  std::string description;  ///< one sentence
  void (*build)(SceneWorld& world, const SceneOptions& options);
};

const std::vector<Scene>& scenes();

/// Throws Error bad_argument with the known names.
const Scene& sceneNamed(const std::string& name);

void buildPile(SceneWorld& world, const SceneOptions& options);
void buildStack(SceneWorld& world, const SceneOptions& options);
void buildChain(SceneWorld& world, const SceneOptions& options);

}  // namespace innersphere::demo
