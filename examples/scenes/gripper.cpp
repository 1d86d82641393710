// A gripper lifts a mug.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/mesh.hpp"
#include "measures.hpp"
#include "scene_solids.hpp"
#include "shapes.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr double kRadius = 0.04, kHeight = 0.1, kWall = 0.005;        // [m] of the mug
constexpr double kJawThick = 0.01, kJawWide = 0.02, kJawHigh = 0.03;  // [m] half of each
constexpr double kOpen = 0.02;                          // [m] from each jaw to the mug at the start
constexpr double kClose = 0.6, kRise = 1, kLift = 0.2;  // [s], [s], [m]
constexpr double kSeconds = 4;
constexpr Colour kSteel{0.62f, 0.64f, 0.67f};

// It stands on z = 0 and has its handle in the yz plane.
Mesh mug() {
  constexpr int kAround = 48, kSteps = 16;
  constexpr double kHandle = 0.028, kTube = 0.005;  // [m]
  constexpr double kPi = std::numbers::pi;
  Mesh mesh = lathe({{0, 0},
                     {kRadius, 0},
                     {kRadius, kHeight},
                     {kRadius - kWall, kHeight},
                     {kRadius - kWall, 0.008},
                     {0, 0.008}},
                    kAround);
  std::vector<Point2> path;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = kPi * (double(i) / kSteps - 0.5);
    path.push_back({kHandle * std::cos(angle), kHandle * std::sin(angle)});
  }
  // Its ends are in the middle of the wall.
  append(mesh, tube(path, std::vector<double>(path.size(), kTube), 12, false), [](const Vec3d& p) {
    return Vec3d{p[2], kRadius - 0.0025 + p[0], kHeight / 2 + p[1]};
  });
  return mesh;
}

// 0 before the rise, then smoothly up to kLift [m].
double liftAt(double time) {
  const double part = std::clamp((time - kClose) / kRise, 0.0, 1.0);
  return kLift * (1 - std::cos(std::numbers::pi * part)) / 2;
}

std::size_t addMug(SceneWorld& world, const SceneOptions& options) {
  const auto solid = makeSolid(mug(), "mug");
  const std::size_t index = world.addSolid(*solid, options.spheres, progressOf(options, 0, 1));
  world.addGround(0);
  const btRigidBody& body = world.addBody(index, 2400, placeOf(*solid, at(0, 0, 0)), paletteColour(0));
  world.film.viewpoint = {2.4, 0.3, 0.45, true};
  return world.indexOf(body);
}

btTransform jawAt(double side, double gap, double lift) {
  return at(side * (kRadius + gap + kJawThick), 0, kHeight / 2 + lift);
}

void expectHeld(SceneWorld& world, std::size_t mug, std::size_t jaw) {
  world.expect({"slip of the mug", "m", Truth::Kind::at_most, 0.005, 0,
                "friction bears many times its weight: it rises with the jaws; 5 mm",
                [=](const Recording& r) {
                  const std::size_t s = r.stepAt(kClose);
                  const double start = r.body(mug, s).position[2] - r.body(jaw, s).position[2];
                  return std::abs(r.last(mug).position[2] - r.last(jaw).position[2] - start);
                },
                kSeconds});
}

}  // namespace

// The jaws go where they are told to: half a millimetre into each side of the mug, as pads would.
void buildGripper(SceneWorld& world, const SceneOptions& options) {
  constexpr double kPad = 0.0005;  // [m]
  const std::size_t mug = addMug(world, options);
  std::array<btRigidBody*, 2> jaws;
  for (const int i : {0, 1}) {
    jaws[i] = &world.addBox(vec(kJawThick, kJawWide, kJawHigh), 0, jawAt(2 * i - 1, kOpen, 0), kSteel);
    makeKinematic(*jaws[i]);
  }
  world.drive = [jaws](double time, double dt) {
    const double closed = std::min(1.0, (time + dt) / (kClose - 0.1));
    const double gap = kOpen - closed * (kOpen + kPad);
    for (const int i : {0, 1}) jaws[i]->setWorldTransform(jawAt(2 * i - 1, gap, liftAt(time + dt)));
  };
  expectHeld(world, mug, world.indexOf(*jaws[0]));
}

// Each jaw is pushed by a motor of 20 N on a rail below a palm that is told where to go.
void buildGripperMotor(SceneWorld& world, const SceneOptions& options) {
  constexpr double kForce = 20, kSpeed = 0.1, kJawMass = 0.3;  // [N], [m/s], [kg]
  constexpr double kPalm = 0.16;                               // [m] height of its middle
  const std::size_t mug = addMug(world, options);
  btRigidBody& palm = world.addBox(vec(0.08, 0.02, 0.01), 0, at(0, 0, kPalm), kSteel);
  makeKinematic(palm);
  std::size_t jaw_index = 0;
  for (const double side : {-1.0, 1.0}) {
    const btTransform place = jawAt(side, kOpen, 0);
    btRigidBody& jaw = world.addBox(vec(kJawThick, kJawWide, kJawHigh), kJawMass, place, kSteel);
    jaw_index = world.indexOf(jaw);
    auto rail = std::make_unique<btSliderConstraint>(
        palm, jaw, at(place.getOrigin().x(), 0, place.getOrigin().z() - kPalm), btTransform::getIdentity(),
        true);
    rail->setLowerLinLimit(btScalar(-0.1));
    rail->setUpperLinLimit(btScalar(0.1));
    rail->setLowerAngLimit(0);
    rail->setUpperAngLimit(0);
    rail->setPoweredLinMotor(true);
    rail->setTargetLinMotorVelocity(btScalar(-side * kSpeed));
    rail->setMaxLinMotorForce(btScalar(kForce));
    world.addConstraint(std::move(rail));
  }
  world.drive = [&palm](double time, double dt) {
    palm.setWorldTransform(at(0, 0, kPalm + liftAt(time + dt)));
  };
  expectHeld(world, mug, jaw_index);
}

}  // namespace innersphere::demo
