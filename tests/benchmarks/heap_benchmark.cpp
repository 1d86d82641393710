// What a heap of wedges in a shaft costs at 60 Hz while it falls and once it lies, in time and in memory, as
// packings or as convex hulls. One kind a run, so that each has the memory of the process for itself.
#include <btBulletDynamicsCommon.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing_collision_algorithm.hpp"
#include "innersphere/packing_shape.hpp"
#include "machine.hpp"
#include "scenes/shapes.hpp"
#include "timing.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

struct Settings {
  int bodies = 30;
  std::size_t spheres = 256;
  double rate = 60;  // [1/s]
  double seconds = 20;
  bool hulls = false;
};

/// Of this process now [MiB].
double residentMemory() {
  std::ifstream statm("/proc/self/statm");
  double size = 0, resident = 0;
  statm >> size >> resident;
  return resident * double(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

/// A stone of an arch, 1 m high, with its middle at the origin: 8 corners.
Mesh wedge() {
  demo::Outline outline;
  outline.addQuad(outline.add({-0.35, -0.5}), outline.add({0.35, -0.5}), outline.add({0.5, 0.5}),
                  outline.add({-0.5, 0.5}));
  Mesh mesh = demo::prism(outline, 0.6);
  for (auto& vertex : mesh.vertices) vertex[2] -= 0.3F;
  return mesh;
}

std::unique_ptr<btCollisionShape> hullOf(const Mesh& mesh) {
  auto hull = std::make_unique<btConvexHullShape>();
  for (const auto& v : mesh.vertices)
    hull->addPoint(btVector3(btScalar(v[0]), btScalar(v[1]), btScalar(v[2])));
  hull->setMargin(btScalar(0.005));
  return hull;
}

std::unique_ptr<btCollisionShape> packingOf(const Mesh& mesh, std::size_t spheres) {
  PackOptions options;
  options.spheres = spheres;
  options.overlap_errors = false;
  auto packing = std::make_shared<Packing>(pack(*makeSolid(mesh, "wedge"), options));
  return std::make_unique<PackingShape>(std::make_shared<CollisionModel>(packing));
}

void run(const Settings& settings) {
  const Mesh mesh = wedge();
  const std::unique_ptr<btCollisionShape> shape =
      settings.hulls ? hullOf(mesh) : packingOf(mesh, settings.spheres);
  const double without = residentMemory();
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  PackingCollisionAlgorithm::prepareWorld(world);
  world.setGravity(btVector3(0, 0, -10));
  // A floor, and walls that are two metres apart.
  btStaticPlaneShape planes[] = {{btVector3(0, 0, 1), 0},
                                 {btVector3(1, 0, 0), -1},
                                 {btVector3(-1, 0, 0), -1},
                                 {btVector3(0, 1, 0), -1},
                                 {btVector3(0, -1, 0), -1}};
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  const auto add = [&](btScalar mass, btCollisionShape& of, const btTransform& place) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) of.calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &of, inertia);
    info.m_startWorldTransform = place;
    bodies.push_back(std::make_unique<btRigidBody>(info));
    bodies.back()->setActivationState(mass > 0 ? DISABLE_DEACTIVATION : ISLAND_SLEEPING);
    world.addRigidBody(bodies.back().get());
  };
  for (btStaticPlaneShape& plane : planes) add(0, plane, btTransform::getIdentity());
  for (int i = 0; i < settings.bodies; ++i) {
    const btQuaternion turn(btVector3(1, btScalar(i % 3), btScalar(i % 5)).normalized(), btScalar(i));
    add(1, *shape,
        btTransform(turn, btVector3(btScalar(0.1 * (i % 4 - 1.5)), btScalar(0.1 * (i % 7 - 3)),
                                    btScalar(1.3 * (i + 1)))));
  }
  std::vector<double> steps, last;
  const int count = int(settings.seconds * settings.rate);
  double most = 0;
  for (int i = 0; i < count; ++i) {
    const std::clock_t start = std::clock();
    world.stepSimulation(btScalar(1 / settings.rate), 0, btScalar(1 / settings.rate));
    steps.push_back(1e3 * double(std::clock() - start) / CLOCKS_PER_SEC);
    if (i >= count - int(settings.rate)) last.push_back(steps.back());
    most = std::max(most, residentMemory() - without);
  }
  int contacts = 0;
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i)
    contacts += dispatcher.getManifoldByIndexInternal(i)->getNumContacts();
  std::printf(
      "| shape | a step, median [ms] | 99 %% | of the last second, median | resident memory without the "
      "world [MiB] | "
      "what the world adds, at most | at the end | contact points at the end "
      "|\n|---|---|---|---|---|---|---|---|\n");
  std::printf("| %s | %.3f | %.2f | %.3f | %.1f | %.1f | %.1f | %d |\n", settings.hulls ? "hull" : "packing",
              median(steps), quantile(steps, 0.99), median(last), without, most, residentMemory() - without,
              contacts);
  for (const auto& body : bodies) world.removeRigidBody(body.get());
}

}  // namespace

int main(int argc, char** argv) try {
  Settings settings;
  CLI::App app("Cost of a heap of wedges, in time and memory.");
  app.add_option("--bodies", settings.bodies, "number of wedges")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--spheres", settings.spheres, "of the packing")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--rate", settings.rate, "steps a second")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--seconds", settings.seconds, "that it falls and lies, at least 1")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 1000.0));
  app.add_flag("--hulls", settings.hulls, "convex hulls instead of packings");
  CLI11_PARSE(app, argc, argv);
  std::printf("%s\n", heading("Cost of a heap of wedges", argc, argv).c_str());
  run(settings);
  return 0;
} catch (const innersphere::Error& error) {
  std::fprintf(stderr, "%s: %s\n", toString(error.code()), error.what());
  return 3;
}
