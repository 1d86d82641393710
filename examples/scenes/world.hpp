// A stock Bullet world, the bodies in it, and what they look like.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "body_shape.hpp"
#include "film/film.hpp"
#include "innersphere/contact_options.hpp"
#include "innersphere/packing_shape.hpp"
#include "innersphere/progress.hpp"
#include "innersphere/solid.hpp"
#include "solver_choice.hpp"
#include "truth.hpp"

namespace innersphere::demo {

/// Of bodies, unless their scene says otherwise [kg/m^3].
constexpr double kDensity = 1000;

/// Lever of the resistance against rolling [m], for bodies that would roll on for ever. Those that lie still
/// on a face go without: Bullet's solver lets them creep by 0.1 mm/s with it.
constexpr btScalar kRollingFriction = btScalar(0.01);

/// How a world is set up and stepped.
enum class Stepping {
  careful,  ///< two friction directions, bodies never sleep, a call is a step
  plain     ///< as in Bullet's HelloWorld: its solver mode, bodies may sleep, stepSimulation(1/60, 10)
};

constexpr double kPlainRate = 60;  ///< steps a second of Stepping::plain

/// A solid that was packed for a scene.
struct SceneSolid {
  std::shared_ptr<const Packing> packing;
  std::unique_ptr<PackingShape>
      shape;  ///< also says what moves how: mass properties are the same for all shapes
  std::unique_ptr<BulletShape> other;  ///< what collides in its place; null: nothing does
  std::uint32_t look = 0;              ///< index into Film::shapes
  btVector3 centre;                    ///< of its bounding box, in the packing's frame [m]
  double size = 0;                     ///< diagonal of its bounding box [m]
};

/// A body of a scene; the actor with the same index shows it.
struct SceneBody {
  std::string name;
  std::unique_ptr<btRigidBody> body;
  double size = 0;  ///< diagonal of its bounding box [m]

  bool moves() const { return !body->isStaticOrKinematicObject(); }
};

/// From now on a body without mass is moved by setWorldTransform(), from SceneWorld::drive; what it carries
/// feels its velocity.
void makeKinematic(btRigidBody& body);

/// Owns a btDiscreteDynamicsWorld with Bullet's default parts. The z axis points up; gravity is 9.81 m/s^2.
/// Bodies never go to sleep, so that nothing seems to rest only because Bullet froze it, unless the world is
/// plain.
class SceneWorld {
 public:
  explicit SceneWorld(const ContactOptions& options, const BodyOptions& bodies = {},
                      Stepping stepping = Stepping::careful, const SolverChoice& solver = {});
  ~SceneWorld();
  SceneWorld(const SceneWorld&) = delete;
  SceneWorld& operator=(const SceneWorld&) = delete;

  btDiscreteDynamicsWorld& bullet() { return world_; }
  const std::vector<SceneSolid>& solids() const { return solids_; }
  const std::vector<SceneBody>& bodies() const { return bodies_; }

  /// Packs a solid; the result is an index for addBody().
  std::size_t addSolid(const Solid& solid, std::size_t spheres, const Progress& progress);

  /// A homogeneous body of a packed solid; `place` is where the centre of its bounding box goes. Density 0
  /// [kg/m^3]: it never moves.
  btRigidBody& addBody(std::size_t solid, double density, const btTransform& place, const Colour& colour);

  /// One step [s], which is 1 / kPlainRate where the world is plain.
  void step(double dt);
  /// The number of substeps of the last step; 1 with Bullet's solver.
  int substeps() const;

  /// A box of Bullet's own. Mass 0 [kg]: it never moves.
  btRigidBody& addBox(const btVector3& half_size, double mass, const btTransform& place,
                      const Colour& colour);

  /// A fixed cylinder of Bullet's own, its axis along z.
  btRigidBody& addFixedCylinder(double radius, double length, const btTransform& place, const Colour& colour);

  /// Fixed triangles, as a btBvhTriangleMeshShape.
  btRigidBody& addFixedMesh(const Mesh& mesh, const btTransform& place, const Colour& colour);

  /// A fixed box of Bullet's own.
  btRigidBody& addFixedBox(const btVector3& half_size, const btTransform& place, const Colour& colour);

  /// A fixed horizontal plane, which the film shows as its ground.
  btRigidBody& addGround(double height);

  /// The world keeps the constraint. Bodies it joins still collide.
  void addConstraint(std::unique_ptr<btTypedConstraint> constraint);

  /// Index of a body in bodies() and in recordings.
  std::size_t indexOf(const btRigidBody& body) const;

  /// What a body is packed from; null: it is of a shape of Bullet's own.
  const SceneSolid* solidOf(std::size_t body) const;

  /// Something that has to come out; see judge().
  Truth& expect(Truth truth) { return truths.emplace_back(std::move(truth)); }
  std::vector<Truth> truths;

  /// If set, called before each step with the time and the step [s]: motors, pushes, moved gravity.
  std::function<void(double time, double dt)> drive;

  /// What the film of this world starts with: shapes, actors, viewpoint, no frames yet.
  Film film;

 private:
  btRigidBody& add(std::string name, btCollisionShape& shape, double mass, const btVector3& inertia,
                   const btTransform& place, double size);

  btRigidBody& addBulletShape(const std::string& name, std::unique_ptr<btCollisionShape> shape, double mass,
                              const btTransform& place, Surface look, const Colour& colour);

  BodyOptions body_options_;
  Stepping stepping_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  std::unique_ptr<btConstraintSolver> solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, solver_.get(), &configuration_};
  std::vector<SceneSolid> solids_;
  std::vector<std::unique_ptr<btTriangleMesh>> triangles_;
  std::vector<std::unique_ptr<btCollisionShape>> bullet_shapes_;
  std::unique_ptr<btRigidBody> ground_;
  std::vector<SceneBody> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
};

}  // namespace innersphere::demo
