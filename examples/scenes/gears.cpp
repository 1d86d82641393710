// A gear pair.
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

constexpr double kToothPitch = 0.18;  // [m] along the pitch circle
constexpr double kTooth = 0.05;       // [m] height above, and depth below the pitch circle

double pitchRadius(int teeth) {
  return kToothPitch * teeth / (2 * std::numbers::pi);
}

// A spur gear with a gap between teeth at angle 0.
Mesh gear(int teeth) {
  struct Corner {
    double fraction;  // of a tooth
    double radius;    // above the pitch circle
  };
  constexpr Corner kCorners[] = {{-0.22, -kTooth}, {0, -kTooth},  {0.22, -kTooth},
                                 {0.4, kTooth},    {0.5, kTooth}, {0.6, kTooth}};
  std::vector<Point2> outer, bore;
  for (int tooth = 0; tooth < teeth; ++tooth) {
    for (const Corner& corner : kCorners) {
      const double angle = 2 * std::numbers::pi * (tooth + corner.fraction) / teeth;
      const double radius = pitchRadius(teeth) + corner.radius;
      outer.push_back({radius * std::cos(angle), radius * std::sin(angle)});
      bore.push_back({0.15 * std::cos(angle), 0.15 * std::sin(angle)});
    }
  }
  return prism(ringOutline(outer, bore), 0.2);
}

}  // namespace

void buildGears(SceneWorld& world, const SceneOptions& options) {
  constexpr int kDriving = 16, kDriven = 24;
  constexpr double kSpeed = 3;         // [rad/s]
  constexpr double kClearance = 0.01;  // [m] between tips and roots
  const double apart = pitchRadius(kDriving) + pitchRadius(kDriven) + kClearance;
  const auto addGear = [&](int teeth, std::size_t index, double x, double phase) {
    const std::size_t solid =
        world.addSolid(*makeSolid(gear(teeth), "gear"), options.spheres, progressOf(options, index, 2));
    const btTransform place(turn(vec(0, 0, 1), phase), vec(x, 0, 0));
    btRigidBody& body = world.addBody(solid, 1000, place, paletteColour(index));
    body.setFriction(0);
    const btVector3 axis = quatRotate(body.getWorldTransform().getRotation().inverse(), vec(0, 0, 1));
    btVector3 axis_in_body = axis;
    auto hinge = std::make_unique<btHingeConstraint>(body, vec(0, 0, 0), axis_in_body);
    if (index == 0) hinge->enableAngularMotor(true, btScalar(kSpeed), btScalar(1e4));
    world.addConstraint(std::move(hinge));
    return &body;
  };
  addGear(kDriving, 0, 0, 0);
  // Half way around there is a gap again; a tooth of the second gear goes into the first one's.
  btRigidBody& driven = *addGear(kDriven, 1, apart, std::numbers::pi / kDriven);
  driven.setDamping(0, btScalar(0.5));  // a load, so that it has to be driven
  const double ratio = -double(kDriving) / kDriven;
  world.expect({"speed of the driven gear over that of the driving one", "", Truth::Kind::equal, ratio,
                0.01 * std::abs(ratio), "teeth over teeth; 1 %",
                [](const Recording& r) {
                  return turnedAboutZ(r, 1, 0.5, r.seconds()) / turnedAboutZ(r, 0, 0.5, r.seconds());
                },
                3});
  world.expect({"speed of the driving gear", "rad/s", Truth::Kind::equal, kSpeed, 0.02 * kSpeed,
                "what its motor is set to: the teeth do not jam",
                [](const Recording& r) { return turnedAboutZ(r, 0, 0.5, r.seconds()) / (r.seconds() - 0.5); },
                3});
  world.film.has_ground = false;
  world.film.viewpoint = {0.1, 0.9, 0.45};
}

}  // namespace innersphere::demo
