#include "scans.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "innersphere/mesh.hpp"
#include "random.hpp"
#include "shapes.hpp"

namespace innersphere::demo {
namespace {

// A ball with harmonics of degree two and three about axes of their own.
Mesh lumpOf(std::uint64_t seed) {
  struct Wave {
    Vec3d axis;
    double height;
  };
  Random random(seed);
  const auto anyWave = [&random](double highest) {
    const btVector3 axis = quatRotate(random.rotation(), btVector3(0, 0, 1));
    return Wave{{double(axis.x()), double(axis.y()), double(axis.z())}, random.between(-highest, highest)};
  };
  const std::vector<Wave> twos{anyWave(0.3), anyWave(0.3), anyWave(0.3)};
  const std::vector<Wave> threes{anyWave(0.2), anyWave(0.2), anyWave(0.2)};
  const auto radius = [&](const Vec3d& n) {
    const auto along = [&n](const Wave& w) { return n[0] * w.axis[0] + n[1] * w.axis[1] + n[2] * w.axis[2]; };
    double r = 1;
    for (const Wave& wave : twos) r += wave.height * (3 * std::pow(along(wave), 2) - 1) / 2;
    for (const Wave& wave : threes) r += wave.height * (5 * std::pow(along(wave), 3) - 3 * along(wave)) / 2;
    return std::max(r, 0.3);
  };
  return lump(radius, 4);
}

// Two horns that taper to a tenth of the head's radius stand out of it, with their roots inside.
Mesh hornedHead() {
  constexpr int kSteps = 16;
  constexpr double kBend = 0.8, kThick = 0.12, kThin = 0.03;
  Mesh mesh = lumpOf(7);
  std::vector<Point2> path;
  std::vector<double> radii;
  for (int i = 0; i <= kSteps; ++i) {
    const double part = double(i) / kSteps, angle = 2 * part;
    path.push_back({0.4 + kBend * std::sin(angle), kBend * (1 - std::cos(angle))});
    radii.push_back(kThick + (kThin - kThick) * part);
  }
  const Mesh horn = tube(path, radii, 16, false);
  for (const double side : {-1.0, 1.0}) {
    // Turned by half a turn about the vertical.
    append(mesh, horn, [side](const Vec3d& p) { return Vec3d{side * p[0], side * p[2], p[1] + 0.2}; });
  }
  return mesh;
}

// A trumpet's bell, with a wall of a fortieth of its length.
Mesh openHorn() {
  constexpr int kSteps = 24;
  constexpr double kLength = 2, kWall = 0.05;
  const auto radius = [](double z) { return 0.12 + 0.15 * z * z; };
  std::vector<Point2> profile{{0, 0}};
  for (int i = 0; i <= kSteps; ++i) {
    const double z = kLength * i / kSteps;
    profile.push_back({radius(z), z});
  }
  for (int i = kSteps; i > 0; --i) {
    const double z = kLength * i / kSteps;
    profile.push_back({radius(z) - kWall, i == kSteps ? kLength : z});
  }
  profile.push_back({0, kLength / kSteps});
  return lathe(profile, 48);
}

}  // namespace

std::vector<std::shared_ptr<const Solid>> scans() {
  std::vector<std::shared_ptr<const Solid>> solids;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    solids.push_back(makeSolid(lumpOf(seed), "lump " + std::to_string(seed)));
  }
  solids.push_back(makeSolid(hornedHead(), "head with horns"));
  solids.push_back(makeSolid(openHorn(), "open horn"));
  return solids;
}

}  // namespace innersphere::demo
