// Where a surface cut into triangles is curved, and where it ends: on cylinders both are known.
#include "surface/smooth_normals.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "outline_meshes.hpp"

namespace innersphere::test {
namespace {

constexpr double kRadius = 0.3, kHeight = 1;
constexpr std::uint32_t kSegments = 64, kRings = 4;  // rings of faces up the side

/// Triangles 2 (ring kSegments + segment) and the next are the side's, then come bottom and top. The seam
/// between the last segment and the first may have vertices of its own on each side.
Surface cylinder(bool seam) {
  const std::uint32_t columns = seam ? kSegments + 1 : kSegments;
  Surface surface;
  for (std::uint32_t ring = 0; ring <= kRings; ++ring) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const double angle = 2 * M_PI * i / kSegments;
      surface.vertices.push_back({static_cast<float>(kRadius * std::cos(angle)),
                                  static_cast<float>(kRadius * std::sin(angle)),
                                  static_cast<float>(kHeight * ring / kRings)});
    }
  }
  const auto at = [&](std::uint32_t ring, std::uint32_t i) { return ring * columns + i % columns; };
  for (std::uint32_t ring = 0; ring < kRings; ++ring) {
    for (std::uint32_t i = 0; i < kSegments; ++i) {
      surface.triangles.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i)});
      surface.triangles.push_back({at(ring + 1, i), at(ring, i + 1), at(ring + 1, i + 1)});
    }
  }
  const auto middle = static_cast<std::uint32_t>(surface.vertices.size());
  surface.vertices.push_back({0, 0, 0});
  surface.vertices.push_back({0, 0, static_cast<float>(kHeight)});
  for (std::uint32_t i = 0; i < kSegments; ++i) {
    surface.triangles.push_back({at(0, i + 1), at(0, i), middle});
    surface.triangles.push_back({at(kRings, i), at(kRings, i + 1), middle + 1});
  }
  return surface;
}

std::size_t sideTriangle(std::uint32_t ring, std::uint32_t segment) {
  return 2 * (ring * kSegments + segment);
}

/// In the first triangle of a face of the side, a third of its way up and across.
btVector3 placeOn(const Surface& surface, std::size_t triangle) {
  btVector3 sum(0, 0, 0);
  for (const std::uint32_t v : surface.triangles[triangle]) {
    const auto& p = surface.vertices[v];
    sum += btVector3(btScalar(p[0]), btScalar(p[1]), btScalar(p[2]));
  }
  return sum / 3;
}

/// On the top, and the way from there to the rim.
struct OnTop {
  explicit OnTop(const Surface& surface)
      : place(placeOn(surface, triangle)), outwards(btVector3(place.x(), place.y(), 0).normalized()) {}

  std::size_t triangle = 2 * kRings * kSegments + 2 * 7 + 1;
  btVector3 place;
  btVector3 outwards;  ///< unit
};

TEST(SmoothNormals, ASideGoesOnToTheRims) {
  const Surface surface = cylinder(false);
  const SmoothNormals normals(surface);
  for (std::uint32_t ring = 0; ring < kRings; ++ring) {
    const std::size_t triangle = sideTriangle(ring, 5);
    const btVector3 place = placeOn(surface, triangle);
    EXPECT_NEAR(normals.untilSharpEdge(triangle, place, btVector3(0, 0, 1)).distance, kHeight - place.z(),
                1e-5);
    EXPECT_NEAR(normals.untilSharpEdge(triangle, place, btVector3(0, 0, -1)).distance, place.z(), 1e-5);
  }
}

TEST(SmoothNormals, AroundACylinderNothingEnds) {
  const Surface surface = cylinder(false);
  const SmoothNormals normals(surface);
  const std::size_t triangle = sideTriangle(1, kSegments - 2);
  const btVector3 place = placeOn(surface, triangle);
  const btVector3 around(-place.y(), place.x(), 0);
  EXPECT_FALSE(normals.untilSharpEdge(triangle, place, around.normalized()).found());
  EXPECT_FALSE(normals.isPastSharpEdge(triangle, place + around * btScalar(0.3)));
}

TEST(SmoothNormals, ATopEndsAtItsRim) {
  const Surface surface = cylinder(false);
  const SmoothNormals normals(surface);
  const OnTop top(surface);
  const double rim = kRadius * std::cos(M_PI / kSegments);
  EXPECT_NEAR(normals.untilSharpEdge(top.triangle, top.place, top.outwards).distance,
              rim - std::hypot(double(top.place.x()), double(top.place.y())), 1e-5);
}

TEST(SmoothNormals, ARimIsTheSameFromBothSides) {
  const Surface surface = cylinder(false);
  const SmoothNormals normals(surface);
  const OnTop top(surface);
  const auto from_top = normals.untilSharpEdge(top.triangle, top.place, top.outwards);
  ASSERT_TRUE(from_top.found());
  const auto ends = normals.endsOf(from_top);
  EXPECT_NEAR(ends.from.z(), kHeight, 1e-6);
  EXPECT_NEAR(ends.to.z(), kHeight, 1e-6);
  EXPECT_NEAR(ends.from.distance(ends.to), 2 * kRadius * std::sin(M_PI / kSegments), 1e-5);
  const auto faces = normals.facesOf(from_top);
  EXPECT_NEAR(faces.inwards[0].dot(top.outwards), -1, 1e-5);
  EXPECT_NEAR(faces.inwards[1].z(), -1, 1e-5);
  const std::size_t side = sideTriangle(kRings - 1, 7);
  const auto from_side = normals.untilSharpEdge(side, placeOn(surface, side), btVector3(0, 0, 1));
  ASSERT_TRUE(from_side.found());
  EXPECT_EQ(normals.facesOf(from_side).id, faces.id);
}

TEST(SmoothNormals, TellWhatIsPastARim) {
  const Surface surface = cylinder(false);
  const SmoothNormals normals(surface);
  for (const std::size_t first : {sideTriangle(kRings - 1, 9), sideTriangle(kRings - 1, 9) + 1}) {
    const btVector3 place = placeOn(surface, first);
    const btScalar up = btScalar(kHeight) - place.z();
    EXPECT_FALSE(normals.isPastSharpEdge(first, place + btVector3(0, 0, btScalar(0.9) * up)));
    EXPECT_TRUE(normals.isPastSharpEdge(first, place + btVector3(0, 0, btScalar(1.1) * up)));
    // A line along the end of a cylinder is on either side by chance.
    EXPECT_FALSE(normals.isPastSharpEdge(first, place + btVector3(0, 0, btScalar(1 + 1e-5) * up)));
  }
}

TEST(SmoothNormals, ASeamIsNoEdge) {
  const Surface surface = cylinder(true);
  const SmoothNormals normals(surface);
  const std::size_t triangle = sideTriangle(1, kSegments - 1) + 1;
  const btVector3 place = placeOn(surface, triangle);
  const btVector3 around(-place.y(), place.x(), 0);
  EXPECT_FALSE(normals.untilSharpEdge(triangle, place, around.normalized()).found());
  EXPECT_FALSE(normals.isPastSharpEdge(triangle, place + around * btScalar(0.1)));
}

/// A tube along z with round ends, cut into few long triangles there and many short ones here. Those of the
/// side, two for each segment, come first.
Surface capsule(double radius, double length, std::uint32_t segments) {
  constexpr std::uint32_t kCap = 8;  // rings of each end, without its pole
  Surface surface;
  const auto ring = [&](std::uint32_t i) {  // from the lower pole up
    const bool upper = i >= kCap;
    const double angle = M_PI / 2 * (upper ? i - kCap : kCap - 1 - i) / kCap;
    const double z = (upper ? 1 : -1) * (length / 2 + radius * std::sin(angle));
    for (std::uint32_t k = 0; k < segments; ++k) {
      const double around = 2 * M_PI * k / segments, r = radius * std::cos(angle);
      surface.vertices.push_back({static_cast<float>(r * std::cos(around)),
                                  static_cast<float>(r * std::sin(around)), static_cast<float>(z)});
    }
  };
  for (std::uint32_t i = 0; i < 2 * kCap; ++i) ring(i);
  const auto at = [&](std::uint32_t i, std::uint32_t k) { return i * segments + k % segments; };
  const auto band = [&](std::uint32_t i) {
    for (std::uint32_t k = 0; k < segments; ++k) {
      surface.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k)});
      surface.triangles.push_back({at(i + 1, k), at(i, k + 1), at(i + 1, k + 1)});
    }
  };
  band(kCap - 1);
  for (std::uint32_t i = 0; i + 1 < 2 * kCap; ++i) {
    if (i != kCap - 1) band(i);
  }
  const auto pole = static_cast<std::uint32_t>(surface.vertices.size());
  for (const double side : {-1.0, 1.0})
    surface.vertices.push_back({0, 0, static_cast<float>(side * (length / 2 + radius))});
  for (std::uint32_t k = 0; k < segments; ++k) {
    surface.triangles.push_back({at(0, k + 1), at(0, k), pole});
    surface.triangles.push_back({at(2 * kCap - 1, k), at(2 * kCap - 1, k + 1), pole + 1});
  }
  return surface;
}

TEST(SmoothNormals, ALongSideIsStraightUpToItsRoundEnds) {
  constexpr double kTube = 0.1, kLength = 1;
  constexpr std::uint32_t kAround = 24;
  const Surface surface = capsule(kTube, kLength, kAround);
  const SmoothNormals normals(surface);
  for (std::uint32_t t = 0; t < 2 * kAround; ++t) {
    const btVector3 place = placeOn(surface, t);
    const btVector3 axis(0, 0, place.z()), out = (place - axis).normalized();
    SmoothNormals::Crossing crossing;
    ASSERT_TRUE(normals.cross(t, axis, out, crossing));
    const SmoothNormals::Place there = normals.at(t, crossing);
    EXPECT_NEAR(crossing.distance + there.bulge, kTube, 1e-3 * kTube);
    EXPECT_NEAR(there.normal.z(), 0, 1e-4);
  }
}

/// A triangle is flat to the last bit of its corners, with its own normal everywhere.
void expectFlat(const SmoothNormals& normals, std::size_t triangle) {
  SmoothNormals::Crossing crossing;
  const btVector3 out = normals.face(triangle);
  ASSERT_TRUE(normals.cross(triangle, normals.middle(triangle) + out, -out, crossing));
  const SmoothNormals::Place there = normals.at(triangle, crossing);
  EXPECT_NEAR(there.bulge, 0, 1e-6) << triangle;
  EXPECT_NEAR(there.normal.distance(out), 0, 1e-4) << triangle;
  EXPECT_EQ(normals.curvature(triangle), 0) << triangle;
}

double slope(double degrees) {
  return std::tan(degrees * M_PI / 180);
}

TEST(SmoothNormals, FacesThatMeetInOneEdgeAreFlat) {
  for (const double fold : {5.0, 10.0, 20.0, 28.0}) {
    const double top = 0.3 + slope(fold / 2);
    const SmoothNormals normals(surfaceOf(prismMesh({{-1, 0}, {1, 0}, {1, 0.3}, {0, top}, {-1, 0.3}})));
    for (std::size_t t = 0; t < 10; ++t) expectFlat(normals, t);
    // It ends at its ridge.
    const auto ridge = normals.untilSharpEdge(4, normals.middle(4), btVector3(-1, 0, 0));
    ASSERT_TRUE(ridge.found()) << fold;
    EXPECT_NEAR(normals.endsOf(ridge).from.x(), 0, 1e-6);
    EXPECT_NEAR(normals.endsOf(ridge).to.z(), top, 1e-6);
  }
}

/// How many vertices are tips, and how many are ends.
std::array<int, 2> tipsAndEndsOf(const Mesh& mesh) {
  const Surface surface = surfaceOf(mesh);
  const SmoothNormals normals(surface);
  int tips = 0, ends = 0;
  for (std::uint32_t v = 0; v < surface.vertices.size(); ++v) {
    tips += normals.isTip(v);
    ends += normals.isEnd(v);
    EXPECT_TRUE(normals.isEnd(v) || !normals.isTip(v));
  }
  EXPECT_EQ(normals.hasEnds(), ends > 0);
  return {tips, ends};
}

TEST(SmoothNormals, OnlyConesEndInTips) {
  const auto tipsOf = [](const Mesh& mesh) { return tipsAndEndsOf(mesh)[0]; };
  std::vector<std::array<double, 2>> ball;
  for (int i = 0; i <= 24; ++i)
    ball.push_back({i % 24 == 0 ? 0 : std::sin(M_PI * i / 24), -std::cos(M_PI * i / 24)});
  EXPECT_EQ(tipsOf(turnedMesh({{0, -1}, {0.5, 0}, {0, 1}}, 48)), 2);
  EXPECT_EQ(tipsOf(turnedMesh({{0, 0}, {0.5, 0}, {0, 1}}, 24)), 1);
  EXPECT_EQ(tipsOf(turnedMesh(ball, 48)), 0);
  EXPECT_EQ(tipsOf(turnedMesh({{0, 0}, {0.5, 0}, {0.5, 1}, {0, 1}}, 48)), 0);  // a cylinder
  EXPECT_EQ(tipsOf(turnedMesh({{0, 0}, {0.5, 0}, {0, 1}}, 4)), 0);             // a pyramid
}

TEST(SmoothNormals, ConvexSurfacesEndInTipsAndRims) {
  const auto endsOf = [](const Mesh& mesh) { return tipsAndEndsOf(mesh)[1]; };
  EXPECT_EQ(endsOf(turnedMesh({{0, 0}, {0.5, 0}, {0, 1}}, 24)), 25);            // a cone
  EXPECT_EQ(endsOf(turnedMesh({{0, 0}, {0.5, 0}, {0.5, 1}, {0, 1}}, 48)), 96);  // a cylinder
  // With a hollow in its top: that ends in no sharp edge of a convex surface.
  EXPECT_EQ(endsOf(turnedMesh({{0, 0}, {0.5, 0}, {0.5, 1}, {0.3, 1}, {0.3, 0.5}, {0, 0.5}}, 48)), 96);
  EXPECT_EQ(endsOf(prismMesh({{-1, 0}, {1, 0}, {1, 1}, {-1, 1}})), 0);  // a box
}

TEST(SmoothNormals, FacesOfAPyramidAreFlat) {
  Surface surface;
  surface.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 0.17F}, {0, 0, -1}};
  surface.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4},
                       {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}};
  const SmoothNormals normals(surface);
  for (std::size_t t = 0; t < 4; ++t) expectFlat(normals, t);
}

TEST(SmoothNormals, FacesOfAHipRoofAreFlat) {
  for (const double pitch : {5.0, 10.0, 14.0}) {
    const auto top = static_cast<float>(slope(pitch));
    Surface surface;
    surface.vertices = {{-2, -1, 0},  {2, -1, 0},  {2, 1, 0}, {-2, 1, 0},
                        {-1, 0, top}, {1, 0, top}, {0, 0, -1}};
    surface.triangles = {{0, 1, 5}, {0, 5, 4}, {2, 3, 5}, {3, 4, 5}, {1, 2, 5},
                         {3, 0, 4}, {1, 0, 6}, {2, 1, 6}, {3, 2, 6}, {0, 3, 6}};
    const SmoothNormals normals(surface);
    for (std::size_t t = 0; t < 6; ++t) expectFlat(normals, t);
  }
}

TEST(SmoothNormals, RampsAndCorrugationsAreFlat) {
  const double rise = 0.6 * slope(20), wave = 0.25 * slope(10);
  const SmoothNormals ramp(
      surfaceOf(prismMesh({{-1, 0}, {1, 0}, {1, 0.3 + rise}, {0.3, 0.3 + rise}, {-0.3, 0.3}, {-1, 0.3}})));
  for (std::size_t t = 0; t < 12; ++t) expectFlat(ramp, t);
  std::vector<std::array<double, 2>> outline{{-1, 0}, {1, 0}};
  for (int i = 0; i <= 8; ++i) outline.push_back({1 - 0.25 * i, 0.3 + (i % 2 == 0 ? 0 : wave)});
  const SmoothNormals sheet(surfaceOf(prismMesh(outline)));
  for (std::size_t t = 0; t < 2 * outline.size(); ++t) expectFlat(sheet, t);
}

/// Three faces in a row are an arc, unless vertices on the middle one show it to be flat.
TEST(SmoothNormals, VerticesAlongAFaceShowThatItIsFlat) {
  const double rise = 0.5 * slope(20), top = 0.3 + rise;
  const std::vector<std::array<double, 2>> low{{-1, 0}, {1, 0}, {1, 0.3}};
  for (const bool shown : {false, true}) {
    auto outline = low;
    outline.push_back({0.5, top});
    if (shown) outline.push_back({0, top});
    outline.insert(outline.end(), {{-0.5, top}, {-1, 0.3}});
    const SmoothNormals normals(surfaceOf(prismMesh(outline)));
    if (!shown) {
      EXPECT_GT(normals.curvature(6), 0);
      continue;
    }
    for (std::size_t t = 0; t < 2 * outline.size(); ++t) expectFlat(normals, t);
  }
}

/// A bottle with a straight wall in some rings and a straight shoulder: cone and cylinder are exactly known.
TEST(SmoothNormals, WallAndShoulderOfABottleMeetInAFold) {
  constexpr double kWall = 0.135, kNeck = 0.045, kLength = 0.5;
  constexpr std::uint32_t kAround = 96;
  for (const double lean : {10.0, 26.6}) {
    for (const int rings : {1, 4, 16, 64}) {
      const double top = kLength + (kWall - kNeck) / slope(lean);
      std::vector<std::array<double, 2>> outline{{0, 0}};
      for (int i = 0; i <= rings; ++i) outline.push_back({kWall, kLength * i / rings});
      outline.insert(outline.end(), {{kNeck, top}, {kNeck, top + 0.2}, {0, top + 0.2}});
      const Surface surface = surfaceOf(turnedMesh(outline, kAround));
      const SmoothNormals normals(surface);
      for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const btVector3 middle = normals.middle(t);
        const bool shoulder = middle.z() > kLength;
        if (std::fabs(normals.face(t).z()) > 0.9 || middle.z() > top) continue;  // bottom and neck
        const double up = shoulder ? std::sin(lean * M_PI / 180) : 0;
        SmoothNormals::Crossing crossing;
        const btVector3 out = normals.face(t);
        ASSERT_TRUE(normals.cross(t, middle + out, -out, crossing));
        const SmoothNormals::Place there = normals.at(t, crossing);
        const btVector3 place = middle + out * there.bulge;
        const double radius = shoulder ? kNeck + (top - place.z()) * slope(lean) : kWall;
        EXPECT_NEAR(std::hypot(double(place.x()), double(place.y())), radius, 3e-5) << t << " of " << rings;
        EXPECT_NEAR(there.normal.z(), up, 1e-3) << t << " of " << rings;
      }
    }
  }
}

/// A rounding ends in a wall along which it is tangential: no fold. Both go on in each other.
TEST(SmoothNormals, ARoundingGoesOnInItsWall) {
  constexpr double kWall = 0.1, kRound = 0.02, kHeight = 0.3;
  for (const int rings : {1, 30}) {
    std::vector<std::array<double, 2>> outline{{0, 0}};
    for (int i = 0; i <= rings; ++i) outline.push_back({kWall, kHeight * i / rings});
    for (int i = 1; i <= 8; ++i) {
      const double angle = M_PI / 16 * i;
      outline.push_back({kWall - kRound * (1 - std::cos(angle)), kHeight + kRound * std::sin(angle)});
    }
    outline.push_back({0, kHeight + kRound});
    const Surface surface = surfaceOf(turnedMesh(outline, 48));
    const SmoothNormals normals(surface);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const btVector3 middle = normals.middle(t);
      if (middle.z() < kHeight || normals.face(t).z() > 0.999) continue;
      const btVector3 down(0, 0, -1);
      const auto ending = normals.untilSharpEdge(t, middle, down);
      if (ending.found()) {
        EXPECT_LT(normals.endsOf(ending).from.z(), 0.01) << t;
      }
      SmoothNormals::Crossing crossing;
      const btVector3 out = normals.face(t);
      ASSERT_TRUE(normals.cross(t, middle + out, -out, crossing));
      const btVector3 place = middle + out * normals.at(t, crossing).bulge;
      const double from_axis = std::hypot(double(place.x()), double(place.y()));
      const double from_ring = std::hypot(from_axis - (kWall - kRound), double(place.z()) - kHeight);
      EXPECT_NEAR(from_ring, kRound, 2e-4) << t;
    }
  }
}

/// A square in z = 0 with a wall down from its edge y = 0, on the middle of which there is a vertex, but for
/// rounding. Triangle 0 reaches along the whole edge, triangle 2 is the sliver beside it.
Surface squareWithASliver(float rounding) {
  Surface surface;
  surface.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5F, rounding, 0}, {0.5F, 0, -1}};
  surface.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 1}, {0, 5, 4}, {4, 5, 1}};
  return surface;
}

// All quadrangles of a torus have their diagonals to one side. Normals that are linear in each triangle lean
// to that side, by a twelfth of what bends along both of its sides at once: 2.5 mrad in places where it is
// steepest.
TEST(SmoothNormals, OfATorusDoNotLeanToTheSideOfItsDiagonals) {
  constexpr double kRing = 0.095, kTube = 0.005;
  constexpr std::uint32_t kAround = 96, kAcross = 24;
  Surface surface;
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t k = 0; k < kAcross; ++k) {
      const double a = 2 * M_PI * i / kAround, b = 2 * M_PI * k / kAcross, r = kRing + kTube * std::cos(b);
      surface.vertices.push_back(
          {float(r * std::cos(a)), float(r * std::sin(a)), float(kTube * std::sin(b))});
    }
  }
  const auto at = [](std::uint32_t i, std::uint32_t k) { return i % kAround * kAcross + k % kAcross; };
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t k = 0; k < kAcross; ++k) {
      surface.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      surface.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  const SmoothNormals normals(surface);
  double lean = 0, square = 0;
  std::size_t count = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const auto& weights :
         {std::array<btScalar, 3>{0.6f, 0.2f, 0.2f}, {0.2f, 0.6f, 0.2f}, {0.2f, 0.2f, 0.6f}}) {
      btVector3 place(0, 0, 0);
      for (std::size_t k = 0; k < 3; ++k) place += normals.corners(t)[k] * weights[k];
      // Upper half only: there the sense of the lean is one.
      if (!(place.z() > 0)) continue;
      const btVector3 out = btVector3(place.x(), place.y(), 0).normalized();
      const btVector3 exact = (place - out * btScalar(kRing)).normalized();
      const double aside = (normals.at(t, {0, weights}).normal - exact).dot(btVector3(0, 0, 1).cross(out));
      lean += aside;
      square += aside * aside;
      ++count;
    }
  }
  const double across = 2 * M_PI / kAround * 2 * M_PI / kAcross;  // what lacks is across sin(b) u v
  EXPECT_LT(std::fabs(lean / double(count)), across / 12 * 0.02);
  EXPECT_LT(std::sqrt(square / double(count)), across / 12 * 0.2);
}

TEST(SmoothNormals, ASliverBelongsToTheFaceItLiesOn) {
  for (const float rounding : {-6e-8F, 0.0F, 6e-8F}) {
    const Surface surface = squareWithASliver(rounding);
    const SmoothNormals normals(surface);
    EXPECT_NEAR(normals.face(2).distance(btVector3(0, 0, 1)), 0, 1e-6) << rounding;
    EXPECT_EQ(normals.curvature(0), 0);
    // The square ends at the wall, on either side of the vertex.
    for (const btScalar x : {btScalar(0.3), btScalar(0.7)}) {
      const btVector3 place(x, btScalar(0.25), 0), down(0, -1, 0);
      const auto ending = normals.untilSharpEdge(0, place, down);
      ASSERT_TRUE(ending.found()) << rounding;
      EXPECT_NEAR(ending.distance, 0.25, 1e-6);
      const auto ends = normals.endsOf(ending);
      EXPECT_NEAR(ends.from.y(), 0, 1e-7) << rounding;
      EXPECT_NEAR(ends.to.y(), 0, 1e-7) << rounding;
      // Which half of the edge it is shows only where the sliver has a height.
      EXPECT_NEAR(ends.from.distance(ends.to), 0.5, 1e-6);
    }
  }
}

}  // namespace
}  // namespace innersphere::test
