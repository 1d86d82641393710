#include "mesh/mesh_holes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "common/bounds.hpp"

namespace innersphere {
namespace {

using Corners = std::array<std::uint32_t, 3>;
using Chain = std::vector<std::uint32_t>;

// How far the vertices of two loops may be from one plane, relative to the larger one.
constexpr double kFlat = 1e-3;

/// Adds the pieces of a triangle that has vertices on its sides: points[k] from corner k to the next.
void addPieces(const Corners& t, const std::array<Chain, 3>& points, std::vector<Corners>& pieces) {
  for (int k = 0; k < 3; ++k) {
    if (points[k].empty()) continue;
    Chain side{t[k]};
    side.insert(side.end(), points[k].begin(), points[k].end());
    side.push_back(t[(k + 1) % 3]);
    for (std::size_t i = 0; i + 1 < side.size(); ++i) {
      const bool last = i + 2 == side.size();
      addPieces({side[i], side[i + 1], t[(k + 2) % 3]},
                {Chain{}, last ? points[(k + 1) % 3] : Chain{}, i == 0 ? points[(k + 2) % 3] : Chain{}},
                pieces);
    }
    return;
  }
  pieces.push_back(t);
}

/// A loop of unbalanced edges as a polygon.
struct Rim {
  Chain corners;  ///< in the edges' sense; empty if the loop meets itself
  Vec3d middle{}, area{};
  double reach = 0;       ///< of the corners from the middle, at most
  std::size_t holes = 0;  ///< rims in it that turn the other way
  const Rim* around = nullptr;
};

std::vector<Rim> rimsOf(const Mesh& mesh, const Topology& topology) {
  std::vector<std::map<std::uint32_t, std::uint32_t>> next(topology.loops);
  std::vector<std::size_t> edges(topology.loops);
  for (std::size_t i = 0; i < topology.unbalanced.size(); ++i) {
    const HalfEdge& e = topology.unbalanced[i];
    next[topology.loop[i]].emplace(e.from, e.to);
    ++edges[topology.loop[i]];
  }
  std::vector<Rim> rims(topology.loops);
  for (std::size_t i = 0; i < rims.size(); ++i) {
    Rim& rim = rims[i];
    for (const auto& [from, to] : next[i]) rim.middle = rim.middle + mesh.vertices[from];
    rim.middle = (1.0 / static_cast<double>(next[i].size())) * rim.middle;
    if (edges[i] != next[i].size()) continue;
    std::uint32_t at = next[i].begin()->first;
    do {
      rim.corners.push_back(at);
      const auto edge = next[i].find(at);
      at = edge == next[i].end() ? rim.corners[0] : edge->second;
    } while (at != rim.corners[0] && rim.corners.size() <= edges[i]);
    if (rim.corners.size() != edges[i]) rim.corners.clear();
    for (std::size_t k = 0; k < rim.corners.size(); ++k) {
      const Vec3d a = mesh.vertices[rim.corners[k]] - rim.middle;
      rim.area = rim.area + 0.5 * cross(a, mesh.vertices[rim.corners[(k + 1) % edges[i]]] - rim.middle);
      rim.reach = std::max(rim.reach, norm(a));
    }
  }
  return rims;
}

/// Whether the inner rim lies in the outer one's plane and inside it, and turns the other way.
bool liesWithin(const Mesh& mesh, const Rim& inner, const Rim& outer) {
  if (inner.corners.empty() || outer.corners.empty()) return false;
  if (!(dot(inner.area, outer.area) < 0) || norm(inner.area) >= norm(outer.area)) return false;
  const Vec3d normal = (1 / norm(outer.area)) * outer.area;
  for (const Rim* rim : {&inner, &outer}) {
    for (std::uint32_t v : rim->corners) {
      if (std::abs(dot(mesh.vertices[v] - outer.middle, normal)) > kFlat * outer.reach) return false;
    }
  }
  // A ray in the plane from a corner of the inner rim crosses the outer one an odd number of times.
  const Vec3d x = (1 / norm(mesh.vertices[outer.corners[0]] - outer.middle)) *
                  (mesh.vertices[outer.corners[0]] - outer.middle);
  const Vec3d y = cross(normal, x), from = mesh.vertices[inner.corners[0]];
  bool inside = false;
  for (std::size_t k = 0; k < outer.corners.size(); ++k) {
    const Vec3d a = mesh.vertices[outer.corners[k]] - from;
    const Vec3d b = mesh.vertices[outer.corners[(k + 1) % outer.corners.size()]] - from;
    const double ya = dot(a, y), yb = dot(b, y);
    if ((ya > 0) == (yb > 0)) continue;
    if (dot(a, x) + (dot(b, x) - dot(a, x)) * ya / (ya - yb) > 0) inside = !inside;
  }
  return inside;
}

/// Fills the ring between two rims, from bridge to bridge, of which it takes the shorter one.
void addRing(Mesh& mesh, const Rim& outer, const Rim& inner) {
  const auto distance = [&](std::uint32_t a, std::uint32_t b) {
    return norm(mesh.vertices[a] - mesh.vertices[b]);
  };
  const std::uint32_t first = outer.corners[0];
  Chain out = outer.corners, in(inner.corners.rbegin(), inner.corners.rend());  // both turn alike
  std::rotate(in.begin(),
              std::min_element(
                  in.begin(), in.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return distance(a, first) < distance(b, first); }),
              in.end());
  out.push_back(out[0]);
  in.push_back(in[0]);
  for (std::size_t i = 0, j = 0; i + 1 < out.size() || j + 1 < in.size();) {
    const bool along_outer = j + 1 == in.size() || (i + 1 < out.size() && distance(out[i + 1], in[j]) <
                                                                              distance(out[i], in[j + 1]));
    if (along_outer) {
      mesh.triangles.push_back({out[i + 1], out[i], in[j]});
      ++i;
    } else {
      mesh.triangles.push_back({in[j], in[j + 1], out[i]});
      ++j;
    }
  }
}

}  // namespace

std::size_t splitAtVertices(Mesh& mesh, const Topology& topology, double tolerance) {
  Chain rim;
  for (const HalfEdge& e : topology.unbalanced) rim.insert(rim.end(), {e.from, e.to});
  const auto x = [&](std::uint32_t v) { return mesh.vertices[v][0]; };
  std::sort(rim.begin(), rim.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(x(a), a) < std::pair(x(b), b); });
  rim.erase(std::unique(rim.begin(), rim.end()), rim.end());

  std::map<std::uint32_t, std::array<Chain, 3>> splits;  // of triangles
  std::size_t split_edges = 0;
  for (const HalfEdge& e : topology.unbalanced) {
    const Vec3d from = mesh.vertices[e.from], along = mesh.vertices[e.to] - from;
    std::vector<std::pair<double, std::uint32_t>> found;
    const double least = std::min(x(e.from), x(e.to)) - tolerance,
                 most = std::max(x(e.from), x(e.to)) + tolerance;
    for (auto v = std::partition_point(rim.begin(), rim.end(), [&](std::uint32_t i) { return x(i) < least; });
         v != rim.end() && x(*v) <= most; ++v) {
      const Vec3d to = mesh.vertices[*v] - from;
      const double part = dot(to, along) / dot(along, along);
      if (*v != e.from && *v != e.to && part > 0 && part < 1 && norm(to - part * along) <= tolerance)
        found.emplace_back(part, *v);
    }
    if (found.empty()) continue;
    ++split_edges;
    std::sort(found.begin(), found.end());
    const Corners& t = mesh.triangles[e.triangle];
    Chain& points = splits[e.triangle][std::find(t.begin(), t.end(), e.from) - t.begin()];
    points.clear();
    for (const auto& [part, v] : found) points.push_back(v);
  }
  std::vector<Corners> pieces;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto split = splits.find(t);
    addPieces(mesh.triangles[t], split == splits.end() ? std::array<Chain, 3>{} : split->second, pieces);
  }
  mesh.triangles = std::move(pieces);
  return split_edges;
}

std::size_t closeLoops(Mesh& mesh, const Topology& topology) {
  std::vector<Rim> rims = rimsOf(mesh, topology);
  for (Rim& inner : rims) {
    for (Rim& outer : rims) {
      if (!liesWithin(mesh, inner, outer)) continue;
      ++outer.holes;
      if (!inner.around || norm(outer.area) < norm(inner.around->area)) inner.around = &outer;
    }
  }
  const std::size_t before = mesh.triangles.size();
  std::vector<bool> closed(rims.size());
  for (std::size_t i = 0; i < rims.size(); ++i) {
    const Rim* outer = rims[i].around;
    if (!outer || outer->holes != 1 || rims[i].holes > 0 || outer->around) continue;
    addRing(mesh, *outer, rims[i]);
    closed[i] = closed[static_cast<std::size_t>(outer - rims.data())] = true;
  }
  Chain middles(rims.size());
  for (std::size_t i = 0; i < rims.size(); ++i) {
    middles[i] = static_cast<std::uint32_t>(mesh.vertices.size());
    if (!closed[i]) mesh.vertices.push_back(rims[i].middle);
  }
  for (std::size_t i = 0; i < topology.unbalanced.size(); ++i) {
    const HalfEdge& e = topology.unbalanced[i];
    if (!closed[topology.loop[i]]) mesh.triangles.push_back({e.to, e.from, middles[topology.loop[i]]});
  }
  return mesh.triangles.size() - before;
}

}  // namespace innersphere
