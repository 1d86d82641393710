// Whether bodies end in a floor.
#pragma once

namespace innersphere::demo {

class SceneWorld;

/// What is known to be in a floor today, see Truth::known_miss.
struct KnownInFloor {
  double bodies = 0;
  double depth = 0;  ///< of the deepest, over its size
};

/// Expects that at the end no moving body that is packed is in a floor at this height [m] by more than 0.5 %
/// of its size, by the corners of its own surface: contacts may tell less. `seconds`: the shortest recording
/// that shows it.
void expectNoneInFloor(SceneWorld& world, double height, double seconds, const KnownInFloor& known = {});

}  // namespace innersphere::demo
