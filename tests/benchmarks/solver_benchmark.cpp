// What SubstepSolver costs beside Bullet's solvers, with one thread and more: all solve the same steps of
// piles that lie. And what a whole step of these piles costs.
#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "bin_of_bodies.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing_collision_algorithm.hpp"
#include "innersphere/packing_shape.hpp"
#include "innersphere/solids.hpp"
#include "innersphere/substep_solver.hpp"
#include "machine.hpp"
#include "solver_trial.hpp"
#include "timing.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

struct Settings {
  std::vector<int> boxes{512, 1000}, packings{1000}, threads{1, 2, 4, 8, 16};
  std::size_t spheres = 4000;
  double settle = 8;
  int samples = 30;
  double rate = 60;
  Backend backend = Backend::cpu;
  std::string csv;

  double step() const { return 1 / rate; }
};

/// Boxes of half a metre.
BinOptions binOfBoxes(int bodies) {
  BinOptions bin;
  bin.bodies = bodies;
  bin.pitch = bin.layer = 0.62;
  const btVector3 half(btScalar(0.25), btScalar(0.25), btScalar(0.25));
  bin.make = [half](int) { return std::make_shared<btBoxShape>(half); };
  btBoxShape(half).calculateLocalInertia(1, bin.inertia);
  bin.prepare = [](btDiscreteDynamicsWorld& world) {
    world.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  };
  return bin;
}

BinOptions binOfTori(int bodies, const std::shared_ptr<const CollisionModel>& model, Backend backend) {
  BinOptions bin;
  bin.bodies = bodies;
  bin.batched = true;
  bin.make = [model](int) { return std::make_shared<PackingShape>(model); };
  PackingShape(model).calculateLocalInertia(1, bin.inertia);
  bin.prepare = [backend](btDiscreteDynamicsWorld& world) {
    ContactOptions options;
    options.backend = backend;
    PackingCollisionAlgorithm::prepareWorld(world, options);
  };
  return bin;
}

std::shared_ptr<btConstraintSolver> substepSolver(int substeps) {
  SubstepOptions options;
  options.substeps = substeps;
  return std::make_shared<SubstepSolver>(options);
}

class Pile {
 public:
  Pile(const Settings& settings, const std::string& name, BinOptions bin)
      : settings_(settings), name_(name), bodies_(bin.bodies), trial_(std::make_shared<SolverTrial>()) {
    trial_->add("Bullet, 10 iterations", std::make_shared<btSequentialImpulseConstraintSolver>(), 1);
    trial_->add("Bullet NNCG, 10 iterations", std::make_shared<btNNCGConstraintSolver>(), 1);
    for (const int substeps : {4, 8, 16}) {
      for (const int threads : settings.threads)
        trial_->add("SubstepSolver, " + std::to_string(substeps), substepSolver(substeps), threads);
    }
    trial_->lead = substepSolver(0);
    bin.solver = substepSolver(8);
    bin_ = std::make_unique<BinOfBodies>(bin);
    tbb::task_arena(settings.threads.back()).execute([&] {
      for (double t = 0; t < settings.settle; t += settings.step()) bin_->step(settings.step());
    });
  }

  /// What the solvers alone take.
  void compare(std::FILE* csv) {
    bin_->solveWith(trial_);
    trial_->measures = true;
    for (int i = 0; i < settings_.samples; ++i) bin_->step(settings_.step());
    trial_->measures = false;
    const int points = trial_->points();
    const double first = median(trial_->candidates.front().times);
    std::printf(
        "\n%s, %d points of contact:\n\n| solver | threads | time [ms] | first row = 1 | for a body [us] | "
        "for a row [ns] |\n|---|---|---|---|---|---|\n",
        name_.c_str(), points);
    for (const SolverTrial::Candidate& candidate : trial_->candidates) {
      const double time = median(candidate.times);
      std::printf("| %s | %d | %.3f | %.2f | %.2f | %.0f |\n", candidate.name.c_str(), candidate.threads,
                  time / 1e3, time / first, time / bodies_, 1e3 * time / (3 * points));
      if (csv != nullptr)
        std::fprintf(csv, "%s,%d,%d,\"%s\",%d,%.4f\n", name_.c_str(), bodies_, points, candidate.name.c_str(),
                     candidate.threads, time / 1e3);
    }
  }

  /// What a step takes, with its parts.
  void steps() {
    std::printf(
        "\n%s, the whole step:\n\n| solver | threads | step [ms] | narrow phase [ms] | solver and islands "
        "[ms] | the rest "
        "[ms] |\n|---|---|---|---|---|---|\n",
        name_.c_str());
    struct Kind {
      const char* name;
      std::shared_ptr<btConstraintSolver> solver;
      bool split;
    };
    const Kind kinds[] = {
        {"SubstepSolver, 8, without Bullet's islands", substepSolver(8), false},
        {"SubstepSolver, 8", substepSolver(8), true},
        {"SubstepSolver, as it chooses", substepSolver(0), true},
        {"Bullet, 10 iterations", std::make_shared<btSequentialImpulseConstraintSolver>(), true}};
    for (const auto& [name, solver, split] : kinds) {
      bin_->solveWith(solver);  // contacts are told of as for this one
      bin_->splitIslands(split);
      for (const int threads : settings_.threads) {
        std::vector<double> all, narrow, solving, rest;
        tbb::task_arena(threads).execute([&] {
          for (int i = 0; i < settings_.samples; ++i) {
            const StepTime time = bin_->step(settings_.step());
            all.push_back(time.all);
            narrow.push_back(time.narrow_phase);
            solving.push_back(time.solver);
            rest.push_back(time.all - time.narrow_phase - time.solver);
          }
        });
        std::printf("| %s | %d | %.2f | %.2f | %.2f | %.2f |\n", name, threads, median(all) / 1e3,
                    median(narrow) / 1e3, median(solving) / 1e3, median(rest) / 1e3);
      }
    }
  }

 private:
  const Settings& settings_;
  std::string name_;
  int bodies_;
  std::shared_ptr<SolverTrial> trial_;
  std::unique_ptr<BinOfBodies> bin_;
};

void run(const Settings& settings) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> csv(
      settings.csv.empty() ? nullptr : std::fopen(settings.csv.c_str(), "w"), std::fclose);
  if (!settings.csv.empty() && !csv)
    throw Error(ErrorCode::write_failed, "Cannot write " + settings.csv + ".");
  if (csv) std::fprintf(csv.get(), "pile,bodies,points,solver,threads,ms\n");
  const auto measure = [&](const std::string& name, const BinOptions& bin) {
    Pile pile(settings, name, bin);
    pile.steps();
    pile.compare(csv.get());
  };
  for (const int bodies : settings.boxes)
    measure(std::to_string(bodies) + " boxes of Bullet's", binOfBoxes(bodies));
  if (settings.packings.empty()) return;
  PackOptions options;
  options.spheres = settings.spheres;
  const auto model =
      std::make_shared<CollisionModel>(std::make_shared<Packing>(pack(*makeTorus(kRing, kTube), options)));
  for (const int bodies : settings.packings)
    measure(std::to_string(bodies) + " tori of " + std::to_string(settings.spheres) + " spheres",
            binOfTori(bodies, model, settings.backend));
}

}  // namespace

int main(int argc, char** argv) try {
  Settings settings;
  CLI::App app("Cost of constraint solvers: piles in a bin, solved by all of them.");
  app.add_option("--boxes", settings.boxes, "piles of so many boxes; 0: none")->delimiter(',');
  app.add_option("--packings", settings.packings, "piles of so many packed tori; 0: none")->delimiter(',');
  app.add_option("--threads", settings.threads, "numbers of threads, rising")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  app.add_option("--spheres", settings.spheres, "of each packing")->capture_default_str();
  app.add_option("--settle", settings.settle, "time before the first measured step [s]")
      ->capture_default_str();
  app.add_option("--samples", settings.samples, "measured steps")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--rate", settings.rate, "steps a second")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--backend", settings.backend, "of the packings' queries: auto, cpu or cuda")
      ->transform(CLI::CheckedTransformer(kBackends, CLI::ignore_case));
  app.add_option("--csv", settings.csv, "a file for the table of the solvers alone");
  CLI11_PARSE(app, argc, argv);
  for (std::vector<int>* piles : {&settings.boxes, &settings.packings}) {
    if (*piles == std::vector<int>{0}) piles->clear();
  }
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(settings.threads.back()));
  std::printf("%s", heading("Cost of solvers", argc, argv).c_str());
  std::printf("\nMedians of %d steps of 1/%g s.\n", settings.samples, settings.rate);
  run(settings);
  return 0;
} catch (const innersphere::Error& error) {
  std::fprintf(stderr, "%s: %s\n", toString(error.code()), error.what());
  return 3;
}
