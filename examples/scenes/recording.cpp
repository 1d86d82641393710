#include "recording.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "innersphere/error.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr double kFrameRate = 60;  // [1/s] of films

Vec3d plus(const Vec3d& a, const btVector3& b) {
  return {a[0] + b.x(), a[1] + b.y(), a[2] + b.z()};
}

void addMotion(const btRigidBody& body, const btVector3& gravity, StepRecord& record) {
  const btScalar mass = 1 / body.getInvMass();
  const btVector3 velocity = body.getLinearVelocity();
  const btVector3 turn = body.getAngularVelocity();
  const btVector3 place = body.getCenterOfMassPosition();
  const btMatrix3x3 axes = body.getCenterOfMassTransform().getBasis();
  const btVector3 local_turn = turn * axes;  // transposed: into the body's frame
  const btVector3 spin = axes * (local_turn / body.getInvInertiaDiagLocal());
  record.kinetic += 0.5 * mass * velocity.length2() + 0.5 * turn.dot(spin);
  record.potential -= mass * gravity.dot(place);
  record.momentum = plus(record.momentum, mass * velocity);
  record.angular_momentum = plus(record.angular_momentum, mass * place.cross(velocity) + spin);
  record.fastest = std::max<double>(record.fastest, velocity.length());
  record.fastest_turn = std::max<double>(record.fastest_turn, turn.length());
}

void addContacts(SceneWorld& world, StepRecord& record) {
  const auto sizeOf = [&world](const btCollisionObject* object) {
    for (const SceneBody& body : world.bodies()) {
      if (body.body.get() == object && body.moves()) return body.size;
    }
    return std::numeric_limits<double>::infinity();
  };
  btDispatcher* dispatcher = world.bullet().getDispatcher();
  for (int i = 0; i < dispatcher->getNumManifolds(); ++i) {
    const btPersistentManifold* manifold = dispatcher->getManifoldByIndexInternal(i);
    double deepest = 0;
    for (int k = 0; k < manifold->getNumContacts(); ++k) {
      const double overlap = -manifold->getContactPoint(k).getDistance();
      if (overlap >= 0) ++record.contacts;
      deepest = std::max(deepest, overlap);
    }
    if (deepest == 0) continue;
    const double size = std::min(sizeOf(manifold->getBody0()), sizeOf(manifold->getBody1()));
    record.overlap = std::max(record.overlap, deepest);
    record.relative_overlap = std::max(record.relative_overlap, deepest / size);
  }
}

StepRecord observe(SceneWorld& world, double time, double step_time) {
  StepRecord record;
  record.time = time;
  record.step_time = step_time;
  for (const SceneBody& body : world.bodies()) {
    if (body.moves()) addMotion(*body.body, world.bullet().getGravity(), record);
  }
  addContacts(world, record);
  return record;
}

void append(std::string& text, double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, ",%.9g", value);
  text += buffer;
}

}  // namespace

Recording record(SceneWorld& world, double seconds, double dt, const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  Recording recording;
  recording.film = world.film;
  const int frame_steps = std::max(1, static_cast<int>(std::lround(1 / (kFrameRate * dt))));
  recording.film.frame_rate = 1 / (frame_steps * dt);
  for (const SceneBody& body : world.bodies()) recording.names.push_back(body.name);

  const auto keep = [&](int step, double step_time) {
    recording.steps.push_back(observe(world, step * dt, step_time));
    for (const SceneBody& body : world.bodies()) recording.poses.push_back(SceneWorld::poseOf(*body.body));
    if (step % frame_steps != 0) return;
    recording.film.poses.insert(recording.film.poses.end(),
                                recording.poses.end() - static_cast<std::ptrdiff_t>(world.bodies().size()),
                                recording.poses.end());
  };
  keep(0, 0);
  const int steps = static_cast<int>(std::ceil(seconds / dt - 1e-6));
  for (int step = 1; step <= steps; ++step) {
    const auto start = Clock::now();
    world.bullet().stepSimulation(btScalar(dt), 0);
    keep(step, std::chrono::duration<double>(Clock::now() - start).count());
    if (progress && !progress("stepping", static_cast<double>(step) / steps)) {
      throw Error(ErrorCode::cancelled, "the scene was cancelled");
    }
  }
  return recording;
}

std::string toCsv(const Recording& recording) {
  std::string text =
      "time_s,kinetic_J,potential_J,momentum_x,momentum_y,momentum_z,angular_momentum_x,angular_momentum_y,"
      "angular_momentum_z,contacts,deepest_overlap_m,step_ms";
  for (std::size_t i = 0; i < recording.names.size(); ++i) {
    for (const char* part : {"x", "y", "z", "qx", "qy", "qz", "qw"}) {
      text += ",body" + std::to_string(i) + "_" + part;
    }
  }
  text += '\n';
  const Pose* pose = recording.poses.data();
  for (const StepRecord& step : recording.steps) {
    char time[32];
    std::snprintf(time, sizeof time, "%.9g", step.time);
    text += time;
    append(text, step.kinetic);
    append(text, step.potential);
    for (const double p : step.momentum) append(text, p);
    for (const double l : step.angular_momentum) append(text, l);
    append(text, step.contacts);
    append(text, step.overlap);
    append(text, 1e3 * step.step_time);
    for (std::size_t i = 0; i < recording.names.size(); ++i, ++pose) {
      for (const float p : pose->position) append(text, p);
      for (const float q : pose->rotation) append(text, q);
    }
    text += '\n';
  }
  return text;
}

}  // namespace innersphere::demo
