// What happened in a scene.
#pragma once

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
  double kinetic = 0;           ///< [J]
  double potential = 0;         ///< [J], 0 at z = 0
  Vec3d momentum{};             ///< [kg m/s]
  Vec3d angular_momentum{};     ///< [kg m^2/s] about the origin
  int contacts = 0;             ///< contact points that Bullet's solver gets
  double overlap = 0;           ///< the deepest of them [m]; 0 if none is deeper than touching
  double relative_overlap = 0;  ///< the deepest relative to the smaller body's bounding-box diagonal
  double fastest = 0;           ///< the highest speed of a centre of mass [m/s]
  double fastest_turn = 0;      ///< the highest angular speed [rad/s]
};

struct Recording {
  Film film;                       ///< at most 60 frames a second
  std::vector<StepRecord> steps;   ///< the first one is the start
  std::vector<Pose> poses;         ///< of all bodies after each step, as Film::poses
  std::vector<std::string> names;  ///< of the bodies
};

/// Steps a world with a fixed time step [s] and records it. Throws Error cancelled.
Recording record(SceneWorld& world, double seconds, double dt, const Progress& progress);

/// One row a step: time, energies, momenta, contacts, overlap, step time, then each body's centre of mass and
/// orientation (quaternion of its principal axes).
std::string toCsv(const Recording& recording);

}  // namespace innersphere::demo
