#include "local_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <numeric>
#include <utility>

namespace innersphere::test {
namespace {

constexpr double kFar = 1e9;        // [m]
constexpr double kFlat = 1e-6;      // sine between faces in one plane
constexpr double kParallel = 1e-4;  // sine between edges without a normal
constexpr double kTiny = 1e-10;     // [m]

Vec3d unit(const Vec3d& v) {
  return (1 / norm(v)) * v;
}

/// Where a line meets a triangle, in lengths of `way`; kFar if it misses it.
double meet(const Vec3d& from, const Vec3d& way, const PlacedMesh& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Vec3d& n = mesh.normals[triangle];
  const double along = dot(way, n);
  if (along == 0) return kFar;
  const double s = dot(mesh.corners[t[0]] - from, n) / along;
  const Vec3d at = from + s * way;
  for (int k = 0; k < 3; ++k) {
    const Vec3d& p = mesh.corners[t[k]];
    if (dot(cross(mesh.corners[t[(k + 1) % 3]] - p, at - p), n) < 0) return kFar;
  }
  return s;
}

/// Two edges seen along the normal to both: where they cross, in lengths of each.
struct Crossing {
  Vec3d normal{};
  double s = kFar, t = kFar;
  bool isOn() const { return s > 0 && s < 1 && t > 0 && t < 1; }
};

Crossing crossEdges(const Vec3d& p, const Vec3d& u, const Vec3d& q, const Vec3d& v, const Vec3d& across) {
  const double square = dot(across, across);
  return {unit(across), dot(cross(q - p, v), across) / square, dot(cross(q - p, u), across) / square};
}

/// A place where an edge of the one goes through a triangle of the other.
struct Pierced {
  bool of_a;  ///< the edge
  std::size_t edge, triangle;
  Vec3d at;
};

using Indices = std::vector<std::size_t>;

void addPierced(const PlacedMesh& edges, const Indices& of, const PlacedMesh& faces, const Indices& by,
                bool of_a, std::vector<Pierced>& found) {
  for (const std::size_t e : of) {
    const Vec3d& from = edges.corners[edges.edges[e].from];
    const Vec3d way = edges.corners[edges.edges[e].to] - from;
    for (const std::size_t t : by) {
      const double s = meet(from, way, faces, t);
      if (s > 0 && s < 1) found.push_back({of_a, e, t, from + s * way});
    }
  }
}

/// The parts of two meshes that are near a place.
struct Near {
  Indices edges, triangles;
};

Near allOf(const PlacedMesh& mesh) {
  Near near{Indices(mesh.edges.size()), Indices(mesh.triangles.size())};
  std::iota(near.edges.begin(), near.edges.end(), 0);
  std::iota(near.triangles.begin(), near.triangles.end(), 0);
  return near;
}

/// Those whose boxes are within the box from `min` to `max`, or meet it.
Near partOf(const PlacedMesh& mesh, const Vec3d& min, const Vec3d& max) {
  const auto isNear = [&](std::initializer_list<int> corners) {
    for (int k = 0; k < 3; ++k) {
      double low = kFar, high = -kFar;
      for (const int c : corners) {
        low = std::min(low, mesh.corners[c][k]);
        high = std::max(high, mesh.corners[c][k]);
      }
      if (low > max[k] || high < min[k]) return false;
    }
    return true;
  };
  Near near;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (isNear({mesh.edges[e].from, mesh.edges[e].to})) near.edges.push_back(e);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& c = mesh.triangles[t];
    if (isNear({c[0], c[1], c[2]})) near.triangles.push_back(t);
  }
  return near;
}

std::vector<Pierced> piercedOf(const PlacedMesh& a, const Near& near_a, const PlacedMesh& b,
                               const Near& near_b) {
  std::vector<Pierced> found;
  addPierced(a, near_a.edges, b, near_b.triangles, true, found);
  addPierced(b, near_b.edges, a, near_a.triangles, false, found);
  return found;
}

/// The edges of a triangle.
std::vector<std::array<std::size_t, 3>> edgesOfTriangles(const PlacedMesh& mesh) {
  std::map<std::pair<int, int>, std::size_t> edge;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) edge[{mesh.edges[e].from, mesh.edges[e].to}] = e;
  std::vector<std::array<std::size_t, 3>> all;
  for (const auto& t : mesh.triangles) {
    std::array<std::size_t, 3> of{};
    for (int k = 0; k < 3; ++k) of[k] = edge.at(std::minmax(t[k], t[(k + 1) % 3]));
    all.push_back(of);
  }
  return all;
}

/// Whether the curves in which the surfaces meet are one. Where two triangles meet, they do in a line between
/// two places where an edge of the one goes through the other.
bool areOne(const PlacedMesh& a, const PlacedMesh& b, const std::vector<Pierced>& found) {
  const auto of_a = edgesOfTriangles(a), of_b = edgesOfTriangles(b);
  const auto trianglesWith = [](const auto& of, std::size_t edge) {
    Indices with;
    for (std::size_t t = 0; t < of.size(); ++t) {
      if (std::find(of[t].begin(), of[t].end(), edge) != of[t].end()) with.push_back(t);
    }
    return with;
  };
  std::map<std::pair<std::size_t, std::size_t>, Indices> of_pair;
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const std::size_t t : trianglesWith(found[i].of_a ? of_a : of_b, found[i].edge))
      of_pair[found[i].of_a ? std::pair(t, found[i].triangle) : std::pair(found[i].triangle, t)].push_back(i);
  }
  Indices group(found.size());
  std::iota(group.begin(), group.end(), 0);
  for (const auto& [pair, places] : of_pair) {
    for (const std::size_t i : places) {
      const std::size_t from = group[i], to = group[places[0]];
      std::replace(group.begin(), group.end(), from, to);
    }
  }
  return std::all_of(group.begin(), group.end(), [&](std::size_t g) { return g == group[0]; });
}

/// The nearest places of two meshes that do not meet.
struct Apart {
  double distance = kFar;
  Vec3d on_a{}, on_b{};
  bool regular = false;  ///< a corner over a face, or two edges that cross
};

Apart apartOf(const PlacedMesh& a, const Near& near_a, const PlacedMesh& b, const Near& near_b) {
  Apart least;
  const auto take = [&](const Vec3d& on_a, const Vec3d& on_b, bool regular) {
    const double distance = norm(on_b - on_a);
    if (distance < least.distance) least = {distance, on_a, on_b, regular};
  };
  const auto overFaces = [&](const PlacedMesh& of, const Near& corners, const PlacedMesh& faces,
                             const Near& by, bool of_a) {
    for (const std::size_t e : corners.edges) {
      for (const int c : {of.edges[e].from, of.edges[e].to}) {
        const Vec3d& place = of.corners[c];
        for (const std::size_t t : by.triangles) {
          const double s = meet(place, faces.normals[t], faces, t);
          if (s == kFar) continue;
          const Vec3d on_face = place + s * faces.normals[t];
          take(of_a ? place : on_face, of_a ? on_face : place, true);
        }
      }
    }
  };
  overFaces(a, near_a, b, near_b, true);
  overFaces(b, near_b, a, near_a, false);
  for (const std::size_t i : near_a.edges) {
    const Vec3d &p = a.corners[a.edges[i].from], u = a.corners[a.edges[i].to] - p;
    for (const std::size_t j : near_b.edges) {
      const Vec3d &q = b.corners[b.edges[j].from], v = b.corners[b.edges[j].to] - q;
      const Vec3d across = cross(u, v);
      if (norm(across) > 1e-12 * norm(u) * norm(v)) {
        const Crossing c = crossEdges(p, u, q, v, across);
        if (c.isOn()) take(p + c.s * u, q + c.t * v, true);
      }
      const auto toLine = [&](const Vec3d& place, const Vec3d& from, const Vec3d& way) {
        return from + std::clamp(dot(place - from, way) / dot(way, way), 0.0, 1.0) * way;
      };
      for (const Vec3d& end : {p, p + u}) take(end, toLine(end, q, v), false);
      for (const Vec3d& end : {q, q + v}) take(toLine(end, p, u), end, false);
    }
  }
  return least;
}

}  // namespace

PlacedMesh::PlacedMesh(const Surface& surface, const btTransform& at) {
  for (const auto& v : surface.vertices) {
    const btVector3 corner = at * btVector3(v[0], v[1], v[2]);
    corners.push_back({corner.x(), corner.y(), corner.z()});
  }
  std::map<std::pair<int, int>, std::size_t> known;
  for (const auto& t : surface.triangles) {
    triangles.push_back({int(t[0]), int(t[1]), int(t[2])});
    normals.push_back(unit(cross(corners[t[1]] - corners[t[0]], corners[t[2]] - corners[t[0]])));
    for (int k = 0; k < 3; ++k) {
      const std::pair<int, int> ends = std::minmax(int(t[k]), int(t[(k + 1) % 3]));
      const auto [edge, is_new] = known.try_emplace(ends, normals.size() - 1);
      if (is_new) continue;
      const bool sharp = norm(cross(normals[edge->second], normals.back())) > kFlat;
      edges.push_back({ends.first, ends.second, sharp});
    }
  }
}

void PlacedMesh::move(const Vec3d& by) {
  for (Vec3d& c : corners) c = c + by;
}

std::optional<Touch> firstTouch(const PlacedMesh& a, const PlacedMesh& b, const Vec3d& direction) {
  Touch first{kFar, {}};
  const auto take = [&](double way, const Vec3d& normal) {
    if (way < first.way) first = {way, dot(normal, direction) < 0 ? -1.0 * normal : normal};
  };
  for (const Vec3d& c : a.corners) {
    for (std::size_t t = 0; t < b.triangles.size(); ++t) take(meet(c, direction, b, t), b.normals[t]);
  }
  for (const Vec3d& c : b.corners) {
    for (std::size_t t = 0; t < a.triangles.size(); ++t) take(meet(c, -1.0 * direction, a, t), a.normals[t]);
  }
  for (const PlacedMesh::Edge& e : a.edges) {
    const Vec3d &p = a.corners[e.from], u = a.corners[e.to] - p;
    for (const PlacedMesh::Edge& f : b.edges) {
      if (!e.sharp || !f.sharp) continue;
      const Vec3d &q = b.corners[f.from], v = b.corners[f.to] - q;
      const Vec3d across = cross(u, v);
      const double along = dot(across, direction);
      if (std::fabs(along) < kParallel * norm(u) * norm(v)) continue;
      const double way = dot(q - p, across) / along;
      if (crossEdges(p + way * direction, u, q, v, across).isOn()) take(way, unit(across));
    }
  }
  if (first.way == kFar) return std::nullopt;
  return first;
}

std::optional<LocalOverlap> localOverlap(const PlacedMesh& a, const PlacedMesh& b, double around) {
  const Near all_a = allOf(a), all_b = allOf(b);
  const std::vector<Pierced> found = piercedOf(a, all_a, b, all_b);
  if (found.empty()) {
    const Apart apart = apartOf(a, all_a, b, all_b);
    if (!apart.regular) return std::nullopt;
    return LocalOverlap{-apart.distance, unit(apart.on_b - apart.on_a), apart.on_b};
  }
  if (!areOne(a, b, found)) return std::nullopt;

  Vec3d min = found[0].at, max = min;
  for (const Pierced& p : found) {
    for (int k = 0; k < 3; ++k) {
      min[k] = std::min(min[k], p.at[k]);
      max[k] = std::max(max[k], p.at[k]);
    }
  }
  const Vec3d margin{around, around, around};
  const Near near_a = partOf(a, min - margin, max + margin), near_b = partOf(b, min - margin, max + margin);
  PlacedMesh moved = a;
  const auto isOut = [&](const Vec3d& normal, double way) {
    for (std::size_t i = 0; i < a.corners.size(); ++i) moved.corners[i] = a.corners[i] - way * normal;
    return piercedOf(moved, near_a, b, near_b).empty();
  };
  LocalOverlap least{around, {}, {}};
  const auto tryAlong = [&](const Vec3d& normal) {
    if (!isOut(normal, least.depth - kTiny)) return;
    double low = 0, high = least.depth;
    while (high - low > kTiny / 10) {
      const double middle = (low + high) / 2;
      (isOut(normal, middle) ? high : low) = middle;
    }
    least.depth = high;
    least.normal = normal;
  };
  for (const std::size_t t : near_a.triangles) tryAlong(a.normals[t]);
  for (const std::size_t t : near_b.triangles) tryAlong(-1.0 * b.normals[t]);
  for (const std::size_t i : near_a.edges) {
    for (const std::size_t j : near_b.edges) {
      if (!a.edges[i].sharp || !b.edges[j].sharp) continue;
      const Vec3d u = a.corners[a.edges[i].to] - a.corners[a.edges[i].from];
      const Vec3d v = b.corners[b.edges[j].to] - b.corners[b.edges[j].from];
      const Vec3d across = cross(u, v);
      if (norm(across) < kParallel * norm(u) * norm(v)) continue;
      tryAlong(unit(across));
      tryAlong(-1.0 * unit(across));
    }
  }
  if (least.depth >= around) return std::nullopt;
  // Just out, they nearly touch in one place.
  isOut(least.normal, least.depth + kTiny);
  least.on_b = apartOf(moved, near_a, b, near_b).on_b;
  return least;
}

}  // namespace innersphere::test
