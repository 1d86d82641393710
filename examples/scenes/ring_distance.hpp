// How far circles are apart, for chains of tori.
#pragma once

#include "recording.hpp"

namespace innersphere::demo {

/// The shortest distance between two circles of the same radius, each about the axis of its body's principal
/// frame that has the index `axis`. Found by sampling: exact to 1e-6 of the radius.
double distanceOfRings(const BodyState& a, const BodyState& b, int axis, double radius);

}  // namespace innersphere::demo
