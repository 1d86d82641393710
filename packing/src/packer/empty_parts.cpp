#include "packer/empty_parts.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "common/bounds.hpp"
#include "mesh/mass_properties.hpp"
#include "mesh/mesh_report.hpp"
#include "mesh/winding_tree.hpp"

namespace innersphere {
namespace {

constexpr std::size_t kNamed = 10;

struct Shell {
  Mesh mesh;  ///< every triangle with corners of its own
  Bounds box = emptyBounds();
  double volume = 0;  ///< negative for a cavity
};

void append(Mesh& mesh, const Mesh& more) {
  for (const auto& t : more.triangles) {
    std::array<std::uint32_t, 3> own;
    for (int k = 0; k < 3; ++k) {
      own[k] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(more.vertices[t[k]]);
    }
    mesh.triangles.push_back(own);
  }
}

/// Triangles that share vertices, in the order of their first triangles.
std::vector<Shell> shellsOf(const Mesh& surface) {
  std::vector<std::uint32_t> root(surface.vertices.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (const auto& t : surface.triangles) {
    root[find(t[1])] = find(t[0]);
    root[find(t[2])] = find(t[0]);
  }
  std::vector<std::optional<std::size_t>> shell_of(root.size());
  std::vector<Shell> shells;
  for (const auto& t : surface.triangles) {
    std::optional<std::size_t>& shell = shell_of[find(t[0])];
    if (!shell) {
      shell = shells.size();
      shells.emplace_back();
    }
    Mesh triangle{{}, {{0, 1, 2}}};
    for (std::uint32_t v : t) {
      triangle.vertices.push_back(surface.vertices[v]);
      extend(shells[*shell].box, triangle.vertices.back());
    }
    append(shells[*shell].mesh, triangle);
  }
  for (Shell& shell : shells) shell.volume = momentsOf(shell.mesh).volume;
  return shells;
}

/// Whether a sphere lies between shell `number` and the cavities in it.
bool isFilled(const std::vector<Shell>& shells, std::size_t number, const Packing& packing) {
  const Bounds& box = shells[number].box;
  Mesh mesh = shells[number].mesh;
  for (const Shell& other : shells) {
    if (other.volume < 0 && holds(box, other.box)) append(mesh, other.mesh);
  }
  const WindingTree winding(mesh);
  return std::any_of(packing.spheres.begin(), packing.spheres.end(), [&](const Sphere& s) {
    const Vec3d centre = packing.origin + Vec3d{s.x, s.y, s.z};
    return holds(box, centre) && winding.windingNumber(centre) > 0.5;
  });
}

}  // namespace

std::vector<std::string> nameEmptyParts(const Mesh& surface, const Packing& packing) {
  const std::vector<Shell> shells = shellsOf(surface);
  const auto parts = static_cast<std::size_t>(
      std::count_if(shells.begin(), shells.end(), [](const Shell& s) { return s.volume > 0; }));
  std::vector<std::string> sentences;
  if (parts < 2) return sentences;
  std::size_t part = 0, empty = 0;
  for (std::size_t i = 0; i < shells.size(); ++i) {
    if (!(shells[i].volume > 0)) continue;
    ++part;
    if (isFilled(shells, i, packing)) continue;
    if (++empty > kNamed) continue;
    sentences.push_back("part " + std::to_string(part) + " of " + std::to_string(parts) + ", " +
                        text(diagonal(shells[i].box)) + " m large near " + text(centre(shells[i].box)) +
                        ", got no sphere, so nothing collides with it; use more spheres or a smaller radius");
  }
  if (empty > kNamed) sentences.push_back(counted(empty - kNamed, "more part") + " got no sphere");
  return sentences;
}

}  // namespace innersphere
