// Teeth and studs between walls that they do not touch: no contact is found where there is none.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "innersphere/mesh.hpp"
#include "named_packings.hpp"
#include "outline_meshes.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

using Outline = std::vector<std::array<double, 2>>;

constexpr double kModule = 0.05, kPlay = 0.004;  // [m]

/// Involute teeth with a pressure angle of 20 degrees (ISO 21771), each flank of so many facets, that are
/// thinner, or of a ring farther apart, by the play on the pitch circle. The first tooth points along x.
Outline teeth(int count, int facets, bool of_ring) {
  constexpr double kPressure = 20 * M_PI / 180, kHigh = 0.8 * kModule, kLow = 1.2 * kModule;
  const double pitch = count * kModule / 2, base = pitch * std::cos(kPressure);
  const double low = pitch - (of_ring ? kHigh : kLow), high = pitch + (of_ring ? kLow : kHigh);
  const auto involute = [](double angle) { return std::tan(angle) - angle; };
  const auto halfTooth = [&](double radius) {
    return M_PI / (2 * count) + (of_ring ? kPlay : -kPlay) / (2 * pitch) + involute(kPressure) -
           involute(std::acos(std::min(1.0, base / radius)));
  };
  const double start = std::max(1.0005 * base, low);
  std::vector<std::array<double, 2>> flank;  // radius and angle from the middle of the tooth
  flank.push_back({low, halfTooth(start)});
  for (int k = 0; k <= facets; ++k) {
    const double radius = start + (high - start) * k / facets;
    if (radius > flank.back()[0]) flank.push_back({radius, halfTooth(radius)});
  }
  Outline outline;
  const auto add = [&](double radius, double angle) {
    outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  };
  for (int i = 0; i < count; ++i) {
    const double middle = 2 * M_PI * (i + (of_ring ? 0.5 : 0)) / count;
    for (const auto& [radius, angle] : flank) add(radius, middle - angle);
    for (auto place = flank.rbegin(); place != flank.rend(); ++place) add((*place)[0], middle + (*place)[1]);
  }
  return outline;
}

/// A wheel with a bore, or a ring, along y, of 16 cm.
std::shared_ptr<PackingShape> gear(int count, int facets, bool of_ring, std::size_t spheres) {
  const Outline outline = teeth(count, facets, of_ring);
  const double rim = of_ring ? count * kModule / 2 + 0.2 : 0.1;
  Outline circle;
  for (const auto& p : outline) {
    const double times = rim / std::hypot(p[0], p[1]);
    circle.push_back({times * p[0], times * p[1]});
  }
  Mesh mesh = of_ring ? prismBetween(circle, outline, true) : prismBetween(outline, circle, true);
  for (Vec3d& v : mesh.vertices) v[1] *= 0.16;
  return makePackedShape(*makeSolid(mesh, "gear of " + std::to_string(count)), spheres);
}

/// Two bodies that are tried in many places.
class Pair {
 public:
  Pair(const std::shared_ptr<PackingShape>& a, const std::shared_ptr<PackingShape>& b)
      : shapes_{a, b},
        bodies_{&world_.add(a, 1, btVector3(0, 0, 0)), &world_.add(b, 1, btVector3(0, 0, 0))} {}

  /// Puts the mesh of a body turned about y at a place in x and z, and there tilted about z.
  void place(int body, double x, double z, double angle, double tilt = 0) {
    const btTransform place(
        btQuaternion(btVector3(0, 0, 1), btScalar(tilt)) * btQuaternion(btVector3(0, 1, 0), btScalar(-angle)),
        btVector3(btScalar(x), 0, btScalar(z)));
    bodies_[body]->setWorldTransform(shapes_[body]->bodyTransform(place));
  }

  /// The contact that is nearest, of those whose normals are this close to the direction.
  double distance(const btVector3& direction = {0, 0, 0}, double cosine = 0) {
    struct Nearest : btCollisionWorld::ContactResultCallback {
      btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                               const btCollisionObjectWrapper*, int, int) override {
        if (std::fabs(double(point.m_normalWorldOnB.dot(direction))) >= cosine)
          distance = std::min(distance, double(point.getDistance()));
        return 0;
      }
      btVector3 direction;
      double cosine, distance = 1;
    } nearest;
    nearest.direction = direction;
    nearest.cosine = cosine;
    world_.world.contactPairTest(bodies_[0], bodies_[1], nearest);
    return nearest.distance;
  }

 private:
  TestWorld world_;
  std::array<std::shared_ptr<PackingShape>, 2> shapes_;
  std::array<btRigidBody*, 2> bodies_;
};

// In the middle of their play, flanks are 1.9 mm apart at least.
TEST(NearTeeth, OfTwoWheelsAreNotTakenForDeep) {
  constexpr int kSmall = 18, kLarge = 36, kPhases = 200;
  Pair pair(gear(kSmall, 5, false, 256), gear(kLarge, 5, false, 256));
  for (int i = 0; i < kPhases; ++i) {
    const double phase = 2 * M_PI / kSmall * i / kPhases;
    pair.place(0, (kSmall + kLarge) * kModule / 2, 0, M_PI / kSmall + phase);
    pair.place(1, 0, 0, -phase * kSmall / kLarge);
    EXPECT_GT(pair.distance(), 0.001) << "phase " << i;
  }
}

// A hollow, as the foot of a tooth is, says nothing of what is apart from it. Of 200 phases 76 were told to
// touch.
TEST(NearTeeth, OfAWheelInARingAreSeldomTakenForTouching) {
  constexpr int kSmall = 18, kLarge = 54, kPhases = 200;
  Pair pair(gear(kSmall, 12, false, 256), gear(kLarge, 12, true, 256));
  int touching = 0;
  for (int i = 0; i < kPhases; ++i) {
    const double phase = 2 * M_PI / kSmall * i / kPhases;
    pair.place(0, (kLarge - kSmall) * kModule / 2, 0, M_PI / kSmall + phase);
    pair.place(1, 0, 0, phase * kSmall / kLarge);
    const double distance = pair.distance();
    touching += distance < 0.0002;
    EXPECT_GT(distance, -0.001) << "phase " << i;
  }
  EXPECT_LE(touching, kPhases / 20);
}

// A toy brick whose rim has sunk into the plate below by less than a millimetre, with a millimetre of play
// around the stud: its walls stand in the plate by no more than that, though by 15 mm along its face.
TEST(NearTeeth, OfASunkRimNothingIsDeepSideways) {
  constexpr double kWide = 0.046, kStud = 0.03, kGap = 0.001;
  const auto asLong = [](Mesh mesh) {
    for (Vec3d& v : mesh.vertices) v[1] *= 0.2;
    return mesh;
  };
  const Mesh plate = asLong(prismMesh({{0, -0.02},
                                       {kWide, -0.02},
                                       {kWide, 0},
                                       {kStud, 0},
                                       {kStud, 0.02},
                                       {-kStud, 0.02},
                                       {-kStud, 0},
                                       {-kWide, 0},
                                       {-kWide, -0.02}}));
  const Mesh brick = asLong(prismBetween(
      {{kWide, 0}, {kWide, 0.06}, {-kWide, 0.06}, {-kWide, 0}},
      {{kStud + kGap, 0}, {kStud + kGap, 0.035}, {-kStud - kGap, 0.035}, {-kStud - kGap, 0}}, false));
  Pair pair(makePackedShape(*makeSolid(plate, "plate"), 1000),
            makePackedShape(*makeSolid(brick, "brick"), 1000));
  pair.place(0, 0, 0, 0);
  for (const double sunk : {0.0001, 0.0002, 0.0003, 0.0005, 0.001}) {
    for (int i = -10; i <= 10; ++i) {
      const double x = 0.9 * kGap * i / 10;
      for (const double angle : {-0.002, 0.0, 0.002}) {
        pair.place(1, x, -sunk, angle);
        EXPECT_GT(pair.distance(btVector3(1, 0, 0), 0.7), -0.001) << sunk << " m, " << x << " m, " << angle;
      }
    }
  }
}

}  // namespace
}  // namespace innersphere::test
