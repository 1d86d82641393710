#include "mesh/beside_triangles.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/mesh_topology.hpp"

namespace innersphere {
namespace {

using Corners = std::array<std::uint32_t, 3>;

constexpr std::uint32_t kNone = UINT32_MAX;

// A point beside a triangle is so far away, relative to the root of its area.
constexpr double kBeside = 1e-3;

// Triangles face alike if the cosine is larger. Of one with less height to its length it is not known where
// it faces.
constexpr double kAlike = 0.1, kThin = 1e-5;

/// Finds the triangles across the edges, of which edge k leads from corner k to the next.
std::vector<Corners> neighboursOf(const Mesh& mesh, const std::vector<bool>& touched) {
  std::vector<Corners> neighbours(mesh.triangles.size(), Corners{kNone, kNone, kNone});
  const std::vector<HalfEdge> edges = sortedHalfEdges(mesh);
  for (auto e = edges.begin(); e != edges.end();) {
    const auto first = e;
    while (e != edges.end() && e->low() == first->low() && e->high() == first->high()) ++e;
    if (e - first != 2 || first[0].from == first[1].from) continue;
    if (touched[first[0].triangle] || touched[first[1].triangle]) continue;
    for (int i = 0; i < 2; ++i) {
      const Corners& t = mesh.triangles[first[i].triangle];
      neighbours[first[i].triangle][std::find(t.begin(), t.end(), first[i].from) - t.begin()] =
          first[1 - i].triangle;
    }
  }
  return neighbours;
}

/// Marks triangles of which those around each corner are one fan, untouched, and face alike.
void findGentle(const Mesh& mesh, const std::vector<Corners>& neighbours, std::vector<BesideTriangle>& all) {
  std::vector<int> uses(mesh.vertices.size());
  std::vector<Vec3d> normals;
  for (const Corners& t : mesh.triangles) {
    for (const std::uint32_t v : t) ++uses[v];
    const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3d ab = b - a, ac = c - a, bc = c - b, normal = cross(ab, ac);
    const double length = norm(normal), longest2 = std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)});
    normals.push_back(length > kThin * longest2 ? (1 / length) * normal : Vec3d{});
  }
  const auto isGentleAt = [&](std::uint32_t first, std::uint32_t corner) {
    std::uint32_t t = first;
    for (int left = uses[corner]; left > 0; --left) {
      const Corners& v = mesh.triangles[t];
      t = neighbours[t][(std::find(v.begin(), v.end(), corner) - v.begin() + 2) % 3];
      if (t == kNone || !(dot(normals[t], normals[first]) > kAlike)) return false;
      if (t == first) return left == 1;
    }
    return false;
  };
  for (std::uint32_t t = 0; t < all.size(); ++t) {
    const Corners& corners = mesh.triangles[t];
    all[t].gentle = std::all_of(corners.begin(), corners.end(),
                                [&](std::uint32_t corner) { return isGentleAt(t, corner); });
  }
}

/// From a triangle to its neighbour the number stays the same.
void findWindings(const Mesh& mesh, const std::vector<Corners>& neighbours, std::vector<bool> seen,
                  const ClosestTriangle& closest, const WindingTree& winding,
                  std::vector<BesideTriangle>& all) {
  for (BesideTriangle& one : all) one.winding_in_front = kUnknownWinding;
  // Known from a point beside one of them that has no other triangle nearby.
  const auto numberAt = [&](std::uint32_t triangle) {
    const Corners& t = mesh.triangles[triangle];
    const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3d normal = cross(b - a, c - a);
    const Vec3d p = (1.0 / 3) * (a + b + c) + (kBeside / std::sqrt(norm(normal))) * normal;
    const Triangle* nearest = closest.closest(p, std::numeric_limits<double>::infinity()).triangle;
    const bool is_beside =
        nearest && closest.indexOf(*nearest) == triangle && closest.sideOf(p, *nearest, false) > 0;
    return is_beside ? static_cast<int>(std::lround(winding.windingNumber(p))) : kUnknownWinding;
  };
  for (std::uint32_t first = 0; first < all.size(); ++first) {
    if (seen[first]) continue;
    seen[first] = true;
    std::vector<std::uint32_t> part{first};
    for (std::size_t i = 0; i < part.size(); ++i) {
      for (const std::uint32_t next : neighbours[part[i]]) {
        if (next == kNone || seen[next]) continue;
        seen[next] = true;
        part.push_back(next);
      }
    }
    int number = kUnknownWinding;
    for (std::size_t i = 0; i < part.size() && number == kUnknownWinding; ++i) number = numberAt(part[i]);
    for (const std::uint32_t t : part) all[t].winding_in_front = number;
  }
}

}  // namespace

std::vector<BesideTriangle> findBeside(const Mesh& mesh, const std::vector<bool>& touched, bool may_overlap,
                                       const ClosestTriangle& closest, const WindingTree& winding) {
  std::vector<BesideTriangle> all(mesh.triangles.size());
  const std::vector<Corners> neighbours = neighboursOf(mesh, touched);
  findGentle(mesh, neighbours, all);
  if (may_overlap) findWindings(mesh, neighbours, touched, closest, winding, all);
  return all;
}

}  // namespace innersphere
