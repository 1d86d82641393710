#include "recording.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "innersphere/error.hpp"
#include "observation.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr double kFrameRate = 60;  // [1/s] of films

void appendFrame(SceneWorld& world, const Recording& recording, Film& film) {
  for (std::size_t i = recording.states.size() - recording.names.size(); i < recording.states.size(); ++i) {
    const BodyState& state = recording.states[i];
    Pose& pose = film.poses.emplace_back();
    for (int k = 0; k < 3; ++k) pose.position[k] = static_cast<float>(state.position[k]);
    for (int k = 0; k < 4; ++k) pose.rotation[k] = static_cast<float>(state.rotation[k]);
  }
  film.contacts.push_back(contactMarks(world));
}

void append(std::string& text, double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, ",%.9g", value);
  text += buffer;
}

}  // namespace

std::size_t Recording::stepAt(double time) const {
  const auto after = std::lower_bound(steps.begin(), steps.end(), time,
                                      [](const StepRecord& step, double t) { return step.time < t; });
  if (after == steps.begin()) return 0;
  const auto index = static_cast<std::size_t>(after - steps.begin());
  if (after == steps.end()) return index - 1;
  return after->time - time < time - steps[index - 1].time ? index : index - 1;
}

double Recording::deepestOverlap(double from) const {
  double deepest = 0;
  for (const StepRecord& step : steps) {
    if (step.time >= from) deepest = std::max(deepest, step.overlap);
  }
  return deepest;
}

double Recording::energyGained() const {
  const auto inTheMiddle = [this](std::size_t i) {
    const double half_substep = 0.5 / steps[i].substeps;  // in steps
    return steps[i].energy() + half_substep * (steps[i - 1].potential - steps[i].potential);
  };
  double sum = 0;
  for (std::size_t i = 2; i < steps.size(); ++i) {
    sum += std::max(0.0, inTheMiddle(i) - inTheMiddle(i - 1));
  }
  return sum;
}

double Recording::farthestFrom(std::size_t index, double from) const {
  const std::size_t start = stepAt(from);
  const Vec3d& origin = body(index, start).position;
  double farthest = 0;
  for (std::size_t i = start; i < steps.size(); ++i) {
    const Vec3d& p = body(index, i).position;
    farthest = std::max(farthest, std::hypot(p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]));
  }
  return farthest;
}

double Recording::turnBetween(std::size_t index, double from, double to) const {
  const auto& a = body(index, stepAt(from)).rotation;
  const auto& b = body(index, stepAt(to)).rotation;
  // The vector part of the quotient keeps small angles exact.
  const double x = a[3] * b[0] - a[0] * b[3] - a[1] * b[2] + a[2] * b[1];
  const double y = a[3] * b[1] - a[1] * b[3] - a[2] * b[0] + a[0] * b[2];
  const double z = a[3] * b[2] - a[2] * b[3] - a[0] * b[1] + a[1] * b[0];
  const double w = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  return 2 * std::atan2(std::hypot(x, y, z), std::abs(w));
}

int stepsIn(double seconds, double dt) {
  constexpr double kMost = 1e7;  // all of them are kept in memory
  const double steps = std::ceil(seconds / dt - 1e-6);
  if (steps >= 1 && steps <= kMost) return static_cast<int>(steps);
  char text[200];
  std::snprintf(text, sizeof text, "%g s in time steps of %g s %s", seconds, dt,
                steps < 1 ? "are not a single step: nothing would be simulated"
                          : "are more than the ten million steps that can be recorded");
  throw Error(ErrorCode::bad_argument, text);
}

Recording record(SceneWorld& world, double seconds, double dt, const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  const int steps = stepsIn(seconds, dt);
  Recording recording;
  recording.film = world.film;
  const int frame_steps = std::max(1, static_cast<int>(std::lround(1 / (kFrameRate * dt))));
  recording.film.frame_rate = 1 / (frame_steps * dt);
  for (const SceneBody& body : world.bodies()) recording.names.push_back(body.name);

  const auto keep = [&](int step, double step_time) {
    recording.steps.push_back(observe(world, step * dt, step_time));
    appendStates(world, recording.states);
    if (step % frame_steps == 0) appendFrame(world, recording, recording.film);
  };
  keep(0, 0);
  for (int step = 1; step <= steps; ++step) {
    if (world.drive) world.drive((step - 1) * dt, dt);
    const auto start = Clock::now();
    const std::clock_t processors = std::clock();
    world.step(dt);
    const std::clock_t worked = std::clock() - processors;
    keep(step, std::chrono::duration<double>(Clock::now() - start).count());
    recording.steps.back().substeps = world.substeps();
    recording.steps.back().processor_time = static_cast<double>(worked) / CLOCKS_PER_SEC;
    if (progress && !progress("stepping", static_cast<double>(step) / steps)) {
      throw Error(ErrorCode::cancelled, "the scene was cancelled");
    }
  }
  return recording;
}

std::string toCsv(const Recording& recording) {
  std::string text =
      "time_s,kinetic_J,potential_J,energy_J,momentum_x,momentum_y,momentum_z,angular_momentum_x,"
      "angular_momentum_y,angular_momentum_z,contacts,deepest_overlap_m,step_ms";
  for (std::size_t i = 0; i < recording.names.size(); ++i) {
    for (const char* part : {"x", "y", "z", "qx", "qy", "qz", "qw"}) {
      text += ",body" + std::to_string(i) + "_" + part;
    }
  }
  text += '\n';
  const BodyState* state = recording.states.data();
  for (const StepRecord& step : recording.steps) {
    char time[32];
    std::snprintf(time, sizeof time, "%.9g", step.time);
    text += time;
    append(text, step.kinetic);
    append(text, step.potential);
    append(text, step.energy());
    for (const double p : step.momentum) append(text, p);
    for (const double l : step.angular_momentum) append(text, l);
    append(text, step.contacts);
    append(text, step.overlap);
    append(text, 1e3 * step.step_time);
    for (std::size_t i = 0; i < recording.names.size(); ++i, ++state) {
      for (const double p : state->position) append(text, p);
      for (const double q : state->rotation) append(text, q);
    }
    text += '\n';
  }
  return text;
}

}  // namespace innersphere::demo
