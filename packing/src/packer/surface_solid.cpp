#include "packer/surface_solid.hpp"

#include <utility>

#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"

namespace innersphere {

std::unique_ptr<Solid> solidOf(const Packing& packing) {
  if (packing.surface.triangles.empty())
    throw Error(ErrorCode::empty_input, "the packing has no surface, so nothing is known of its solid");
  Mesh mesh;
  for (const auto& v : packing.surface.vertices)
    mesh.vertices.push_back(packing.origin + Vec3d{v[0], v[1], v[2]});
  mesh.triangles = packing.surface.triangles;
  MeshOptions repair;
  repair.repair = true;  // single precision may have welded vertices
  return makeSolid(std::move(mesh), packing.provenance.source, repair);
}

}  // namespace innersphere
