// What happened in a scene.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "film/film.hpp"
#include "innersphere/progress.hpp"

namespace innersphere::demo {

class SceneWorld;

/// The state of a world after a step. Energies and momenta are of the bodies that move.
struct StepRecord {
  double time = 0;              ///< [s]
  double step_time = 0;         ///< wall-clock time of the step [s]
  double processor_time = 0;    ///< of the step, of all threads [s]: other programs do not add to it
  double kinetic = 0;           ///< [J]
  double potential = 0;         ///< [J], 0 at z = 0
  int substeps = 1;             ///< of the solver
  Vec3d momentum{};             ///< [kg m/s]
  Vec3d angular_momentum{};     ///< [kg m^2/s] about the origin
  int contacts = 0;             ///< contact points that Bullet's solver gets
  double overlap = 0;           ///< the deepest of them [m]; 0 if none is deeper than touching
  double relative_overlap = 0;  ///< the deepest relative to the smaller body's bounding-box diagonal
  double fastest = 0;           ///< the highest speed of a centre of mass [m/s]
  double fastest_turn = 0;      ///< the highest angular speed [rad/s]

  double energy() const { return kinetic + potential; }
};

/// A body after a step.
struct BodyState {
  Vec3d position{};                            ///< of its centre of mass [m]
  std::array<double, 4> rotation{0, 0, 0, 1};  ///< of its principal axes: a quaternion x, y, z, w
  Vec3d velocity{};                            ///< [m/s]
  Vec3d spin{};                                ///< angular velocity [rad/s]
};

struct Recording {
  Film film;                       ///< at most 60 frames a second
  std::vector<StepRecord> steps;   ///< the first one is the start
  std::vector<BodyState> states;   ///< of all bodies at the start, then after the first step, ...
  std::vector<std::string> names;  ///< of the bodies

  double seconds() const { return steps.back().time; }
  /// The step nearest to a time [s].
  std::size_t stepAt(double time) const;
  const BodyState& body(std::size_t index, std::size_t step) const {
    return states[step * names.size() + index];
  }
  const BodyState& first(std::size_t index) const { return body(index, 0); }
  const BodyState& last(std::size_t index) const { return body(index, steps.size() - 1); }

  /// The deepest overlap from a time on [m].
  double deepestOverlap(double from = 0) const;
  /// Sum of all increments of the total energy from one step to the next [J]: energy from nowhere, unless
  /// springs give back what they took. Bullet moves bodies at the velocities that they have after a step, so
  /// these belong to its middle, and are put together with the places there; those of a solver with substeps
  /// belong to the middle of the last one. Free flight then keeps its energy to rounding, and the error of a
  /// pendulum is of second order in the step. With the places after the step a chain of Bullet's own joints,
  /// which swings like that of rings, would gain three times as much, and a body that falls would lose
  /// m g^2 dt^2 / 2 a step.
  double energyGained() const;
  /// The farthest that the centre of a body came from where it was at time `from` [m].
  double farthestFrom(std::size_t index, double from = 0) const;
  /// The angle between a body's orientations at two times [rad].
  double turnBetween(std::size_t index, double from, double to) const;
};

/// The number of steps of `dt` that cover a time [s]; a step is not begun for the sake of rounding. Throws
/// Error bad_argument if there are none, or more than ten million.
int stepsIn(double seconds, double dt);

/// Steps a world with a fixed time step [s] and records it. Throws Error: cancelled, and what stepsIn()
/// throws.
Recording record(SceneWorld& world, double seconds, double dt, const Progress& progress);

/// One row a step: time, energies, momenta, contacts, overlap, step time, then each body's centre of mass and
/// orientation (quaternion of its principal axes).
std::string toCsv(const Recording& recording);

}  // namespace innersphere::demo
