// Steps many small worlds of one scene: each thread its own, with queries of their own or shared ones.
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "innersphere/batched_dispatcher.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packing_collision_algorithm.hpp"
#include "innersphere/query_queue.hpp"
#include "machine.hpp"
#include "scenes/scene.hpp"
#include "scenes/world.hpp"
#include "timing.hpp"

namespace {

using namespace innersphere;

constexpr double kStep = 1.0 / 240;  // [s]

/// A world with the bodies of a scene, whose shapes it shares.
class World {
 public:
  World(demo::SceneWorld& scene, const ContactOptions& options) {
    world_.setGravity(scene.bullet().getGravity());
    PackingCollisionAlgorithm::prepareWorld(world_, options);
    for (const demo::SceneBody& of : scene.bodies()) {
      btRigidBody& like = *of.body;
      const btScalar mass = like.getInvMass() > 0 ? 1 / like.getInvMass() : btScalar(0);
      const btVector3 inverse = like.getInvInertiaDiagLocal();
      btVector3 inertia(0, 0, 0);
      if (mass > 0) inertia = btVector3(1 / inverse.x(), 1 / inverse.y(), 1 / inverse.z());
      btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, like.getCollisionShape(), inertia);
      info.m_startWorldTransform = like.getWorldTransform();
      info.m_friction = like.getFriction();
      bodies_.push_back(std::make_unique<btRigidBody>(info));
      bodies_.back()->setLinearVelocity(like.getLinearVelocity());
      bodies_.back()->setAngularVelocity(like.getAngularVelocity());
      bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
      world_.addRigidBody(bodies_.back().get());
    }
  }
  ~World() {
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
    PackingCollisionAlgorithm::unregisterAlgorithm(&dispatcher_);
  }

  void step() { world_.stepSimulation(btScalar(kStep), 0); }

  /// Sums up where the bodies are, to compare motions.
  double place() const {
    double sum = 0;
    for (const auto& body : bodies_) {
      const btVector3& at = body->getWorldTransform().getOrigin();
      sum += double(at.x()) + 3 * double(at.y()) + 7 * double(at.z());
    }
    return sum;
  }

 private:
  btDefaultCollisionConfiguration configuration_;
  BatchedDispatcher<> dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

/// Calls work(i) for each i < count, by so many threads.
template <typename Work>
void inThreads(std::size_t threads, std::size_t count, const Work& work) {
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> crew;
  for (std::size_t t = 0; t < threads; ++t) {
    crew.emplace_back([&] {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    });
  }
  for (std::thread& thread : crew) thread.join();
}

struct Way {
  const char* name;
  Backend backend;
  bool shared;
  bool a_thread_each;  ///< for each world
};
constexpr Way kWays[] = {{"CPU", Backend::cpu, false, false},
                         {"device, queries of its own", Backend::cuda, false, false},
                         {"device, shared queries, a thread a world", Backend::cuda, true, true}};

void measure(const std::string& name, const std::vector<std::size_t>& counts, std::size_t steps,
             std::size_t threads, std::size_t limit) {
  const demo::Scene& scene = demo::sceneNamed(name);
  const demo::SceneOptions options = demo::completed(scene, {});
  demo::SceneWorld like(options.contact);
  scene.build(like, options);
  for (const std::size_t count : counts) {
    double before = 0;
    for (const Way& way : kWays) {
      if (way.backend == Backend::cuda && !cudaAvailable()) continue;
      if (count > limit && way.backend == Backend::cuda && !way.shared) continue;
      ContactOptions contact = options.contact;
      contact.backend = way.backend;
      if (way.shared) contact.queue = std::make_shared<QueryQueue>(QueryContextOptions{way.backend});
      std::vector<std::unique_ptr<World>> worlds(count);
      inThreads(threads, count, [&](std::size_t i) { worlds[i] = std::make_unique<World>(like, contact); });
      const std::size_t crew = way.a_thread_each ? count : threads;
      inThreads(crew, count, [&](std::size_t i) {
        const std::size_t ahead = 20 + i * 37 % 64;  // so that they are not all in the same step
        for (std::size_t s = 0; s < ahead; ++s) worlds[i]->step();
      });
      const double time = benchmarks::timeOf([&] {
        inThreads(crew, count, [&](std::size_t i) {
          for (std::size_t s = 0; s < steps; ++s) worlds[i]->step();
        });
      });
      double place = 0;
      for (const auto& world : worlds) place += world->place();
      const double rate = static_cast<double>(count * steps) / (1e-6 * time);
      if (before == 0) before = rate;
      std::printf("| %s | %zu | %s | %.0f | %.2f | ", name.c_str(), count, way.name, rate, rate / before);
      if (contact.queue)
        std::printf("%.0f |",
                    static_cast<double>(contact.queue->calls()) /
                        static_cast<double>(std::max<std::size_t>(contact.queue->sharedQueries(), 1)));
      else
        std::printf("|");
      std::printf(" %.17g |\n", place);
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Step many small worlds.");
  std::vector<std::string> names{"nut", "peg", "chain-swing", "chain-hang"};
  std::vector<std::size_t> counts{256, 1024};
  std::size_t steps = 120, threads = 16, tasks = 1, limit = 256;
  app.add_option("--scenes", names, "Whose worlds")->delimiter(',');
  app.add_option("--worlds", counts, "At once")->delimiter(',');
  app.add_option("--steps", steps, "Of each world");
  app.add_option("--threads", threads, "Where threads take one world after the other");
  app.add_option("--tasks", tasks, "Threads that a step or query may use beside its own");
  app.add_option("--limit", limit, "Most worlds with queries of their own on the device");
  CLI11_PARSE(app, argc, argv);
  std::printf("%s\n", benchmarks::heading("Many worlds", argc, argv).c_str());
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, tasks);
  std::printf(
      "| scene | worlds | way | steps/s | ratio | calls a query | sum of places "
      "|\n|---|---|---|---|---|---|---|\n");
  try {
    for (const std::string& name : names) measure(name, counts, steps, threads, limit);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
