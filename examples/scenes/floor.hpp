// Whether bodies end in a floor.
#pragma once

#include <functional>

namespace innersphere::demo {

class SceneWorld;

/// Expects that at the end no moving body that is packed is in the floor by more than 0.5 % of its size, by
/// the corners of its own surface: contacts may tell less. `height` is that of the floor at x and y, all in
/// metres. `seconds`: the shortest recording that shows it.
void expectNoneInFloor(SceneWorld& world, const std::function<double(double x, double y)>& height,
                       double seconds);
/// The same for a floor that is at 0 everywhere.
void expectNoneInFloor(SceneWorld& world, double seconds);

}  // namespace innersphere::demo
