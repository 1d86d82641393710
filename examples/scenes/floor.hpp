// Whether bodies end in a floor.
#pragma once

namespace innersphere::demo {

class SceneWorld;

/// Expects that at the end no moving body that is packed is in a floor at this height [m] by more than 0.5 %
/// of its size, by the corners of its own surface: contacts may tell less. `seconds`: the shortest recording
/// that shows it.
void expectNoneInFloor(SceneWorld& world, double height, double seconds);

}  // namespace innersphere::demo
