#include "mesh/mesh_topology.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "mesh/mesh_clean.hpp"

namespace innersphere {
namespace {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // The lower root wins, so that the result does not depend on the order of joining.
  void join(std::uint32_t i, std::uint32_t j) {
    i = find(i);
    j = find(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

// Calls visit(first, last) for the half-edges of each edge.
template <class Visit>
void forEachEdge(const std::vector<HalfEdge>& half_edges, const Visit& visit) {
  for (auto first = half_edges.begin(); first != half_edges.end();) {
    auto last = first;
    while (last != half_edges.end() && last->low() == first->low() && last->high() == first->high()) ++last;
    visit(first, last);
    first = last;
  }
}

// Numbers the sets of `items` from 0 in the order of the items.
std::size_t numberSets(DisjointSets& sets, const std::vector<std::uint32_t>& items, std::size_t universe,
                       std::vector<std::uint32_t>& number) {
  std::vector<std::uint32_t> name(universe, UINT32_MAX);
  std::uint32_t count = 0;
  number.clear();
  for (std::uint32_t item : items) {
    std::uint32_t& n = name[sets.find(item)];
    if (n == UINT32_MAX) n = count++;
    number.push_back(n);
  }
  return count;
}

}  // namespace

std::vector<HalfEdge> sortedHalfEdges(const Mesh& mesh) {
  // Where those of each lower vertex begin.
  std::vector<std::uint32_t> begin(mesh.vertices.size() + 1);
  for (const auto& v : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++begin[std::min(v[k], v[(k + 1) % 3]) + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<HalfEdge> half_edges(3 * mesh.triangles.size());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const HalfEdge e{v[k], v[(k + 1) % 3], t};
      half_edges[next[e.low()]++] = e;
    }
  }
  for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
    std::sort(half_edges.begin() + begin[v], half_edges.begin() + begin[v + 1],
              [](const HalfEdge& a, const HalfEdge& b) {
                return std::pair(a.high(), a.triangle) < std::pair(b.high(), b.triangle);
              });
  }
  return half_edges;
}

Topology topologyOf(const Mesh& mesh) {
  Topology result;
  DisjointSets shells(mesh.triangles.size());
  DisjointSets loops(mesh.vertices.size());
  forEachEdge(sortedHalfEdges(mesh), [&](auto first, auto last) {
    const auto uses = last - first;
    const auto forward = std::count_if(first, last, [](const HalfEdge& e) { return e.from < e.to; });
    if (uses == 1) ++result.open_edges;
    if (uses == 2 && forward != 1) ++result.flipped_edges;
    if (uses > 2) ++result.non_manifold_edges;
    for (auto e = first; e != last; ++e) shells.join(first->triangle, e->triangle);

    auto surplus = 2 * forward - uses;
    for (auto e = first; e != last && surplus != 0; ++e) {
      const bool is_forward = e->from < e->to;
      if (is_forward != (surplus > 0)) continue;
      result.unbalanced.push_back(*e);
      loops.join(e->from, e->to);
      surplus += surplus > 0 ? -1 : 1;
    }
  });

  std::vector<std::uint32_t> items(mesh.triangles.size());
  std::iota(items.begin(), items.end(), 0u);
  result.shells = numberSets(shells, items, items.size(), result.shell);
  items.clear();
  for (const HalfEdge& e : result.unbalanced) items.push_back(e.from);
  result.loops = numberSets(loops, items, mesh.vertices.size(), result.loop);
  return result;
}

std::size_t orientAlike(Mesh& mesh) {
  struct Neighbour {
    std::uint32_t triangle;
    bool alike;
  };
  std::vector<std::vector<Neighbour>> neighbours(mesh.triangles.size());
  forEachEdge(sortedHalfEdges(mesh), [&](auto first, auto last) {
    if (last - first != 2) return;
    const HalfEdge a = first[0], b = first[1];
    const bool alike = a.from == b.to;
    neighbours[a.triangle].push_back({b.triangle, alike});
    neighbours[b.triangle].push_back({a.triangle, alike});
  });

  constexpr std::uint8_t unseen = 0, kept = 1, turned = 2;
  std::vector<std::uint8_t> state(mesh.triangles.size(), unseen);
  std::size_t changed = 0;
  for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (state[seed] != unseen) continue;
    state[seed] = kept;
    std::vector<std::uint32_t> part{seed};
    for (std::size_t i = 0; i < part.size(); ++i) {
      const std::uint32_t t = part[i];
      for (const Neighbour& n : neighbours[t]) {
        if (state[n.triangle] != unseen) continue;
        state[n.triangle] = n.alike ? state[t] : kept + turned - state[t];
        part.push_back(n.triangle);
      }
    }
    const auto minority =
        2 * std::count_if(part.begin(), part.end(), [&](std::uint32_t t) { return state[t] == turned; }) >
                static_cast<std::ptrdiff_t>(part.size())
            ? kept
            : turned;
    for (std::uint32_t t : part) {
      if (state[t] != minority) continue;
      flip(mesh.triangles[t]);
      ++changed;
    }
  }
  return changed;
}

}  // namespace innersphere
