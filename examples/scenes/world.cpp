#include "world.hpp"

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>

#include "bullet_math.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing_collision_algorithm.hpp"
#include "innersphere/substep_solver.hpp"
#include "scaled_solid.hpp"
#include "shapes.hpp"

namespace innersphere::demo {
namespace {

constexpr btScalar kGravity = btScalar(9.81);  // [m/s^2]
constexpr btScalar kFriction = btScalar(0.8);  // of each body; Bullet multiplies the two of a pair

std::array<float, 3> moved(const btTransform& t, float x, float y, float z) {
  const btVector3 p = t * btVector3(btScalar(x), btScalar(y), btScalar(z));
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

// A packing as it is drawn: in the frame of the body.
Shape lookOf(const std::string& name, const Packing& packing, std::size_t spheres,
             const btTransform& to_body) {
  Shape look{name, packing.surface, packing.spheres};
  look.spheres.resize(std::min(look.spheres.size(), spheres));
  for (auto& v : look.surface.vertices) v = moved(to_body, v[0], v[1], v[2]);
  for (Sphere& s : look.spheres) {
    const auto centre = moved(to_body, s.x, s.y, s.z);
    s = {centre[0], centre[1], centre[2], s.radius};
  }
  return look;
}

Surface boxSurface(const btVector3& half) {
  Surface surface;
  for (int corner = 0; corner < 8; ++corner) {
    std::array<float, 3> v;
    for (int axis = 0; axis < 3; ++axis)
      v[axis] = static_cast<float>((corner >> axis & 1) ? half[axis] : -half[axis]);
    surface.vertices.push_back(v);
  }
  surface.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                       {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return surface;
}

Surface surfaceOf(const Mesh& mesh) {
  Surface surface;
  for (const Vec3d& v : mesh.vertices)
    surface.vertices.push_back(
        {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])});
  surface.triangles = mesh.triangles;
  return surface;
}

std::unique_ptr<btConstraintSolver> makeSolver(const SolverChoice& choice) {
  if (choice.kind == SolverKind::bullet) return std::make_unique<btSequentialImpulseConstraintSolver>();
  SubstepOptions options;
  options.substeps = choice.substeps;
  return std::make_unique<SubstepSolver>(options);
}

}  // namespace

void makeKinematic(btRigidBody& body) {
  const int flags = body.getCollisionFlags() & ~btCollisionObject::CF_STATIC_OBJECT;
  body.setCollisionFlags(flags | btCollisionObject::CF_KINEMATIC_OBJECT);
  body.setActivationState(DISABLE_DEACTIVATION);
}

SceneWorld::SceneWorld(const ContactOptions& options, const BodyOptions& bodies, Stepping stepping,
                       const SolverChoice& solver)
    : body_options_(bodies), stepping_(stepping), solver_(makeSolver(solver)) {
  world_.setGravity(btVector3(0, 0, -kGravity));
  // Runs repeat exactly, whatever order the broad phase finds pairs in.
  world_.getDispatchInfo().m_deterministicOverlappingPairs = true;
  if (stepping_ == Stepping::careful)
    PackingCollisionAlgorithm::prepareWorld(world_, options);
  else
    PackingCollisionAlgorithm::registerAlgorithm(&dispatcher_, options);
  if (solver.iterations > 0) world_.getSolverInfo().m_numIterations = solver.iterations;
  if (bodies.shape == BodyShape::gimpact) btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
}

SceneWorld::~SceneWorld() {
  for (const auto& constraint : constraints_) world_.removeConstraint(constraint.get());
  for (const SceneBody& body : bodies_) world_.removeRigidBody(body.body.get());
  if (ground_) world_.removeRigidBody(ground_.get());
}

std::size_t SceneWorld::addSolid(const Solid& solid, std::size_t spheres, const Progress& progress) {
  SceneSolid& entry = solids_.emplace_back();
  if (body_options_.packing) {
    entry.packing = body_options_.packing(solid, spheres, progress);
  } else {
    PackOptions options;
    options.spheres = spheres;
    options.order = body_options_.order;
    options.overlap_errors = false;  // nobody asks for them here, and they take most of the time
    entry.packing = std::make_shared<Packing>(pack(solid, options, progress));
  }
  entry.shape = std::make_unique<PackingShape>(std::make_shared<CollisionModel>(entry.packing));
  entry.shape->setSphereCount(spheres);
  const btTransform& to_body = entry.shape->principalTransform();
  const Bounds box = solid.bounds();
  entry.size = diagonalOf(box);
  for (int k = 0; k < 3; ++k)
    entry.centre[k] = btScalar((box.min[k] + box.max[k]) / 2 - entry.packing->origin[k]);
  entry.look = static_cast<std::uint32_t>(film.shapes.size());
  film.shapes.push_back(lookOf(solid.name(), *entry.packing, spheres, to_body));
  if (body_options_.shape != BodyShape::packing) {
    entry.other = std::make_unique<BulletShape>(body_options_, solid, *entry.packing, spheres, to_body);
    Shape& look = film.shapes.back();
    if (body_options_.shape != BodyShape::spheres) look.spheres.clear();
    if (body_options_.shape == BodyShape::convex) look.surface = entry.other->hulls();
  }
  return solids_.size() - 1;
}

btRigidBody& SceneWorld::add(std::string name, btCollisionShape& shape, double mass, const btVector3& inertia,
                             const btTransform& place, double size) {
  btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, &shape, inertia);
  info.m_startWorldTransform = place;
  info.m_friction = kFriction;
  auto body = std::make_unique<btRigidBody>(info);
  if (mass > 0 && stepping_ == Stepping::careful) body->setActivationState(DISABLE_DEACTIVATION);
  world_.addRigidBody(body.get());
  return *bodies_.emplace_back(SceneBody{std::move(name), std::move(body), size}).body;
}

btRigidBody& SceneWorld::addBody(std::size_t solid, double density, const btTransform& place,
                                 const Colour& colour) {
  const SceneSolid& entry = solids_[solid];
  film.actors.push_back({entry.look, colour});
  const double mass = density * entry.packing->solid.volume;
  btVector3 inertia(0, 0, 0);
  if (mass > 0) entry.shape->calculateLocalInertia(btScalar(mass), inertia);
  btCollisionShape& shape = entry.other ? entry.other->shape() : *entry.shape;
  return add(film.shapes[entry.look].name, shape, mass, inertia,
             place * btTransform(btQuaternion::getIdentity(), -entry.centre) *
                 entry.shape->principalTransform().inverse(),
             entry.size);
}

btRigidBody& SceneWorld::addBulletShape(const std::string& name, std::unique_ptr<btCollisionShape> shape,
                                        double mass, const btTransform& place, Surface look,
                                        const Colour& colour) {
  film.actors.push_back({static_cast<std::uint32_t>(film.shapes.size()), colour});
  film.shapes.push_back({name, std::move(look), {}});
  bullet_shapes_.push_back(std::move(shape));
  btCollisionShape& kept = *bullet_shapes_.back();
  btVector3 inertia(0, 0, 0), low, high;
  if (mass > 0) kept.calculateLocalInertia(btScalar(mass), inertia);
  kept.getAabb(btTransform::getIdentity(), low, high);
  return add(name, kept, mass, inertia, place, (high - low).length());
}

btRigidBody& SceneWorld::addBox(const btVector3& half_size, double mass, const btTransform& place,
                                const Colour& colour) {
  return addBulletShape(mass > 0 ? "box" : "fixed box", std::make_unique<btBoxShape>(half_size), mass, place,
                        boxSurface(half_size), colour);
}

btRigidBody& SceneWorld::addFixedBox(const btVector3& half_size, const btTransform& place,
                                     const Colour& colour) {
  return addBox(half_size, 0, place, colour);
}

btRigidBody& SceneWorld::addFixedCylinder(double radius, double length, const btTransform& place,
                                          const Colour& colour) {
  constexpr int kAround = 64;  // of the look
  const double half = length / 2;
  const Mesh look = lathe({{0, -half}, {radius, -half}, {radius, half}, {0, half}}, kAround);
  return addBulletShape("fixed cylinder", std::make_unique<btCylinderShapeZ>(vec(radius, radius, half)), 0,
                        place, surfaceOf(look), colour);
}

btRigidBody& SceneWorld::addFixedMesh(const Mesh& mesh, const btTransform& place, const Colour& colour) {
  triangles_.push_back(std::make_unique<btTriangleMesh>());
  const auto corner = [&mesh](std::uint32_t index) {
    const Vec3d& v = mesh.vertices[index];
    return vec(v[0], v[1], v[2]);
  };
  for (const auto& t : mesh.triangles)
    triangles_.back()->addTriangle(corner(t[0]), corner(t[1]), corner(t[2]));
  return addBulletShape("fixed mesh", std::make_unique<btBvhTriangleMeshShape>(triangles_.back().get(), true),
                        0, place, surfaceOf(mesh), colour);
}

btRigidBody& SceneWorld::addGround(double height) {
  bullet_shapes_.push_back(std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(height)));
  ground_ = std::make_unique<btRigidBody>(btScalar(0), nullptr, bullet_shapes_.back().get());
  ground_->setFriction(kFriction);
  world_.addRigidBody(ground_.get());
  film.has_ground = true;
  film.ground = static_cast<float>(height);
  return *ground_;
}

void SceneWorld::step(double dt) {
  if (stepping_ == Stepping::plain)
    world_.stepSimulation(btScalar(1) / btScalar(kPlainRate), 10);
  else
    world_.stepSimulation(btScalar(dt), 0);
}

int SceneWorld::substeps() const {
  const auto* solver = dynamic_cast<const SubstepSolver*>(solver_.get());
  return solver != nullptr ? std::max(1, solver->substeps()) : 1;
}

void SceneWorld::addConstraint(std::unique_ptr<btTypedConstraint> constraint) {
  world_.addConstraint(constraint.get());
  constraints_.push_back(std::move(constraint));
}

std::size_t SceneWorld::indexOf(const btRigidBody& body) const {
  std::size_t index = 0;
  while (bodies_[index].body.get() != &body) ++index;
  return index;
}

const SceneSolid* SceneWorld::solidOf(std::size_t body) const {
  for (const SceneSolid& solid : solids_) {
    if (solid.look == film.actors[body].shape) return &solid;
  }
  return nullptr;
}

}  // namespace innersphere::demo
