// What a step of a Bullet world with packings costs, beside triangle meshes and compounds of spheres in the
// same world, and what each feature adds. One world falls; the others are set to its state before a step that
// is measured, so that all do the same work, one after the other, in the same run.
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

#include "bin_of_bodies.hpp"
#include "innersphere/contact_drawer.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing_collision_algorithm.hpp"
#include "innersphere/packing_shape.hpp"
#include "innersphere/pair_overlaps.hpp"
#include "innersphere/solids.hpp"
#include "machine.hpp"
#include "timing.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

struct Settings {
  int bodies = 20;
  std::size_t spheres = 4000;
  double settle = 2;
  double dt = 1.0 / 120;
  int samples = 15;
  Backend backend = Backend::automatic;
  bool compare = true;
};

/// In a row for a sample: what a pair keeps from step to step counts as in a simulation.
constexpr int kSteps = 16;

using Models = std::shared_ptr<const CollisionModel>;

std::shared_ptr<btGImpactMeshShape> gimpactTorus() {
  constexpr int kRings = 32, kSegments = 16;
  static btTriangleMesh mesh;
  if (mesh.getNumTriangles() == 0) {
    const auto at = [](int i, int j) {
      const double a = 2 * M_PI * i / kRings, b = 2 * M_PI * j / kSegments;
      const double r = kRing + kTube * std::cos(b);
      return btVector3(btScalar(r * std::cos(a)), btScalar(r * std::sin(a)), btScalar(kTube * std::sin(b)));
    };
    for (int i = 0; i < kRings; ++i) {
      for (int j = 0; j < kSegments; ++j) {
        mesh.addTriangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
        mesh.addTriangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }
  auto shape = std::make_shared<btGImpactMeshShape>(&mesh);
  shape->setMargin(btScalar(0.01));
  shape->updateBound();
  return shape;
}

std::shared_ptr<btCompoundShape> compoundTorus(const Packing& packing) {
  static std::vector<std::unique_ptr<btSphereShape>> spheres;
  auto compound = std::make_shared<btCompoundShape>();
  for (std::size_t i = 0; i < 64; ++i) {
    const Sphere& s = packing.spheres[i];
    if (spheres.size() <= i) spheres.push_back(std::make_unique<btSphereShape>(s.radius));
    compound->addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(s.x, s.y, s.z)),
                            spheres[i].get());
  }
  return compound;
}

/// What is drawn costs what is worked out for it, not the drawing.
class NoScreen : public btIDebugDraw {
 public:
  void drawLine(const btVector3&, const btVector3&, const btVector3&) override {}
  void drawContactPoint(const btVector3&, const btVector3&, btScalar, int, const btVector3&) override {}
  void reportErrorWarning(const char*) override {}
  void draw3dText(const btVector3&, const char*) override {}
  void setDebugMode(int) override {}
  int getDebugMode() const override { return DBG_DrawWireframe; }
};

btCollisionDispatcher* dispatcherOf(btDiscreteDynamicsWorld& world) {
  return static_cast<btCollisionDispatcher*>(world.getDispatcher());
}

class Benchmark {
 public:
  Benchmark(const Settings& settings, const Models& model) : settings_(settings), model_(model) {
    PackingShape(model_).calculateLocalInertia(1, inertia_);
  }

  void addPackings(const std::string& name, const Models& model, const ContactOptions& options,
                   std::size_t spheres = 0, bool batched = false, double margin = 0) {
    ContactOptions own = options;
    own.backend = settings_.backend;
    add(
        name, batched,
        [own](btDiscreteDynamicsWorld& world) {
          PackingCollisionAlgorithm::registerAlgorithm(dispatcherOf(world), own);
        },
        [=](int) {
          auto shape = std::make_shared<PackingShape>(model);
          shape->setSphereCount(spheres);
          shape->setMargin(btScalar(margin));
          return shape;
        });
  }
  void add(const std::string& name, bool batched,
           const std::function<void(btDiscreteDynamicsWorld&)>& prepare,
           const std::function<std::shared_ptr<btCollisionShape>(int)>& make) {
    BinOptions bin;
    bin.bodies = settings_.bodies;
    bin.batched = batched;
    bin.prepare = prepare;
    bin.make = make;
    bin.inertia = inertia_;
    kinds_.push_back({name, std::make_unique<BinOfBodies>(bin), {}, {}, {}, {}, 0});
  }

  /// Of the kind that was added last.
  void afterEachStep(const std::function<void(btDiscreteDynamicsWorld&)>& work) {
    kinds_.back().world->after_step = work;
  }

  /// The first kind leads.
  void run() {
    BinOfBodies& lead = *kinds_.front().world;
    const int settle = static_cast<int>(settings_.settle / settings_.dt);
    for (int i = 0; i < settle; ++i) lead.step(settings_.dt);
    for (int sample = 0; sample < settings_.samples; ++sample) {
      std::vector<std::vector<BodyState>> states;
      for (int i = 0; i <= kSteps; ++i) {
        states.push_back(lead.state());
        lead.step(settings_.dt);
      }
      const std::vector<BodyState> after = lead.state();
      for (Kind& kind : kinds_) {
        // The first step brings new pairs and lets the contacts of the last sample go.
        StepTime sum;
        for (int i = 0; i <= kSteps; ++i) {
          kind.world->setState(states[i]);
          const StepTime time = kind.world->step(settings_.dt);
          if (i == 0) continue;
          sum.all += time.all / kSteps;
          sum.narrow_phase += time.narrow_phase / kSteps;
          sum.processors += time.processors / kSteps;
        }
        kind.all.push_back(sum.all);
        kind.narrow.push_back(sum.narrow_phase);
        kind.rest.push_back(sum.all - sum.narrow_phase);
        kind.processors.push_back(sum.processors);
        kind.contacts = kind.world->contacts();
      }
      lead.setState(after);
    }
  }

  void print() const {
    std::printf(
        "| shape | step [ms] | narrow phase [ms] | the rest [ms] | processor time of the step [ms] | the "
        "same,"
        " first row = 1 | contact points |\n|---|---|---|---|---|---|---|\n");
    const double first = median(kinds_.front().processors);
    for (const Kind& kind : kinds_) {
      std::printf("| %s | %.2f | %.2f | %.2f | %.2f | %.2f | %d |\n", kind.name.c_str(),
                  median(kind.all) / 1e3, median(kind.narrow) / 1e3, median(kind.rest) / 1e3,
                  median(kind.processors) / 1e3, median(kind.processors) / first, kind.contacts);
    }
  }

 private:
  struct Kind {
    std::string name;
    std::unique_ptr<BinOfBodies> world;
    std::vector<double> all, narrow, rest, processors;
    int contacts;
  };
  const Settings& settings_;
  Models model_;
  btVector3 inertia_{0, 0, 0};
  std::vector<Kind> kinds_;
};

void run(const Settings& settings) {
  PackOptions pack_options;
  pack_options.spheres = settings.spheres;
  const auto packing = std::make_shared<Packing>(pack(*makeTorus(kRing, kTube), pack_options));
  auto bare = std::make_shared<Packing>(*packing);
  bare->surface = {};
  const auto model = std::make_shared<CollisionModel>(packing);

  Benchmark benchmark(settings, model);
  const std::string n = std::to_string(settings.spheres);
  benchmark.addPackings("packing, " + n + " spheres", model, {});
  benchmark.addPackings("the same with BatchedDispatcher", model, {}, 0, true);
  if (settings.compare) {
    benchmark.add(
        "GImpact, 1,024 triangles", false,
        [](btDiscreteDynamicsWorld& world) {
          btGImpactCollisionAlgorithm::registerAlgorithm(dispatcherOf(world));
        },
        [](int) { return gimpactTorus(); });
    benchmark.add(
        "btCompoundShape of 64 spheres", false, [](btDiscreteDynamicsWorld&) {},
        [&](int) { return compoundTorus(*packing); });
    for (const std::size_t count : {1024, 256, 64}) {
      benchmark.addPackings("packing, its first " + std::to_string(count), model, {}, count);
    }
    ContactOptions options;
    options.accuracy = 0.1;
    benchmark.addPackings("packing, accuracy 0.1 m", model, options);
    options = {};
    options.response = Response::rigid;
    benchmark.addPackings("packing, rigid", model, options);
    options.response = Response::penalty;
    benchmark.addPackings("packing, penalty", model, options);
    options = {};
    options.stiffness = 1e5;
    benchmark.addPackings("packing, depth by volume", model, options);
    benchmark.addPackings("packing without a surface", std::make_shared<CollisionModel>(bare), {});
    benchmark.addPackings("packing, margin 0.01 m", model, {}, 0, false, 0.01);
    benchmark.addPackings("packing, pairOverlaps() after each step", model, {});
    benchmark.afterEachStep([](btDiscreteDynamicsWorld& world) { pairOverlaps(dispatcherOf(world)); });
    const std::pair<const char*, Reuse> least[] = {{"nothing idle", Reuse::transport},
                                                   {"nothing transported", Reuse::refine},
                                                   {"nothing reused", Reuse::search}};
    for (const auto& [name, reuse] : least) {
      options = {};
      options.reuse = reuse;
      benchmark.addPackings(std::string("packing, ") + name, model, options);
    }
    ContactDrawerOptions drawn;
    for (const bool volumes : {false, true}) {
      drawn.volumes = volumes;
      benchmark.addPackings(
          std::string("packing, drawn by ContactDrawer") + (volumes ? "" : " without volumes"), model, {});
      benchmark.afterEachStep([drawn](btDiscreteDynamicsWorld& world) {
        NoScreen screen;
        ContactDrawer(world, drawn).debugDraw(&screen);
      });
    }
  }
  benchmark.run();
  benchmark.print();
}

}  // namespace

int main(int argc, char** argv) try {
  Settings settings;
  CLI::App app("Cost of a step of a Bullet world: tori in a bin.");
  app.add_option("--bodies", settings.bodies, "number of tori")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--spheres", settings.spheres, "of each packing, at least 64")
      ->capture_default_str()
      ->check(CLI::Range(64, 1000000));
  app.add_option("--settle", settings.settle, "time before the first measured step [s]")
      ->capture_default_str();
  app.add_option("--samples", settings.samples, "measured steps")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--backend", settings.backend, "auto, cpu or cuda")
      ->transform(CLI::CheckedTransformer(kBackends, CLI::ignore_case));
  app.add_flag("!--alone", settings.compare, "only packings, nothing to compare them with");
  CLI11_PARSE(app, argc, argv);
  std::printf(
      "%s",
      heading("Cost of a step: " + std::to_string(settings.bodies) + " tori in a bin", argc, argv).c_str());
  std::printf("\nMedians of %d steps of 1/120 s; every row steps from the same states.\n\n",
              settings.samples);
  run(settings);
  return 0;
} catch (const innersphere::Error& error) {
  std::fprintf(stderr, "%s: %s\n", toString(error.code()), error.what());
  return 3;
}
