#include "mesh/mesh_shells.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/bounds.hpp"
#include "mesh/mass_properties.hpp"
#include "mesh/mesh_clean.hpp"
#include "mesh/mesh_cuts.hpp"
#include "mesh/winding_tree.hpp"

namespace innersphere {
namespace {

struct Shell {
  Mesh mesh;
  Bounds box = emptyBounds();
  int facing = 0;                   ///< 1 outwards, -1 inwards
  std::vector<std::size_t> around;  ///< shells that this one is inside of
};

std::vector<Shell> splitShells(const Mesh& mesh, const Topology& topology) {
  std::vector<Shell> shells(topology.shells);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    shells[topology.shell[t]].mesh.triangles.push_back(mesh.triangles[t]);
  }
  std::vector<std::size_t> owner(mesh.vertices.size(), shells.size());
  std::vector<std::uint32_t> number(mesh.vertices.size());
  for (std::size_t i = 0; i < shells.size(); ++i) {
    Shell& shell = shells[i];
    for (auto& t : shell.mesh.triangles) {
      for (std::uint32_t& v : t) {
        if (owner[v] != i) {
          owner[v] = i;
          number[v] = static_cast<std::uint32_t>(shell.mesh.vertices.size());
          shell.mesh.vertices.push_back(mesh.vertices[v]);
          extend(shell.box, mesh.vertices[v]);
        }
        v = number[v];
      }
    }
    shell.facing = momentsOf(shell.mesh).volume < 0 ? -1 : 1;
  }
  return shells;
}

bool isInside(const Shell& inner, const Shell& outer) {
  if (!holds(outer.box, inner.box)) return false;
  const WindingTree tree(outer.mesh);
  for (const Vec3d& p : inner.mesh.vertices) {
    if (std::abs(tree.windingNumber(p)) < 0.5) return false;
  }
  return !cutEachOther(inner.mesh, outer.mesh);
}

bool boxesMeet(const std::vector<Shell>& shells) {
  const auto isAround = [&](std::size_t i, std::size_t j) {
    const auto& around = shells[i].around;
    return std::find(around.begin(), around.end(), j) != around.end();
  };
  for (std::size_t i = 0; i < shells.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (meet(shells[i].box, shells[j].box) && !isAround(i, j) && !isAround(j, i)) return true;
    }
  }
  return false;
}

/// The smallest of the shells that face outwards around this one; none if there is none.
std::optional<std::size_t> hostOf(const std::vector<Shell>& shells, std::size_t cavity) {
  std::optional<std::size_t> host;
  for (std::size_t i = 0; i < shells.size(); ++i) {
    if (shells[i].facing < 0 || (host && !holds(shells[*host].box, shells[i].box))) continue;
    if (isInside(shells[cavity], shells[i])) host = i;
  }
  return host;
}

}  // namespace

std::vector<Mesh> splitBodies(const Mesh& surface) {
  const std::vector<Shell> shells = splitShells(surface, topologyOf(surface));
  std::vector<Mesh> bodies;
  std::vector<std::size_t> number(shells.size());
  for (std::size_t i = 0; i < shells.size(); ++i) {
    if (shells[i].facing < 0) continue;
    number[i] = bodies.size();
    bodies.push_back(shells[i].mesh);
  }
  for (std::size_t i = 0; i < shells.size(); ++i) {
    if (shells[i].facing > 0) continue;
    if (const auto host = hostOf(shells, i)) append(bodies[number[*host]], shells[i].mesh);
  }
  return bodies;
}

ShellsReport orderShells(Mesh& mesh, const Topology& topology) {
  std::vector<Shell> shells = splitShells(mesh, topology);
  for (std::size_t i = 0; i < shells.size(); ++i) {
    for (std::size_t j = 0; j < shells.size(); ++j) {
      if (i != j && isInside(shells[i], shells[j])) shells[i].around.push_back(j);
    }
  }

  ShellsReport report;
  report.count = shells.size();
  report.boxes_meet = boxesMeet(shells);
  std::vector<bool> turn(shells.size());
  for (std::size_t i = 0; i < shells.size(); ++i) {
    const Shell& shell = shells[i];
    bool outermost_inwards = shell.around.empty() && shell.facing < 0;
    for (std::size_t j : shell.around) {
      outermost_inwards = outermost_inwards || (shells[j].around.empty() && shells[j].facing < 0);
    }
    turn[i] = outermost_inwards;
  }
  for (std::size_t i = 0; i < shells.size(); ++i) {
    if (!turn[i]) continue;
    shells[i].facing = -shells[i].facing;
    ++report.turned;
  }

  std::vector<bool> remove(shells.size());
  for (std::size_t i = 0; i < shells.size(); ++i) {
    int around = 0;
    for (std::size_t j : shells[i].around) around += shells[j].facing;
    const int inside = around + shells[i].facing;
    remove[i] = (around > 0) == (inside > 0);
    if (remove[i]) {
      ++report.removed;
    } else if (shells[i].facing < 0) {
      ++report.cavities;
    }
  }

  Mesh ordered;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::size_t shell = topology.shell[t];
    if (remove[shell]) continue;
    ordered.triangles.push_back(mesh.triangles[t]);
    if (turn[shell]) flip(ordered.triangles.back());
  }
  ordered.vertices = std::move(mesh.vertices);
  mesh = std::move(ordered);
  weldEqual(mesh);
  return report;
}

}  // namespace innersphere
