#include "packer/empty_parts.hpp"

#include <algorithm>

#include "common/bounds.hpp"
#include "innersphere/mesh.hpp"
#include "mesh/mesh_report.hpp"
#include "mesh/winding_tree.hpp"

namespace innersphere {
namespace {

constexpr std::size_t kNamed = 10;

bool isFilled(const Mesh& body, const Packing& packing) {
  const Bounds box = boundsOf(body);
  const WindingTree winding(body);
  return std::any_of(packing.spheres.begin(), packing.spheres.end(), [&](const Sphere& s) {
    const Vec3d centre = packing.origin + Vec3d{s.x, s.y, s.z};
    return holds(box, centre) && winding.windingNumber(centre) > 0.5;
  });
}

}  // namespace

std::vector<std::string> nameEmptyParts(const Mesh& surface, const Packing& packing) {
  const std::vector<Mesh> bodies = splitBodies(surface);
  std::vector<std::string> sentences;
  if (bodies.size() < 2) return sentences;
  std::size_t empty = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (isFilled(bodies[i], packing)) continue;
    if (++empty > kNamed) continue;
    const Bounds box = boundsOf(bodies[i]);
    sentences.push_back(
        "part " + std::to_string(i + 1) + " of " + std::to_string(bodies.size()) + ", " +
        text(diagonal(box)) + " m large near " + text(centre(box)) +
        ", got no sphere: volumes and contacts by volume leave it out, contacts by the triangles feel "
        "it; use more spheres or a smaller radius");
  }
  if (empty > kNamed) sentences.push_back(counted(empty - kNamed, "more part") + " got no sphere");
  return sentences;
}

}  // namespace innersphere
