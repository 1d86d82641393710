#include "scene.hpp"

#include "innersphere/error.hpp"

namespace innersphere::demo {

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> all = {
      {"pile", "Two dozen mixed solids fall into a tray and come to rest on each other.", buildPile},
      {"stack", "Five boxes, each a packing, stand on each other.", buildStack},
      {"chain", "Ten interlocked rings hang from the first one, which is held, and swing.", buildChain},
  };
  return all;
}

const Scene& sceneNamed(const std::string& name) {
  std::string known;
  for (const Scene& scene : scenes()) {
    if (scene.name == name) return scene;
    known += (known.empty() ? "" : ", ") + scene.name;
  }
  throw Error(ErrorCode::bad_argument, "there is no scene \"" + name + "\"; the scenes are " + known);
}

}  // namespace innersphere::demo
