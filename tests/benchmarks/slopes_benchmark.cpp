// What Bullet's own GImpact demo costs at 60 Hz, as packings and as its triangle meshes: a chain of tori
// hangs from a kinematic one over two sloping planes, uneven lumps are thrown at it, and boxes slide down.
// Kinds of bodies, their number and size are the demo's; the solids are ours. Bodies may sleep.
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletDynamicsCommon.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
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

constexpr btScalar kMargin = btScalar(0.07);  // [m] of GImpact's meshes, as in its demo
constexpr int kTori = 12, kLumps = 9, kBoxes = 16;
constexpr double kStep = 2.5;  // [m] from torus to torus

struct Settings {
  std::size_t spheres = 256;
  int steps = 900;
  int runs = 3;
  bool alone = false;
};

/// A solid in both forms.
struct Model {
  explicit Model(const Mesh& mesh, const char* name, std::size_t spheres) {
    PackOptions options;
    options.spheres = spheres;
    options.overlap_errors = false;
    packing = std::make_shared<Packing>(pack(*makeSolid(mesh, name), options));
    collision = std::make_shared<CollisionModel>(packing);
    const btTransform frame = PackingShape(collision).principalTransform();
    for (const auto& t : packing->surface.triangles) {
      btVector3 v[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& p = packing->surface.vertices[t[k]];
        v[k] = frame * btVector3(btScalar(p[0]), btScalar(p[1]), btScalar(p[2]));
      }
      triangles.addTriangle(v[0], v[1], v[2]);
    }
  }
  std::unique_ptr<btCollisionShape> shape(bool gimpact) {
    if (!gimpact) return std::make_unique<PackingShape>(collision);
    auto mesh = std::make_unique<btGImpactMeshShape>(&triangles);
    mesh->setMargin(kMargin);
    mesh->updateBound();
    return mesh;
  }
  btVector3 inertia(btScalar mass) const {
    btVector3 inertia;
    PackingShape(collision).calculateLocalInertia(mass, inertia);
    return inertia;
  }
  std::shared_ptr<Packing> packing;
  std::shared_ptr<CollisionModel> collision;
  btTriangleMesh triangles;
};

/// 5 m across, of 600 triangles.
Mesh torus() {
  constexpr double kRing = 1.9, kTube = 0.6;  // [m]
  return demo::tube(demo::circlePoints(kRing, 30), std::vector<double>(30, kTube), 10, true);
}

/// 4 m across, uneven, of 512 triangles.
Mesh lump() {
  return demo::lump(
      [](const Vec3d& n) { return 1.7 + 0.35 * std::sin(3 * n[0] + 1) + 0.3 * std::cos(4 * n[1]) * n[2]; },
      3);
}

class World {
 public:
  World(Model& torus, Model& lump, bool gimpact) : gimpact_(gimpact), lump_(lump) {
    if (gimpact) {
      btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    } else {
      PackingCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    }
    // The solver is as Bullet has it: the demo sets nothing.
    world_.setGravity(btVector3(0, 0, -10));
    add(std::make_unique<btBoxShape>(btVector3(100, 100, 1)), 0, at(0, 0, -12));
    add(std::make_unique<btStaticPlaneShape>(btVector3(-1, 0, 1).normalized(), 0), 0, at(0, 0, -9));
    add(std::make_unique<btStaticPlaneShape>(btVector3(5, 0, 7).normalized(), 0), 0, at(0, 0, -10));
    for (int i = 0; i <= kTori; ++i) {
      btTransform place = at(0, 0, btScalar(28 - kStep * i));
      place.setRotation(btQuaternion(btVector3(0, 0, 1), btScalar(i) * SIMD_HALF_PI) *
                        btQuaternion(btVector3(1, 0, 0), SIMD_HALF_PI));
      btRigidBody& body = add(torus.shape(gimpact), i == 0 ? 0 : 1, place, torus.inertia(1));
      if (i > 0) continue;
      body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
      body.setActivationState(DISABLE_DEACTIVATION);
    }
    for (int i = 0; i < kBoxes; ++i)
      add(std::make_unique<btBoxShape>(btVector3(1, 1, 1) / 2), 1, at(btScalar(i - 8), 8, btScalar(i)));
  }
  ~World() {
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  /// The processor time of a step [us].
  double step() {
    // One a second is thrown at the chain.
    if (number_ % 60 == 30 && number_ / 60 < kLumps) {
      btRigidBody& thrown = add(lump_.shape(gimpact_), 1, at(0, -50, 10), lump_.inertia(1));
      thrown.setLinearVelocity(btVector3(0, 40, btScalar(number_ / 60 - 4)));
    }
    ++number_;
    const std::clock_t start = std::clock();
    world_.stepSimulation(btScalar(1) / 60, 0, btScalar(1) / 60);
    return 1e6 * double(std::clock() - start) / CLOCKS_PER_SEC;
  }
  int contacts() const {
    int count = 0;
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i)
      count += dispatcher_.getManifoldByIndexInternal(i)->getNumContacts();
    return count;
  }
  int pairs() { return world_.getPairCache()->getNumOverlappingPairs(); }
  int asleep() const {
    return count([](const btRigidBody& b) { return !b.isActive(); });
  }
  int lost() const {
    return count([](const btRigidBody& b) { return b.getWorldTransform().getOrigin().z() < -14; });
  }

 private:
  static btTransform at(btScalar x, btScalar y, btScalar z) {
    return btTransform(btMatrix3x3::getIdentity(), btVector3(x, y, z));
  }
  template <typename Is>
  int count(const Is& is) const {
    return int(std::count_if(bodies_.begin(), bodies_.end(),
                             [&](const auto& b) { return !b->isStaticOrKinematicObject() && is(*b); }));
  }
  btRigidBody& add(std::unique_ptr<btCollisionShape> shape, btScalar mass, const btTransform& place,
                   btVector3 inertia = btVector3(0, 0, 0)) {
    if (mass > 0 && inertia.isZero()) shape->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape.get(), inertia);
    info.m_startWorldTransform = place;
    shapes_.push_back(std::move(shape));
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    world_.addRigidBody(bodies_.back().get());
    return *bodies_.back();
  }

  bool gimpact_;
  Model& lump_;
  int number_ = 0;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

struct Row {
  std::vector<double> steps;   // [us]
  std::vector<double> totals;  // [s]
  double contacts = 0, pairs = 0;
  int asleep = 0, lost = 0;
};

void run(const Settings& settings) {
  Model torus_model(torus(), "torus", settings.spheres), lump_model(lump(), "lump", settings.spheres);
  Row rows[2];
  for (int r = 0; r < settings.runs; ++r) {
    for (const bool gimpact : {false, true}) {
      if (gimpact && settings.alone) continue;
      World world(torus_model, lump_model, gimpact);
      Row& row = rows[gimpact ? 1 : 0];
      double total = 0;
      row.contacts = row.pairs = 0;
      for (int i = 0; i < settings.steps; ++i) {
        row.steps.push_back(world.step());
        total += row.steps.back() / 1e6;
        row.contacts += double(world.contacts()) / settings.steps;
        row.pairs += double(world.pairs()) / settings.steps;
      }
      row.totals.push_back(total);
      row.asleep = world.asleep();
      row.lost = world.lost();
    }
  }
  std::printf(
      "| shape | processor time of all steps [s] | first row = 1 | a step, median [ms] | 99 %% [ms] | "
      "contact points | pairs of boxes | asleep | lost |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  for (int k = 0; k < (settings.alone ? 1 : 2); ++k) {
    const Row& row = rows[k];
    std::printf("| %s | %.3f | %.2f | %.3f | %.2f | %.0f | %.0f | %d | %d |\n",
                k == 0 ? ("packing, " + std::to_string(settings.spheres) + " spheres").c_str() : "GImpact",
                median(row.totals), median(row.totals) / median(rows[0].totals), median(row.steps) / 1e3,
                quantile(row.steps, 0.99) / 1e3, row.contacts, row.pairs, row.asleep, row.lost);
  }
}

}  // namespace

int main(int argc, char** argv) try {
  Settings settings;
  CLI::App app("Cost of a step of a Bullet world: solids on slopes at 60 Hz.");
  app.add_option("--spheres", settings.spheres, "of each packing, at least 64")
      ->capture_default_str()
      ->check(CLI::Range(64, 1000000));
  app.add_option("--steps", settings.steps, "of a run")->capture_default_str()->check(CLI::PositiveNumber);
  app.add_option("--runs", settings.runs, "of each shape, in turn")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_flag("--alone", settings.alone, "only packings, nothing to compare them with");
  CLI11_PARSE(app, argc, argv);
  std::printf("%s", heading("Cost of a step: solids on slopes", argc, argv).c_str());
  std::printf("\n%d runs in turn of %d steps of 1/60 s; bodies may sleep.\n\n", settings.runs,
              settings.steps);
  run(settings);
  return 0;
} catch (const innersphere::Error& error) {
  std::fprintf(stderr, "%s: %s\n", toString(error.code()), error.what());
  return 3;
}
