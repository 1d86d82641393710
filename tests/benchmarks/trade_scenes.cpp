#include "trade_scenes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "innersphere/query.hpp"
#include "scenes/scene.hpp"
#include "scenes/world.hpp"

namespace innersphere::benchmarks {
namespace {

using demo::BodyShape;

constexpr double kLongRun = 5;      // [s] such runs average over disturbances and are not repeated
constexpr std::size_t kWarmUp = 5;  // steps that build grids and get memory

/// A scene, and how its errors are made comparable.
struct Subject {
  std::string scene;
  double seconds;
  double tolerance;  ///< of the scene's own truths, relative to the length that errors are to be relative to
  std::vector<std::size_t> spheres;
  std::vector<double> rates;
  std::vector<double> concavities;
};

const std::vector<Subject>& subjects() {
  static const std::vector<Subject> all = {
      {"rest", 3, 0.005, {64, 256, 1024, 4096, 16384}, {60, 120, 480}, {0.01, 0.001}},
      {"soft", 2.5, 0.05, {64, 256, 1024, 4096, 16384}, {}, {}},
      {"chain-hang", 2, 0.005, {64, 256, 1024, 4096, 16384}, {60, 120, 480}, {0.01, 0.003, 0.001}},
      {"chain-heavy", 2, 0.02, {64, 256, 1024, 4096}, {60, 120, 480}, {0.01, 0.003, 0.001}},
      {"chain-swing", 1, 0, {64, 256, 1024, 4096, 16384}, {60, 120, 480, 960}, {0.01, 0.003, 0.001}},
      {"stack", 3, 0.005, {64, 256, 1024, 4096}, {60, 120, 480}, {0.01}},
      {"bowls", 4, 0.005, {256, 1024, 4096}, {60, 120}, {0.03, 0.01}},
  };
  return all;
}

Way packingOf(std::size_t spheres, Response response, double rate) {
  Way way;
  way.spheres = spheres;
  way.response = response;
  way.rate = rate;
  return way;
}

/// `all`: with every budget, or else with one that does well.
void addOtherShapes(const Subject& subject, double rate, bool all, std::vector<Way>& ways) {
  Way way;
  way.rate = rate;
  way.shape = BodyShape::gimpact;
  ways.push_back(way);
  way.shape = BodyShape::convex;
  for (const double concavity : subject.concavities) {
    way.concavity = concavity;
    if (all || concavity == subject.concavities.back()) ways.push_back(way);
  }
  way.shape = BodyShape::spheres;
  for (const std::size_t spheres : {std::size_t{64}, std::size_t{256}, std::size_t{1024}}) {
    way.spheres = spheres;
    if (all || spheres == 256) ways.push_back(way);
  }
}

std::vector<Way> waysOf(const Subject& subject, const TradeOptions& options) {
  std::vector<Way> ways;
  for (const std::size_t spheres : subject.spheres) {
    if (spheres > options.most_spheres) continue;
    ways.push_back(packingOf(spheres, Response::compliant, 240));
    if (cudaAvailable()) {
      ways.push_back(ways.back());
      ways.back().backend = Backend::cuda;
    }
    if (subject.scene == "soft") {
      ways.push_back(packingOf(spheres, Response::compliant, 240));
      ways.back().estimator = Estimator::raw;
      continue;
    }
    ways.push_back(packingOf(spheres, Response::rigid, 240));
    if (spheres >= 256 && spheres <= 4096) ways.push_back(packingOf(spheres, Response::penalty, 240));
  }
  if (subject.scene == "soft") return ways;  // nothing else knows volumes
  for (const double rate : subject.rates) {
    ways.push_back(packingOf(1024, Response::compliant, rate));
    ways.push_back(packingOf(1024, Response::rigid, rate));
  }
  addOtherShapes(subject, 240, true, ways);
  if (subject.scene != "bowls") addOtherShapes(subject, 60, false, ways);
  if (subject.scene == "chain-swing") addOtherShapes(subject, 960, false, ways);
  return ways;
}

demo::ScenePlay playOf(const Subject& subject, const Way& way, PackingStore& store) {
  demo::SceneOptions options;
  options.seconds = subject.seconds;
  options.dt = 1 / way.rate;
  options.spheres = way.spheres;
  options.contact.response = way.response;
  options.contact.estimator = way.estimator;
  options.contact.backend = way.backend;
  options.bodies.shape = way.shape;
  options.bodies.concavity = way.concavity;
  options.bodies.packing = [&store](const Solid& solid, std::size_t, const Progress&) {
    return store.of(solid);
  };
  return demo::play(demo::sceneNamed(subject.scene), options);
}

double stepTime(const demo::Recording& recording) {
  double sum = 0;
  for (std::size_t i = 1 + kWarmUp; i < recording.steps.size(); ++i) sum += recording.steps[i].processor_time;
  return 1e6 * sum / static_cast<double>(recording.steps.size() - 1 - kWarmUp);
}

std::size_t piecesOf(const demo::ScenePlay& play, const Way& way) {
  std::size_t most = 0;
  for (const demo::SceneSolid& solid : play.world->solids()) {
    most = std::max(
        most, solid.other ? solid.other->parts() : std::min(way.spheres, solid.packing->spheres.size()));
  }
  return most;
}

/// Root mean square distance of the bodies' centres from where they are in another recording, relative to the
/// extent of the bodies at the start; sixty times a second.
double trajectoryError(const demo::Recording& recording, const demo::Recording& reference) {
  double sum = 0, extent = 0;
  std::size_t count = 0;
  const std::size_t bodies = reference.names.size();
  for (int frame = 1; frame <= std::lround(60 * reference.seconds()); ++frame) {
    const std::size_t s = recording.stepAt(frame / 60.0), t = reference.stepAt(frame / 60.0);
    for (std::size_t i = 0; i < bodies; ++i, ++count) {
      for (int k = 0; k < 3; ++k) {
        sum += std::pow(recording.body(i, s).position[k] - reference.body(i, t).position[k], 2);
      }
    }
  }
  for (int k = 0; k < 3; ++k) {
    extent += std::pow(reference.first(bodies - 1).position[k] - reference.first(0).position[k], 2);
  }
  return std::sqrt(sum / static_cast<double>(count) / extent);
}

/// [%]; 1,000 for what is farther off, or no number.
double relativeError(const Subject& subject, const demo::Verdict& verdict) {
  const double off = std::fabs(verdict.measured - verdict.truth.expected) / verdict.truth.tolerance;
  const double error = 100 * subject.tolerance * off;
  return error <= 1000 ? error : 1000;
}

class Measurement {
 public:
  Measurement(const TradeOptions& options, PackingStore& store, TradeTable& table)
      : options_(options), store_(store), table_(table) {}

  void measure(const Subject& subject) {
    const std::vector<Way> ways = waysOf(subject, options_);
    results_.assign(ways.size(), {});
    if (subject.scene == "chain-swing") {
      report(subject.scene, "the reference");
      // Fine runs with 1,024, 4,096 and 16,384 spheres, compliant or rigid, agree to 0.001 % of the length.
      const std::size_t spheres = std::min<std::size_t>(4096, options_.most_spheres);
      reference_ = playOf(subject, packingOf(spheres, Response::compliant, 1920), store_).recording;
    }
    for (std::size_t pass = 0; pass < options_.passes; ++pass) {
      for (std::size_t i = 0; i < ways.size(); ++i) {
        if (results_[i].wall > kLongRun) continue;
        report(subject.scene, std::to_string(i + 1) + "/" + std::to_string(ways.size()) + " pass " +
                                  std::to_string(pass + 1) + ", " + describe(ways[i]));
        run(subject, ways[i], results_[i]);
      }
    }
    for (std::size_t i = 0; i < ways.size(); ++i) {
      for (Measured& measured : results_[i].measured) {
        measured.time = results_[i].time;
        table_.add(ways[i], measured);
      }
    }
  }

 private:
  struct Result {
    std::vector<Measured> measured;
    double time = std::numeric_limits<double>::infinity();
    double wall = 0;
  };

  static void report(const std::string& scene, const std::string& what) {
    std::fprintf(stderr, "%s: %s\n", scene.c_str(), what.c_str());
  }

  void run(const Subject& subject, const Way& way, Result& result) {
    const auto start = std::chrono::steady_clock::now();
    const demo::ScenePlay play = playOf(subject, way, store_);
    result.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.time = std::min(result.time, stepTime(play.recording));
    if (!result.measured.empty()) return;
    Measured worst{subject.scene, "worst", piecesOf(play, way), 0, 0, "%", 0};
    for (const demo::Verdict& verdict : play.verdicts) {
      if (verdict.outcome == demo::Outcome::not_recorded) continue;
      Measured one = worst;
      one.measure = verdict.truth.what;
      one.value = verdict.measured;
      if (verdict.truth.kind == demo::Truth::Kind::equal) {
        one.error = relativeError(subject, verdict);
        worst.error = std::max(worst.error, one.error);
      } else {  // of what should be 0
        const bool pure = verdict.truth.unit.empty();
        one.error = pure ? 100 * verdict.measured : verdict.measured;
        one.unit = pure ? "%" : verdict.truth.unit;
      }
      result.measured.push_back(one);
    }
    if (subject.scene == "chain-swing") {
      worst.measure = "trajectory";
      worst.error = 100 * trajectoryError(play.recording, reference_);
    }
    worst.value = worst.error;
    result.measured.push_back(worst);
    report("  ", std::to_string(worst.error) + " %, " + std::to_string(result.time) + " us");
  }

  const TradeOptions& options_;
  PackingStore& store_;
  TradeTable& table_;
  demo::Recording reference_;
  std::vector<Result> results_;
};

}  // namespace

std::vector<std::string> tradeScenes() {
  std::vector<std::string> names;
  for (const Subject& subject : subjects()) names.push_back(subject.scene);
  return names;
}

void measureScenes(const TradeOptions& options, PackingStore& store, TradeTable& table) {
  for (const Subject& subject : subjects()) {
    const auto& wanted = options.scenes;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), subject.scene) == wanted.end()) continue;
    Measurement(options, store, table).measure(subject);
  }
}

}  // namespace innersphere::benchmarks
