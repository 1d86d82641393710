// Measures that several scenes compare with their truth.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "truth.hpp"

namespace innersphere::demo {

class SceneWorld;

using Measure = std::function<double(const Recording&)>;

/// Coordinate `axis` of a body's centre of mass at the end [m].
Measure finalCoordinate(std::size_t body, int axis);

/// The farthest that the centre of any body came from where it was at time `from` [m].
Measure farthestOfAll(std::size_t first_body, std::size_t count, double from = 0);

/// The largest angle by which any body is turned at the end, against time `from` [rad].
Measure largestTurn(std::size_t first_body, std::size_t count, double from = 0);

/// Bodies rest if in so long [s] none moves by so much of its size: nothing is seen to move.
constexpr double kRestTime = 0.5;
constexpr double kRestMotion = 0.01;

/// How far each body moved in the last kRestTime, over its size; turning by an angle counts as half of it. 0
/// for bodies of size 0. `sizes`: of all bodies [m].
std::vector<double> motionsAtTheEnd(const Recording& r, const std::vector<double>& sizes);

/// The angle that a body turned about the z axis between two times [rad]: by its rotations, less than half a
/// turn a step. Spins tell it only where a step has one speed, and SubstepSolver's steps have several.
double turnedAboutZ(const Recording& r, std::size_t body, double from, double to);

/// Energy that came from nowhere, over a reference [J]. `limit` is what GImpact's triangle meshes gain in the
/// same scene: `innersphere scene check NAME --shape gimpact`.
Truth energyGainBelow(double limit, double reference, const std::string& what_reference);

}  // namespace innersphere::demo
