#include "scene_report.hpp"

#include <algorithm>
#include <cmath>

#include "scenes/world.hpp"

namespace innersphere::tool {
namespace {

// Below both, nothing is seen to move.
constexpr double kRestSpeed = 0.02;  // [m/s]
constexpr double kRestTurn = 0.1;    // [rad/s]

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
  const bool rests = last.fastest < kRestSpeed && last.fastest_turn < kRestTurn;
  report.add("at_rest", "at rest", rests,
             std::string(rests ? "yes" : "no") + "; fastest body " + number(last.fastest, "m/s, ") +
                 number(last.fastest_turn, "rad/s"));
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
