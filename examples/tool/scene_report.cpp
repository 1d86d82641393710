#include "scene_report.hpp"

#include <algorithm>
#include <cmath>

#include "scenes/world.hpp"

namespace innersphere::tool {
namespace {

// Bodies rest if in so long [s] none moves by so much of its size: nothing is seen to move.
constexpr double kRestTime = 0.5;
constexpr double kRestMotion = 0.01;

std::size_t movingBodies(const demo::SceneWorld& world) {
  return static_cast<std::size_t>(std::count_if(world.bodies().begin(), world.bodies().end(),
                                                [](const demo::SceneBody& body) { return body.moves(); }));
}

std::string backendName(Backend backend) {
  if (backend == Backend::cuda) return "cuda";
  return backend == Backend::automatic && cudaAvailable() ? "cpu or cuda, by the amount of work" : "cpu";
}

void addSolids(Report& report, const demo::SceneWorld& world) {
  nlohmann::ordered_json solids = nlohmann::ordered_json::array();
  for (const demo::SceneSolid& solid : world.solids()) {
    const Packing& packing = *solid.packing;
    solids.push_back({{"source", packing.provenance.source},
                      {"spheres", packing.spheres.size()},
                      {"density", packing.quality.density},
                      {"size", solid.size}});
  }
  report.add("solids", "", solids, "");
  for (const demo::SceneSolid& solid : world.solids()) {
    const Packing& packing = *solid.packing;
    report.addLine(packing.provenance.source, std::to_string(packing.spheres.size()) + " spheres, density " +
                                                  percent(packing.quality.density) + ", " +
                                                  number(solid.size, "m across"));
  }
}

void addStepTimes(Report& report, const demo::Recording& recording) {
  std::vector<double> times;
  for (const demo::StepRecord& step : recording.steps) {
    if (step.time > 0) times.push_back(1e3 * step.step_time);
  }
  std::sort(times.begin(), times.end());
  const auto quantile = [&times](double q) {
    return times[static_cast<std::size_t>(std::lround(q * static_cast<double>(times.size() - 1)))];
  };
  report.add("step_ms", "step time",
             {{"median", quantile(0.5)}, {"p99", quantile(0.99)}, {"worst", times.back()}},
             number(quantile(0.5)) + " ms median, " + number(quantile(0.99)) + " ms p99, " +
                 number(times.back()) + " ms worst");
}

void addOverlap(Report& report, const demo::Recording& recording) {
  double deepest = 0;
  double relative = 0;
  for (const demo::StepRecord& step : recording.steps) {
    deepest = std::max(deepest, step.overlap);
    relative = std::max(relative, step.relative_overlap);
  }
  const demo::StepRecord& last = recording.steps.back();
  report.add("deepest_overlap", "deepest overlap", deepest,
             number(deepest, "m") + ", " + percent(relative) + " of a body's size; at the end " +
                 number(last.overlap, "m") + ", " + percent(last.relative_overlap));
  report.add("deepest_overlap_relative", "", relative, "");
  report.add("final_overlap", "", last.overlap, "");
  report.add("final_overlap_relative", "", last.relative_overlap, "");
}

// By how much of its size the most restless body moved over the last kRestTime, turning included.
double motionAtTheEnd(const demo::SceneWorld& world, const demo::Recording& recording) {
  const double dt = recording.steps.size() > 1 ? recording.steps[1].time - recording.steps[0].time : 1;
  const std::size_t last = recording.steps.size() - 1;
  const std::size_t first = last - std::min(last, static_cast<std::size_t>(std::lround(kRestTime / dt)));
  const std::size_t count = world.bodies().size();
  double most = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const demo::Pose& a = recording.poses[first * count + i];
    const demo::Pose& b = recording.poses[last * count + i];
    double squared = 0, cosine = 0;
    for (int k = 0; k < 3; ++k) squared += std::pow(b.position[k] - a.position[k], 2);
    for (int k = 0; k < 4; ++k) cosine += a.rotation[k] * b.rotation[k];
    const double turn = 2 * std::acos(std::min(std::fabs(cosine), 1.0));
    const double size = world.bodies()[i].size;
    if (size > 0) most = std::max(most, std::sqrt(squared) / size + turn / 2);
  }
  return most;
}

}  // namespace

std::string captionOf(const demo::SceneWorld& world, double dt) {
  std::size_t spheres = 0;
  for (const demo::SceneSolid& solid : world.solids()) {
    for (const demo::Actor& actor : world.film.actors) {
      if (actor.shape == solid.look) spheres += solid.packing->spheres.size();
    }
  }
  return std::to_string(movingBodies(world)) + " moving bodies, " + std::to_string(spheres) +
         " spheres, step " + number(1e3 * dt, "ms");
}

Report describe(const std::string& name, const demo::SceneWorld& world, const demo::Recording& recording,
                const ContactOptions& contact) {
  const demo::StepRecord& first = recording.steps.front();
  const demo::StepRecord& last = recording.steps.back();
  Report report;
  report.add("scene", "scene", name);
  addSolids(report, world);
  report.add("bodies", "moving bodies", movingBodies(world));
  report.add("seconds", "simulated", last.time,
             number(last.time, "s in ") + std::to_string(recording.steps.size() - 1) + " steps");
  report.add("steps", "", recording.steps.size() - 1, "");
  report.add("response", "response", contact.response == Response::rigid ? "rigid" : "compliant");
  report.add("backend", "backend", backendName(contact.backend));
  addStepTimes(report, recording);
  report.add("contacts", "contact points", static_cast<std::size_t>(last.contacts));
  addOverlap(report, recording);
  const double motion = motionAtTheEnd(world, recording);
  report.add("at_rest", "at rest", motion < kRestMotion,
             std::string(motion < kRestMotion ? "yes" : "no") + "; the most restless body moved by " +
                 percent(motion) + " of its size in the last " + number(kRestTime, "s"));
  report.add("motion_at_the_end", "", motion, "");
  report.add("fastest", "", last.fastest, "");
  report.add("fastest_turn", "", last.fastest_turn, "");
  const double energy = last.kinetic + last.potential;
  report.add("energy", "energy",
             {{"start", first.kinetic + first.potential}, {"end", energy}, {"kinetic", last.kinetic}},
             number(first.kinetic + first.potential, "J at the start, ") + number(energy, "J at the end, ") +
                 number(last.kinetic, "J of it kinetic"));
  return report;
}

}  // namespace innersphere::tool
