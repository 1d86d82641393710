// Runs a scene of the truth bench in Bullet: bench_bullet SCENE.json RATE OUT --shape S --solver S.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <CLI/CLI.hpp>
#include <LinearMath/btConvexHullComputer.h>
#include <btBulletDynamicsCommon.h>

#include "bench_scene.hpp"
#include "innersphere/packing_collision_algorithm.hpp"
#include "innersphere/packing_file.hpp"
#include "innersphere/packing_shape.hpp"
#include "innersphere/substep_solver.hpp"

namespace {

using namespace innersphere;

// Margins over the diagonal. Bullet's own, 0.04 m, is far too large here; see body_shape.cpp of the scenes.
constexpr double kTriangleMargin = 1e-4, kHullMargin = 1e-3;

btVector3 vec(const bench::Vec3& v) {
  return {btScalar(v[0]), btScalar(v[1]), btScalar(v[2])};
}

btQuaternion turn(const bench::Quaternion& q) {
  return {btScalar(q[0]), btScalar(q[1]), btScalar(q[2]), btScalar(q[3])};
}

// Makes shapes, and keeps them; bodies with the same mesh share one.
class Shapes {
 public:
  explicit Shapes(std::string kind) : kind_(std::move(kind)) {}

  btCollisionShape& of(const bench::Body& body) {
    if (body.mesh.empty()) return keep(std::make_unique<btBoxShape>(vec(body.box) / 2));
    const bool moves = body.mass > 0 || body.told();
    btCollisionShape*& known = known_[{body.mesh, moves}];
    if (!known) known = &make(body, moves);
    return *known;
  }

  // From the frame of the scene's body to that of Bullet's.
  static btTransform frameOf(const btCollisionShape& shape) {
    const auto* packing = dynamic_cast<const PackingShape*>(&shape);
    return packing ? packing->meshToBody() : btTransform::getIdentity();
  }

 private:
  template <typename Shape>
  btCollisionShape& keep(std::unique_ptr<Shape> shape) {
    shapes_.push_back(std::move(shape));
    return *shapes_.back();
  }

  btCollisionShape& make(const bench::Body& body, bool moves) {
    if (kind_ == "packing") return packingOf(body);
    if (!moves) return keep(std::make_unique<btBvhTriangleMeshShape>(&meshOf(body), true));
    if (kind_ == "gimpact") {
      auto shape = std::make_unique<btGImpactMeshShape>(&meshOf(body));
      shape->setMargin(btScalar(kTriangleMargin * body.size));
      shape->updateBound();
      return keep(std::move(shape));
    }
    return kind_ == "hulls" ? hullsOf(body) : spheresOf(body);
  }

  btCollisionShape& packingOf(const bench::Body& body) {
    auto packing = std::make_shared<Packing>(readPacking(body.packing));
    return keep(std::make_unique<PackingShape>(std::make_shared<CollisionModel>(std::move(packing))));
  }

  btTriangleMesh& meshOf(const bench::Body& body) {
    const bench::Triangles read = bench::readObj(body.mesh);
    meshes_.push_back(std::make_unique<btTriangleMesh>());
    for (const auto& t : read.triangles)
      meshes_.back()->addTriangle(vec(read.vertices[t[0]]), vec(read.vertices[t[1]]), vec(read.vertices[t[2]]));
    return *meshes_.back();
  }

  btCollisionShape& hullsOf(const bench::Body& body) {
    if (body.hulls.empty()) throw std::runtime_error("there are no convex parts of " + body.mesh);
    auto compound = std::make_unique<btCompoundShape>();
    for (const std::string& file : body.hulls) {
      std::vector<btVector3> points;
      for (const auto& v : bench::readObj(file).vertices) points.push_back(vec(v));
      btConvexHullComputer hull;  // made smaller by the margin, at most by half
      const btScalar shrunk = hull.compute(&points[0][0], sizeof(btVector3), int(points.size()),
                                           btScalar(kHullMargin * body.size), btScalar(0.5));
      if (hull.faces.size() == 0) continue;  // flat
      btCollisionShape& part = keep(std::make_unique<btConvexHullShape>(&hull.vertices[0][0], hull.vertices.size()));
      part.setMargin(shrunk);
      compound->addChildShape(btTransform::getIdentity(), &part);
    }
    return keep(std::move(compound));
  }

  btCollisionShape& spheresOf(const bench::Body& body) {
    auto compound = std::make_unique<btCompoundShape>();
    const Packing packing = readPacking(body.packing);
    for (const Sphere& s : packing.spheres) {
      btCollisionShape& sphere = keep(std::make_unique<btSphereShape>(btScalar(s.radius)));
      const Vec3d& origin = packing.origin;
      const btVector3 centre =
          vec({double(s.x) + origin[0], double(s.y) + origin[1], double(s.z) + origin[2]});
      compound->addChildShape(btTransform(btQuaternion::getIdentity(), centre), &sphere);
    }
    return keep(std::move(compound));
  }

  std::string kind_;
  std::vector<std::unique_ptr<btTriangleMesh>> meshes_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::map<std::pair<std::string, bool>, btCollisionShape*> known_;
};

class World {
 public:
  World(const bench::Scene& scene, const std::string& shape, const std::string& solver)
      : scene_(scene), shapes_(shape) {
    if (solver == "substep")
      solver_ = std::make_unique<SubstepSolver>();
    else
      solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
    world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, solver_.get(), &configuration_);
    world_->setGravity(btVector3(0, 0, btScalar(-9.81)));
    world_->getDispatchInfo().m_deterministicOverlappingPairs = true;  // runs repeat
    PackingCollisionAlgorithm::prepareWorld(*world_);
    if (shape == "gimpact") btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    if (scene.has_ground) {
      ground_shape_ = std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(scene.ground));
      add(0, *ground_shape_, {}, btTransform::getIdentity());
    }
    first_ = bodies_.size();
    for (const bench::Body& body : scene.bodies) addBody(body);
  }

  ~World() {
    for (const auto& hinge : hinges_) world_->removeConstraint(hinge.get());
    for (const auto& body : bodies_) world_->removeRigidBody(body.get());
  }

  void step(double time, double dt) {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const bench::Body& body = scene_.bodies[i];
      btRigidBody& moved = *bodies_[first_ + i];
      if (body.told()) moved.setWorldTransform(placeOf(body, body.wayAt(time + dt), moved));
      if (!body.force.empty()) moved.applyCentralForce(vec(body.forceAt(time)));
      if (body.hinge.damping > 0) moved.applyTorque(btScalar(-body.hinge.damping) * moved.getAngularVelocity());
    }
    world_->stepSimulation(btScalar(dt), 0);
  }

  bench::Pose pose(std::size_t i) const {
    const btRigidBody& body = *bodies_[first_ + i];
    const btTransform t = body.getWorldTransform() * Shapes::frameOf(*body.getCollisionShape());
    const btVector3& p = t.getOrigin();
    const btQuaternion q = t.getRotation();
    return {{double(p.x()), double(p.y()), double(p.z())},
            {double(q.x()), double(q.y()), double(q.z()), double(q.w())}};
  }

 private:
  static btTransform placeOf(const bench::Body& body, const bench::Vec3& way, const btRigidBody& moved) {
    return btTransform(turn(body.rotation), vec(body.position) + vec(way)) *
           Shapes::frameOf(*moved.getCollisionShape()).inverse();
  }

  btRigidBody& add(double mass, btCollisionShape& shape, const btVector3& inertia, const btTransform& place) {
    btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, &shape, inertia);
    info.m_startWorldTransform = place;
    info.m_friction = btScalar(std::sqrt(scene_.friction));  // Bullet multiplies those of a pair
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    world_->addRigidBody(bodies_.back().get());
    return *bodies_.back();
  }

  void addBody(const bench::Body& body) {
    btCollisionShape& shape = shapes_.of(body);
    btVector3 inertia = vec(body.inertia);
    if (dynamic_cast<PackingShape*>(&shape) && body.mass > 0)  // its frame may have its axes in another order
      shape.calculateLocalInertia(btScalar(body.mass), inertia);
    const btTransform place = btTransform(turn(body.rotation), vec(body.position)) * Shapes::frameOf(shape).inverse();
    btRigidBody& added = add(body.mass, shape, inertia, place);
    if (body.told()) added.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    if (body.hinge.there) addHinge(body.hinge, added);
  }

  void addHinge(const bench::Hinge& hinge, btRigidBody& body) {
    btVector3 axis = quatRotate(body.getWorldTransform().getRotation().inverse(), vec(hinge.axis));
    hinges_.push_back(std::make_unique<btHingeConstraint>(body, btVector3(0, 0, 0), axis));
    if (hinge.torque > 0) hinges_.back()->enableAngularMotor(true, btScalar(hinge.speed), btScalar(hinge.torque));
    world_->addConstraint(hinges_.back().get());
  }

  const bench::Scene& scene_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  std::unique_ptr<btConstraintSolver> solver_;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  Shapes shapes_;
  std::unique_ptr<btStaticPlaneShape> ground_shape_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btHingeConstraint>> hinges_;
  std::size_t first_ = 0;
};

}  // namespace

int main(int count, char** arguments) {
  CLI::App app("Runs a scene of the truth bench in Bullet.");
  std::string file, out, shape = "packing", solver = "bullet";
  int rate = 240;
  app.add_option("scene", file, "Scene that scene.py prepared")->required()->check(CLI::ExistingFile);
  app.add_option("rate", rate, "Steps a second")->required()->check(CLI::PositiveNumber);
  app.add_option("out", out, "Writes OUT.f64 and OUT.json")->required();
  app.add_option("--shape", shape)->check(CLI::IsMember({"packing", "gimpact", "hulls", "spheres"}));
  app.add_option("--solver", solver)->check(CLI::IsMember({"bullet", "substep"}));
  app.set_version_flag("--version", "Bullet " + std::to_string(BT_BULLET_VERSION / 100) + "." +
                                        std::to_string(BT_BULLET_VERSION % 100) + ", single precision");
  CLI11_PARSE(app, count, arguments);
  try {
    const bench::Scene scene = bench::readScene(file);
    World world(scene, shape, solver);
    bench::record(scene, rate, out, [&](double time) { world.step(time, 1.0 / rate); },
                  [&](std::size_t i) { return world.pose(i); });
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_bullet: %s\n", error.what());
    return 1;
  }
}
