// Reads the state of a world.
#pragma once

#include <vector>

#include "recording.hpp"

namespace innersphere::demo {

StepRecord observe(SceneWorld& world, double time, double step_time);

/// Appends the states of all bodies.
void appendStates(const SceneWorld& world, std::vector<BodyState>& states);

/// The contact points that Bullet's solver gets.
std::vector<ContactMark> contactMarks(SceneWorld& world);

}  // namespace innersphere::demo
