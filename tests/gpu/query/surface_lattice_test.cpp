// Overlaps by triangles of solids made of cubes: in a lattice, where all faces, edges and corners coincide,
// their volume is counted; in other places it is that of cubes cut by the planes of cubes.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "conformance.hpp"

namespace innersphere::test {
namespace {

using Cell = std::array<int, 3>;
using Cells = std::set<Cell>;

/// Cells of a cube of `size`^3, each in the solid or not. Edges and corners may belong to several parts of
/// it.
Cells randomCells(Random& random, int size, double share) {
  Cells cells;
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) {
      for (int k = 0; k < size; ++k) {
        if (random.uniform() < share) cells.insert({i, j, k});
      }
    }
  }
  cells.insert({0, 0, 0});
  return cells;
}

/// Faces that have a cell on one side alone, each cut along one of its diagonals.
std::shared_ptr<CollisionModel> modelOf(const Cells& cells, Random& random) {
  const auto packing = makePacking({{0.5F, 0.5F, 0.5F, 0.45F}});
  Surface& surface = packing->surface;
  std::map<Cell, std::uint32_t> known;
  const auto vertex = [&](const Cell& at) {
    const auto [place, is_new] = known.try_emplace(at, static_cast<std::uint32_t>(known.size()));
    if (is_new) surface.vertices.push_back({float(at[0]), float(at[1]), float(at[2])});
    return place->second;
  };
  for (const Cell& cell : cells) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        Cell beside = cell;
        beside[axis] += side == 1 ? 1 : -1;
        if (cells.count(beside) > 0) continue;
        std::uint32_t corners[4];
        for (int c = 0; c < 4; ++c) {
          Cell at = cell;
          at[axis] += side;
          // Counter-clockwise seen from the end of the axis.
          at[(axis + 1) % 3] += c == 1 || c == 2;
          at[(axis + 2) % 3] += c >= 2;
          corners[side == 1 ? c : 3 - c] = vertex(at);
        }
        const int first = random.uniform() < 0.5 ? 0 : 1;
        for (const int from : {first, first + 2})
          surface.triangles.push_back({corners[from % 4], corners[(from + 1) % 4], corners[(from + 2) % 4]});
      }
    }
  }
  return std::make_shared<CollisionModel>(packing);
}

/// One of the 24 turns that take the lattice to itself.
Mat3d latticeTurn(int number) {
  Mat3d m{};
  const int axis = number % 3, sign_x = number / 3 % 2 ? 1 : -1, sign_y = number / 6 % 2 ? 1 : -1;
  const bool swapped = number / 12 % 2 == 1;
  const int x = axis, y = (axis + (swapped ? 2 : 1)) % 3, z = 3 - x - y;
  m[x] = sign_x;
  m[3 + y] = sign_y;
  m[6 + z] = sign_x * sign_y * (swapped ? -1 : 1);
  return m;
}

Vec3d times(const Mat3d& m, const Vec3d& v) {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
          m[6] * v.x + m[7] * v.y + m[8] * v.z};
}

struct Shared {
  double volume = 0;
  Vec3d moment{};
};

/// Counts cells a fourth as wide.
Shared countedOverlap(const Cells& a, const Cells& b, const Mat3d& turn, const Vec3d& place) {
  constexpr int kParts = 4;
  Shared shared;
  for (const Cell& cell : a) {
    for (int i = 0; i < kParts * kParts * kParts; ++i) {
      const Vec3d at{cell[0] + (i % kParts + 0.5) / kParts, cell[1] + (i / kParts % kParts + 0.5) / kParts,
                     cell[2] + (i / kParts / kParts + 0.5) / kParts};
      const Vec3d away = at - place;
      Cell of_b;
      for (int k = 0; k < 3; ++k)
        of_b[k] = int(std::floor(turn[k] * away.x + turn[3 + k] * away.y + turn[6 + k] * away.z));
      if (b.count(of_b) == 0) continue;
      shared.volume += 1;
      shared.moment = shared.moment + at;
    }
  }
  constexpr double kCell = 1.0 / (kParts * kParts * kParts);
  return {kCell * shared.volume, kCell * shared.moment};
}

using Polygon = std::vector<Vec3d>;

/// Cuts off what of a convex solid is above a plane. The new face needs no order: it is one fan per edge.
void cut(std::vector<Polygon>& faces, const Vec3d& normal, double height) {
  std::vector<Polygon> kept;
  Polygon rim;
  for (const Polygon& face : faces) {
    Polygon part;
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Vec3d &p = face[i], &q = face[(i + 1) % face.size()];
      const double hp = dot(normal, p) - height, hq = dot(normal, q) - height;
      if (hp <= 0) part.push_back(p);
      if ((hp > 0) != (hq > 0)) {
        part.push_back(p + hp / (hp - hq) * (q - p));
        rim.push_back(part.back());
      }
    }
    if (part.size() > 2) kept.push_back(part);
  }
  // Corners of the new face around their middle.
  Vec3d middle{};
  for (const Vec3d& p : rim) middle = middle + (1.0 / double(rim.size())) * p;
  const Vec3d other = std::abs(normal.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d u = cross(normal, other), v = cross(normal, u);
  const auto angle = [&](const Vec3d& p) { return std::atan2(dot(v, p - middle), dot(u, p - middle)); };
  std::sort(rim.begin(), rim.end(), [&](const Vec3d& p, const Vec3d& q) { return angle(p) < angle(q); });
  if (rim.size() > 2) kept.push_back(rim);
  faces = kept;
}

double volumeOf(const std::vector<Polygon>& faces) {
  if (faces.empty()) return 0;
  const Vec3d& apex = faces[0][0];
  double volume = 0;
  for (const Polygon& face : faces) {
    Vec3d area{};
    for (std::size_t i = 2; i < face.size(); ++i)
      area = area + cross(face[i - 1] - face[0], face[i] - face[0]);
    volume += std::abs(dot(area, face[0] - apex)) / 6;
  }
  return volume;
}

/// Of all pairs of cells what is in both.
double cutOverlap(const Cells& a, const Cells& b, const Mat3d& turn, const Vec3d& place) {
  double volume = 0;
  for (const Cell& of_a : a) {
    for (const Cell& of_b : b) {
      const Vec3d low{double(of_a[0]), double(of_a[1]), double(of_a[2])};
      const Vec3d from = times(turn, {double(of_b[0]), double(of_b[1]), double(of_b[2])}) + place;
      std::vector<Polygon> faces;
      for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {0.0, 1.0}) {
          Vec3d x{}, y{}, z{};
          z[axis] = side;
          x[(axis + 1) % 3] = 1;
          y[(axis + 2) % 3] = 1;
          faces.push_back({low + z, low + z + x, low + z + x + y, low + z + y});
        }
      }
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3d normal{turn[axis], turn[3 + axis], turn[6 + axis]};
        cut(faces, normal, dot(normal, from) + 1);
        cut(faces, -normal, -dot(normal, from));
      }
      volume += volumeOf(faces);
    }
  }
  return volume;
}

class SurfaceLatticeConformance : public Conformance {
 protected:
  Overlap overlap(const CollisionModel& a, const CollisionModel& b, const Mat3d& turn, const Vec3d& place) {
    PairQuery query;
    query.a = &a;
    query.b = &b;
    query.placement_b.rotation = turn;
    query.placement_b.translation = place;
    return makeContext().overlap(query, {Want::wrench, Estimator::surface});
  }
};

// Whatever coincides: faces, edges, corners, or all of two solids.
TEST_P(SurfaceLatticeConformance, CubesInOneLattice) {
  Random random(5);
  for (int i = 0; i < 400; ++i) {
    SCOPED_TRACE(i);
    const Cells cells_a = randomCells(random, 3, 0.5),
                cells_b = i % 5 == 0 ? cells_a : randomCells(random, 2, 0.6);
    const auto a = modelOf(cells_a, random), b = modelOf(cells_b, random);
    const Mat3d turn = i % 5 == 0 ? Mat3d{1, 0, 0, 0, 1, 0, 0, 0, 1} : latticeTurn(i);
    Vec3d place{};
    // Whole cells, halves and quarters.
    const double step = 1.0 / (1 << i % 3);
    if (i % 10 != 0) {
      for (double& x : place) x = step * std::round(random.uniform(-1, 3) / step);
    }
    const Shared expected = countedOverlap(cells_a, cells_b, turn, place);
    const Overlap got = overlap(*a, *b, turn, place);
    ASSERT_NEAR(got.volume, expected.volume, 1e-12);
    for (int k = 0; k < 3; ++k) ASSERT_NEAR(got.volume * got.centroid[k], expected.moment[k], 1e-11) << k;
  }
}

// In any place: where B turns by little, faces are nearly in one plane.
TEST_P(SurfaceLatticeConformance, CubesCutByCubes) {
  Random random(6);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const Cells cells_a = randomCells(random, 3, 0.5), cells_b = randomCells(random, 2, 0.6);
    const auto a = modelOf(cells_a, random), b = modelOf(cells_b, random);
    Mat3d turn = random.rotation();
    if (i % 3 == 0) {
      const double angle = std::pow(10, -random.uniform(1, 10));
      turn = {std::cos(angle), -std::sin(angle), 0, std::sin(angle), std::cos(angle), 0, 0, 0, 1};
    }
    Vec3d place;
    for (double& x : place) x = i % 2 == 0 ? std::round(random.uniform(-1, 3)) : random.uniform(-1, 3);
    ASSERT_NEAR(overlap(*a, *b, turn, place).volume, cutOverlap(cells_a, cells_b, turn, place), 1e-10);
  }
}

INNERSPHERE_FOR_EACH_BACKEND(SurfaceLatticeConformance);

}  // namespace
}  // namespace innersphere::test
