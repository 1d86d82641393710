// What constraint solvers make of stacks, piles and machines at 60 steps a second, with Bullet's own shapes,
// as CSV: tests/benchmarks/solver.py has MuJoCo do the same, and makes a page of it.
#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

#include "solver/machines.hpp"
#include "timing.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::test;
using innersphere::benchmarks::timeOf;

constexpr double kStep = 1.0 / 60;
constexpr btScalar kHalf = btScalar(0.25);  // of a box's edge [m]

std::string engine;

void value(const char* scene, const char* measure, double x) {
  std::printf("value,\"%s\",\"%s\",%s,%.6g\n", scene, measure, engine.c_str(), x);
}
void sample(const char* series, double t, double x) {
  std::printf("series,%s,%.4f,%s,%.6g\n", series, t, engine.c_str(), x);
}

using Solver = std::function<std::unique_ptr<btConstraintSolver>()>;

/// With one of the solvers, as prepareWorld() sets it.
struct World : SolverWorld {
  explicit World(const Solver& make) : own(make()) {
    if (own) world.setConstraintSolver(own.get());
    world.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  }
  btRigidBody& addCube(btScalar mass, const btVector3& at) {
    return addBox(btVector3(kHalf, kHalf, kHalf), mass, at);
  }
  std::unique_ptr<btConstraintSolver> own;
};

void stack(const Solver& solver) {
  World world(solver);
  world.addSlab();
  for (int i = 0; i < 10; ++i) world.addCube(125, btVector3(0, 0, btScalar(2 * i + 1) * kHalf));
  double farthest = 0;
  for (int step = 0; step < 1800; ++step) {
    world.step();
    for (std::size_t i = 1; i < world.bodies.size(); ++i) {
      const btVector3 from(0, 0, btScalar(2 * i - 1) * kHalf);
      farthest = std::max(farthest, double(world.bodies[i]->getWorldTransform().getOrigin().distance(from)));
    }
    if (step % 6 == 0) sample("stack", step * kStep, farthest);
  }
  value("stack of ten boxes, 30 s", "farthest way [mm]", 1e3 * farthest);
}

void masses(const Solver& solver, double ratio) {
  World world(solver);
  world.addSlab();
  world.addCube(1, btVector3(0, 0, kHalf));
  const btRigidBody& upper = world.addCube(btScalar(ratio), btVector3(0, 0, 3 * kHalf));
  world.run(5);
  const double sunk = 3 * kHalf - upper.getWorldTransform().getOrigin().z();
  value(ratio > 100 ? "a box on one of a thousandth of its mass, 5 s"
                    : "a box on one of a hundredth of its mass, 5 s",
        "sunk in by [% of an edge]", 100 * sunk / (2 * kHalf));
}

/// 125 boxes from regular layers, turned a little, in a bin of 2.6 m.
void pile(const Solver& solver) {
  World world(solver);
  world.addSlab();
  constexpr btScalar kBin = btScalar(1.3), kThick = 1;
  for (const int side : {-1, 1}) {
    const btScalar at = btScalar(side) * (kBin + kThick);
    world.addBox(btVector3(kThick, 5, 8), 0, btVector3(at, 0, 6));
    world.addBox(btVector3(5, kThick, 8), 0, btVector3(0, at, 6));
  }
  const std::size_t first = world.bodies.size();
  for (int i = 0; i < 125; ++i) {
    const int x = i % 4, y = i / 4 % 4, z = i / 16;
    btRigidBody& box = world.addCube(
        1, btVector3(btScalar(0.64 * (x - 1.5)), btScalar(0.64 * (y - 1.5)), btScalar(0.4 + 0.62 * z)));
    box.getWorldTransform().setRotation(
        btQuaternion(btVector3(btScalar(std::sin(i)), btScalar(std::cos(i)), 1).normalized(), btScalar(0.4)));
    box.setFriction(btScalar(0.7));
  }
  world.run(9.5);
  std::vector<btVector3> before;
  for (const auto& body : world.bodies) before.push_back(body->getWorldTransform().getOrigin());
  std::vector<double> times;
  for (int i = 0; i < 30; ++i) times.push_back(timeOf([&] { world.step(); }));
  int moved = 0;
  double most = 0;
  for (std::size_t i = first; i < world.bodies.size(); ++i) {
    const double way = world.bodies[i]->getWorldTransform().getOrigin().distance(before[i]);
    moved += way > 0.005;
    most = std::max(most, way);
  }
  value("pile of 125 boxes, last half of 10 s", "moved by more than 5 mm", moved);
  value("pile of 125 boxes, last half of 10 s", "largest motion [mm]", 1e3 * most);
  value("pile of 125 boxes, last half of 10 s", "a whole step [ms]", benchmarks::median(times) / 1e3);
}

void pendulum(const Solver& solver) {
  World world(solver);
  constexpr double kAmplitude = 1;
  btRigidBody& bob =
      world.addBox(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1)), 1,
                   btVector3(btScalar(std::sin(kAmplitude)), 0, btScalar(-std::cos(kAmplitude))));
  world.join<btHingeConstraint>(bob, -bob.getWorldTransform().getOrigin(), btVector3(0, 1, 0));
  const double inertia = 1 + 1 / bob.getInvInertiaDiagLocal().y();
  const double expected = 4 * std::comp_ellint_1(std::sin(kAmplitude / 2)) * std::sqrt(inertia / kGravity);
  const double before = world.energy();
  double first = 0, last = 0, x = bob.getWorldTransform().getOrigin().x();
  int passed = -1;
  for (int i = 0; i < 1800; ++i) {
    world.step();
    if (i % 6 == 0) sample("pendulum", i * kStep, (world.energy() - before) / kGravity);
    const double now = bob.getWorldTransform().getOrigin().x();
    if (x < 0 && now >= 0 && i < 1500) {
      last = (i + x / (x - now)) * kStep;
      if (++passed == 0) first = last;
    }
    x = now;
  }
  value("pendulum from 1 rad, 30 s", "period off by [%]", 100 * ((last - first) / passed / expected - 1));
  value("pendulum from 1 rad, 30 s", "energy gained [% of m g l]",
        100 * (world.energy() - before) / kGravity);
}

void doublePendulum(const Solver& solver) {
  World world(solver);
  const btVector3 half(btScalar(0.5), btScalar(0.05), btScalar(0.05)), end(half.x(), 0, 0), axis(0, 1, 0);
  btRigidBody& upper = world.addBox(half, 1, btVector3(btScalar(0.5), 0, 0));
  btRigidBody& lower = world.addBox(half, 1, btVector3(btScalar(1.5), 0, 0));
  world.join<btHingeConstraint>(upper, -end, axis);
  world.join<btHingeConstraint>(upper, lower, end, -end, axis, axis);
  const double before = world.energy();
  double most = 0;
  for (int i = 0; i < 1800; ++i) {
    world.step();
    const double gained = (world.energy() - before) / (2 * kGravity);
    most = std::fabs(gained) > std::fabs(most) ? gained : most;
    if (i % 6 == 0) sample("double pendulum", i * kStep, gained);
  }
  value("double pendulum from level, 30 s", "energy off by at most [% of 2 m g l]", 100 * most);
}

void chain(const Solver& solver) {
  World world(solver);
  constexpr int kLinks = 20;
  const btRigidBody& last = hangChain(world, kLinks, 100);
  world.run(5);
  value("chain of 20 hinges, its end of 100 times the mass, 5 s", "longer by [mm]",
        1e3 * (chainEnd(kLinks) - last.getWorldTransform().getOrigin().z()));
  value("chain of 20 hinges, its end of 100 times the mass, 5 s", "speed of its end [mm/s]",
        1e3 * last.getLinearVelocity().length());
}

void motor(const Solver& solver) {
  World world(solver);
  MotorArm machine(world);
  machine.turn(1, kStep);
  world.run(1);
  value("motor lifts 10 kg at 1 m by 1 rad/s for 1 s", "angle off what its torque allows by [mrad]",
        1e3 * (machine.angle() - MotorArm::kAngle));
  machine.turn(0, kStep);
  world.run(1);
  const double held = machine.angle();
  world.run(5);
  value("motor lifts 10 kg at 1 m by 1 rad/s for 1 s", "sags in 5 s by [mrad]",
        1e3 * (held - machine.angle()));
  value("motor lifts 10 kg at 1 m by 1 rad/s for 1 s", "load off its place by [mm]", 1e3 * machine.gap());
}

void ragdoll(const Solver& solver) {
  World world(solver);
  world.addSlab();
  Ragdoll figure(world, btScalar(0.5));
  const double before = world.energy();
  double gap = 0, beyond = 0, energy = before;
  for (int i = 0; i < 600; ++i) {
    world.step();
    gap = std::max(gap, figure.gap());
    beyond = std::max(beyond, figure.beyond());
    energy = std::max(energy, world.energy());
    if (i % 2 == 0) sample("ragdoll", i * kStep, figure.fastest());
  }
  value("ragdoll falls, 10 s", "joints apart by at most [mm]", 1e3 * gap);
  value("ragdoll falls, 10 s", "beyond its limits by at most [deg]", 57.29578 * beyond);
  value("ragdoll falls, 10 s", "speed at the end [mm/s]", 1e3 * figure.fastest());
  value("ragdoll falls, 10 s", "energy from nowhere [%]", 100 * (energy - before) / before);
}

}  // namespace

int main() {
  const std::pair<const char*, Solver> solvers[] = {
      {"Bullet", [] { return std::make_unique<btSequentialImpulseConstraintSolver>(); }},
      {"Bullet NNCG", [] { return std::make_unique<btNNCGConstraintSolver>(); }},
      {"SubstepSolver", [] { return std::unique_ptr<btConstraintSolver>(); }}};
  for (const auto& [name, solver] : solvers) {
    engine = name;
    stack(solver);
    for (const double ratio : {100.0, 1000.0}) masses(solver, ratio);
    pile(solver);
    pendulum(solver);
    doublePendulum(solver);
    chain(solver);
    motor(solver);
    ragdoll(solver);
  }
  return 0;
}
