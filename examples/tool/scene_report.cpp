#include "scene_report.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "contact_arguments.hpp"
#include "scenes/measures.hpp"
#include "scenes/world.hpp"

namespace innersphere::tool {
namespace {

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

// By how much of its size the most restless body moved in the end.
double motionAtTheEnd(const demo::SceneWorld& world, const demo::Recording& recording) {
  std::vector<double> sizes;
  for (const demo::SceneBody& body : world.bodies()) sizes.push_back(body.size);
  const std::vector<double> motions = demo::motionsAtTheEnd(recording, sizes);
  return motions.empty() ? 0 : *std::max_element(motions.begin(), motions.end());
}

// The verdict in plain words.
demo::Note noteOf(const demo::Verdict& verdict) {
  const demo::Truth& truth = verdict.truth;
  // Small lengths are easier to grasp in millimetres.
  const auto amount = [&truth](double value) {
    const bool small = truth.unit == "m" && value != 0 && std::abs(value) < 0.1;
    return small ? number(1e3 * value, "mm") : number(value, truth.unit);
  };
  std::string what = truth.what;
  what.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(what.front())));
  if (verdict.outcome == demo::Outcome::not_recorded) {
    return {what + ": not shown, it takes " + number(truth.needs, "s"), {}};
  }
  const bool holds = verdict.outcome == demo::Outcome::holds;
  const bool exact = truth.kind == demo::Truth::Kind::equal && truth.tolerance == 0;
  std::string wanted = "should be ";
  if (truth.kind == demo::Truth::Kind::at_most) wanted += "at most ";
  wanted += amount(truth.expected);
  if (truth.tolerance > 0) wanted += ", give or take " + amount(truth.tolerance);
  if (holds && exact) wanted = "as it should be";
  if (!holds && truth.known_miss > 0) wanted += "; a known weakness";
  return {what + ": " + amount(verdict.measured) + " (" + wanted + ")", holds};
}

}  // namespace

void addTexts(const demo::Scene& scene, demo::ScenePlay& play) {
  const demo::SceneWorld& world = *play.world;
  std::size_t spheres = 0;
  for (const demo::SceneSolid& solid : world.solids()) {
    for (const demo::Actor& actor : world.film.actors) {
      if (actor.shape == solid.look) spheres += solid.packing->spheres.size();
    }
  }
  const std::size_t bodies = movingBodies(world);
  demo::Film& film = play.recording.film;
  film.caption = scene.description + " " + std::to_string(bodies) +
                 (bodies == 1 ? " moving body, " : " moving bodies, ") + std::to_string(spheres) +
                 " spheres, step " + number(1e3 * play.options.dt, "ms") + ".";
  for (const demo::Verdict& verdict : play.verdicts) film.notes.push_back(noteOf(verdict));
}

std::string describe(const demo::Verdict& verdict) {
  const demo::Truth& truth = verdict.truth;
  const std::string allowed =
      truth.kind == demo::Truth::Kind::at_most
          ? "at most " + number(truth.expected, truth.unit)
          : "expected " + number(truth.expected) + " +- " + number(truth.tolerance, truth.unit);
  const std::string source = " (" + truth.source + ")";
  if (verdict.outcome == demo::Outcome::not_recorded) {
    return "not shown  " + truth.what + ": takes " + number(truth.needs, "s") + ", " + allowed + source;
  }
  return (verdict.outcome == demo::Outcome::holds ? "holds   " : "MISSED  ") + truth.what + ": " +
         number(verdict.measured, truth.unit) + ", " + allowed + source;
}

nlohmann::ordered_json truthsJson(const std::vector<demo::Verdict>& verdicts) {
  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  for (const demo::Verdict& verdict : verdicts) {
    const demo::Truth& truth = verdict.truth;
    const bool bound = truth.kind == demo::Truth::Kind::at_most;
    nlohmann::ordered_json result = {{"what", truth.what},
                                     {"unit", truth.unit},
                                     {bound ? "at_most" : "expected", truth.expected},
                                     {"tolerance", truth.tolerance},
                                     {"source", truth.source}};
    const bool known = verdict.outcome != demo::Outcome::not_recorded;
    result["measured"] = known ? nlohmann::ordered_json(verdict.measured) : nlohmann::ordered_json(nullptr);
    result["holds"] = known ? nlohmann::ordered_json(verdict.outcome == demo::Outcome::holds)
                            : nlohmann::ordered_json(nullptr);
    results.push_back(result);
  }
  return results;
}

bool allHold(const std::vector<demo::Verdict>& verdicts) {
  return std::none_of(verdicts.begin(), verdicts.end(),
                      [](const demo::Verdict& verdict) { return verdict.outcome == demo::Outcome::missed; });
}

Report describe(const demo::Scene& scene, const demo::ScenePlay& play) {
  const demo::Recording& recording = play.recording;
  const demo::SceneWorld& world = *play.world;
  const ContactOptions& contact = play.options.contact;
  const demo::StepRecord& first = recording.steps.front();
  const demo::StepRecord& last = recording.steps.back();
  Report report;
  report.add("scene", "scene", scene.name);
  report.add("guards", "guards", scene.guards);
  addSolids(report, world);
  report.add("bodies", "moving bodies", movingBodies(world));
  report.add("seconds", "simulated", last.time,
             number(last.time, "s in ") + std::to_string(recording.steps.size() - 1) + " steps");
  report.add("steps", "", recording.steps.size() - 1, "");
  report.add("response", "response", nameOf(contact.response));
  report.add("backend", "backend", backendName(contact.backend));
  addStepTimes(report, recording);
  report.add("contacts", "contact points", static_cast<std::size_t>(last.contacts));
  addOverlap(report, recording);
  const double motion = motionAtTheEnd(world, recording);
  report.add("at_rest", "at rest", motion < demo::kRestMotion,
             std::string(motion < demo::kRestMotion ? "yes" : "no") + "; the most restless body moved by " +
                 percent(motion) + " of its size in the last " + number(demo::kRestTime, "s"));
  report.add("motion_at_the_end", "", motion, "");
  report.add("fastest", "", last.fastest, "");
  report.add("fastest_turn", "", last.fastest_turn, "");
  report.add("energy", "energy",
             {{"start", first.energy()},
              {"end", last.energy()},
              {"kinetic", last.kinetic},
              {"gained", recording.energyGained()}},
             number(first.energy(), "J at the start, ") + number(last.energy(), "J at the end, ") +
                 number(last.kinetic, "J of it kinetic; all increments sum to ") +
                 number(recording.energyGained(), "J"));
  report.add("truths", "", truthsJson(play.verdicts), "");
  for (const demo::Verdict& verdict : play.verdicts) report.addLine("truth", describe(verdict));
  return report;
}

}  // namespace innersphere::tool
