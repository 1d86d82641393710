// Bodies at rest: height, tilt, creep and the time until Bullet lets them sleep, on every kind of ground.
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <btBulletDynamicsCommon.h>
#include <CLI/CLI.hpp>

#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing_collision_algorithm.hpp"
#include "innersphere/packing_shape.hpp"
#include "innersphere/solids.hpp"
#include "machine.hpp"

namespace innersphere::benchmarks {
namespace {

struct Options {
  std::vector<std::string> solids{"box", "ball", "torus"};
  std::vector<std::string> grounds{"plane", "box", "mesh", "packing"};
  std::vector<std::string> responses{"compliant", "rigid", "penalty"};
  std::vector<double> rates{240, 60};
  std::size_t spheres = 4000;
  double settle = 4;
  double watch = 10;
};

Response responseNamed(const std::string& name) {
  return name == "rigid" ? Response::rigid : name == "penalty" ? Response::penalty : Response::compliant;
}

/// 1 m across: its bounding sphere has a radius of 0.5 m.
std::shared_ptr<PackingShape> shapeOf(const std::string& name, std::size_t spheres, btScalar radius) {
  static std::map<std::string, std::shared_ptr<const CollisionModel>> models;
  std::shared_ptr<const CollisionModel>& model = models[name];
  if (!model) {
    const bool file = name.find('.') != std::string::npos;
    PackOptions options;
    options.spheres = spheres;
    const auto solid = file ? makeSolid(readMesh(name), name) : makeNamedSolid(name);
    model = std::make_shared<CollisionModel>(std::make_shared<Packing>(pack(*solid, options)));
  }
  auto shape = std::make_shared<PackingShape>(model);
  btVector3 centre;
  btScalar own;
  shape->getBoundingSphere(centre, own);
  shape->setLocalScaling(btVector3(1, 1, 1) * (radius / own));
  return shape;
}

double heightAlong(const PackingShape& shape, const btTransform& body, double sign) {
  double most = -1e9;
  for (const auto& v : shape.model().packing().surface.vertices) {
    const btVector3 at = shape.principalTransform() * btVector3(v[0], v[1], v[2]);
    most = std::max(most, sign * double((body * (shape.getLocalScaling() * at)).z()));
  }
  return sign * most;
}

/// As it was made, with its centre of mass at the origin.
btTransform upright(const PackingShape& shape) {
  return btTransform(shape.principalTransform().inverse().getRotation());
}

/// With its top at z = 0.
class Ground {
 public:
  Ground(const std::string& kind, std::size_t spheres) {
    if (kind == "plane") {
      shape_ = std::make_shared<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0));
    } else if (kind == "box") {
      shape_ = std::make_shared<btBoxShape>(btVector3(5, 5, 1));
      place_.setOrigin(btVector3(0, 0, -1));
    } else if (kind == "mesh") {
      for (int x = -5; x < 5; ++x) {
        for (int y = -5; y < 5; ++y) {
          const btVector3 a(x, y, 0), b(x + 1, y, 0), c(x + 1, y + 1, 0), d(x, y + 1, 0);
          mesh_.addTriangle(a, b, c);
          mesh_.addTriangle(a, c, d);
        }
      }
      shape_ = std::make_shared<btBvhTriangleMeshShape>(&mesh_, true);
    } else {
      const auto packing = shapeOf("box", spheres, 5);
      place_ = upright(*packing);
      place_.setOrigin(btVector3(0, 0, btScalar(-heightAlong(*packing, place_, 1))));
      shape_ = packing;
    }
  }

  btCollisionShape* shape() { return shape_.get(); }
  const btTransform& place() const { return place_; }

 private:
  btTriangleMesh mesh_;
  std::shared_ptr<btCollisionShape> shape_;
  btTransform place_ = btTransform::getIdentity();
};

struct Outcome {
  double height = 0;   ///< of the lowest point above the ground [m]
  double tilt = 0;     ///< since the start [degrees]
  double creep = 0;    ///< while it was watched, of its centre or by turning [m]
  double asleep = -1;  ///< when Bullet put it to sleep [s]; negative: never
};

Outcome drop(const std::string& solid, const std::string& ground_kind, Response response, double rate,
             const Options& options, bool may_sleep) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  ContactOptions contact;
  contact.response = response;
  PackingCollisionAlgorithm::registerAlgorithm(&dispatcher, contact);
  world.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  world.setGravity(btVector3(0, 0, btScalar(-9.81)));

  Ground ground(ground_kind, options.spheres);
  btRigidBody base(0, nullptr, ground.shape());
  base.setWorldTransform(ground.place());
  world.addRigidBody(&base);
  const auto shape = shapeOf(solid, options.spheres, btScalar(0.5));
  btVector3 inertia;
  shape->calculateLocalInertia(1, inertia);
  btRigidBody body(1, nullptr, shape.get(), inertia);
  btTransform start = upright(*shape);
  start.setOrigin(
      btVector3(btScalar(0.013), btScalar(0.027), btScalar(0.02 - heightAlong(*shape, start, -1))));
  body.setWorldTransform(start);
  body.setInterpolationWorldTransform(start);
  if (!may_sleep) body.setActivationState(DISABLE_DEACTIVATION);
  world.addRigidBody(&body);

  Outcome outcome;
  const auto run = [&](double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += 1 / rate) {
      world.stepSimulation(btScalar(1 / rate), 0);
      if (outcome.asleep < 0 && !body.isActive()) outcome.asleep = t + 1 / rate;
    }
  };
  run(options.settle);
  const btTransform settled = body.getWorldTransform();
  outcome.height = heightAlong(*shape, settled, -1);
  outcome.tilt = double(settled.getBasis().getColumn(2).angle(start.getBasis().getColumn(2))) * 180 / M_PI;
  if (!may_sleep) {
    run(options.watch);
    const btTransform after = body.getWorldTransform();
    const double turned = settled.getRotation().angleShortestPath(after.getRotation());
    outcome.creep = settled.getOrigin().distance(after.getOrigin()) + 0.5 * turned;
  }
  world.removeRigidBody(&body);
  world.removeRigidBody(&base);
  return outcome;
}

void printTable(const Options& options) {
  std::printf(
      "| solid | ground | response | steps/s | height, %% of the size | tilt, deg | creep in %g s, mm | "
      "asleep "
      "after, s |\n|---|---|---|---|---|---|---|---|\n",
      options.watch);
  for (const std::string& solid : options.solids) {
    for (const std::string& ground : options.grounds) {
      for (const std::string& response : options.responses) {
        for (double rate : options.rates) {
          const Response r = responseNamed(response);
          const Outcome awake = drop(solid, ground, r, rate, options, false);
          const Outcome sleeping = drop(solid, ground, r, rate, options, true);
          std::printf("| %s | %s | %s | %g | %+.3f | %.2f | %.3f | ", solid.c_str(), ground.c_str(),
                      response.c_str(), rate, awake.height * 100, awake.tilt, awake.creep * 1000);
          if (sleeping.asleep < 0) {
            std::printf("never |\n");
          } else {
            std::printf("%.2f |\n", sleeping.asleep);
          }
          std::fflush(stdout);
        }
      }
    }
  }
}

}  // namespace
}  // namespace innersphere::benchmarks

int main(int argc, char** argv) {
  using namespace innersphere::benchmarks;
  Options options;
  CLI::App app(
      "Bodies of 1 kg and 1 m across, dropped by 2 cm: where they rest, as a Markdown table on stdout");
  app.add_option("solids", options.solids, "Names of solids, or mesh files")->capture_default_str();
  app.add_option("--grounds", options.grounds, "plane, box, mesh, packing")
      ->delimiter(',')
      ->check(CLI::IsMember({"plane", "box", "mesh", "packing"}))
      ->capture_default_str();
  app.add_option("--responses", options.responses, "compliant, rigid, penalty")
      ->delimiter(',')
      ->check(CLI::IsMember({"compliant", "rigid", "penalty"}))
      ->capture_default_str();
  app.add_option("--rates", options.rates, "Steps per second")->delimiter(',')->capture_default_str();
  app.add_option("--spheres", options.spheres, "Of each packing")->capture_default_str();
  app.add_option("--settle", options.settle, "Before height and tilt are taken [s]")->capture_default_str();
  app.add_option("--watch", options.watch, "How long creep is watched after that [s]")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  std::printf("%s\n", heading("Bodies at rest", argc, argv).c_str());
  try {
    printTable(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
