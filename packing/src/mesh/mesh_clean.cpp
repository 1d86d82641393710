#include "mesh/mesh_clean.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "common/bounds.hpp"

namespace innersphere {
namespace {

std::uint64_t mix(std::uint64_t h, std::uint64_t x) {
  h = (h ^ x) * 0x9e3779b97f4a7c15u;
  return h ^ (h >> 32);
}

struct HashPosition {
  std::size_t operator()(const Vec3d& p) const {
    std::uint64_t h = 0;
    for (double x : p) h = mix(h, std::bit_cast<std::uint64_t>(x + 0.0));  // -0 and 0 are equal
    return h;
  }
};

using Cell = std::array<std::int64_t, 3>;
struct HashCell {
  std::size_t operator()(const Cell& c) const {
    std::uint64_t h = 0;
    for (std::int64_t x : c) h = mix(h, static_cast<std::uint64_t>(x));
    return h;
  }
};

// Corners from the lowest on, in the triangle's sense or sorted.
std::array<std::uint32_t, 3> fromLowest(std::array<std::uint32_t, 3> t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}
std::array<std::uint32_t, 3> sorted(std::array<std::uint32_t, 3> t) {
  std::sort(t.begin(), t.end());
  return t;
}

struct HashCorners {
  std::size_t operator()(const std::array<std::uint32_t, 3>& t) const {
    return mix(mix(mix(0, t[0]), t[1]), t[2]);
  }
};

// Removes triangles with the same key as an earlier one.
template <class Key>
std::size_t dropEqual(Mesh& mesh, const Key& key) {
  std::unordered_set<std::array<std::uint32_t, 3>, HashCorners> seen;
  seen.reserve(mesh.triangles.size());
  return std::erase_if(mesh.triangles, [&](const auto& t) { return !seen.insert(key(t)).second; });
}

bool collapsed(const std::array<std::uint32_t, 3>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

// Replaces the corners by place(vertex), a number in a new list.
template <class Place>
void renumber(Mesh& mesh, const Place& place) {
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> done(mesh.vertices.size(), UINT32_MAX);
  for (auto& t : mesh.triangles) {
    for (std::uint32_t& v : t) {
      if (done[v] == UINT32_MAX) done[v] = place(v, vertices);
      v = done[v];
    }
  }
  mesh.vertices = std::move(vertices);
}

}  // namespace

void append(Mesh& mesh, const Mesh& more) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& t : more.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

void flip(std::array<std::uint32_t, 3>& triangle) {
  std::swap(triangle[1], triangle[2]);
}

void weldEqual(Mesh& mesh) {
  std::unordered_map<Vec3d, std::uint32_t, HashPosition> known;
  known.reserve(mesh.vertices.size());
  renumber(mesh, [&](std::uint32_t v, std::vector<Vec3d>& vertices) {
    const Vec3d& p = mesh.vertices[v];
    const auto [entry, added] = known.try_emplace(p, static_cast<std::uint32_t>(vertices.size()));
    if (added) vertices.push_back(p);
    return entry->second;
  });
}

std::size_t weldClose(Mesh& mesh, const std::vector<bool>& open, double tolerance) {
  const std::size_t before = mesh.vertices.size();
  const Vec3d origin = mesh.vertices.empty() ? Vec3d{} : mesh.vertices.front();
  std::unordered_multimap<Cell, std::uint32_t, HashCell> cells;
  renumber(mesh, [&](std::uint32_t v, std::vector<Vec3d>& vertices) {
    const Vec3d& p = mesh.vertices[v];
    const auto added = static_cast<std::uint32_t>(vertices.size());
    if (!open[v]) {
      vertices.push_back(p);
      return added;
    }
    Cell home;
    for (int k = 0; k < 3; ++k) home[k] = std::llround((p[k] - origin[k]) / tolerance);
    std::uint32_t nearest = UINT32_MAX;
    for (int n = 0; n < 27; ++n) {
      const Cell cell{home[0] + n % 3 - 1, home[1] + n / 3 % 3 - 1, home[2] + n / 9 - 1};
      const auto [first, last] = cells.equal_range(cell);
      for (auto i = first; i != last; ++i) {
        if (norm(vertices[i->second] - p) <= tolerance) nearest = std::min(nearest, i->second);
      }
    }
    if (nearest != UINT32_MAX) return nearest;
    vertices.push_back(p);
    cells.emplace(home, added);
    return added;
  });
  return before - mesh.vertices.size();
}

std::size_t dropCollapsed(Mesh& mesh) {
  return std::erase_if(mesh.triangles, collapsed);
}

std::size_t dropRepeated(Mesh& mesh) {
  return dropEqual(mesh, fromLowest);
}

std::size_t dropTwins(Mesh& mesh) {
  return dropEqual(mesh, sorted);
}

std::size_t dropFlat(Mesh& mesh) {
  return std::erase_if(mesh.triangles, [&](const std::array<std::uint32_t, 3>& t) {
    const Vec3d& a = mesh.vertices[t[0]];
    const Vec3d n = cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
    return dot(n, n) == 0;
  });
}

}  // namespace innersphere
