// A user's triangle mesh: read, judged, mended where that is safe, and turned into a solid.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "innersphere/geometry.hpp"
#include "innersphere/solid.hpp"

namespace innersphere {

/// Vertices [m] and triangles, in double.
struct Mesh {
  std::vector<Vec3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct MeshOptions {
  double scale = 1;     ///< multiplies all coordinates: 0.001 for a file in millimetres
  bool repair = false;  ///< pack a mesh that does not bound a volume anyway: inside is where the winding number exceeds 1/2
};

/// What was found in a mesh.
struct MeshReport {
  std::size_t vertices = 0;             ///< after welding equal positions
  std::size_t triangles = 0;            ///< after removing degenerate ones
  std::size_t degenerate = 0;           ///< removed: two equal corners or no area
  std::size_t open_edges = 0;           ///< used by one triangle only
  std::size_t open_loops = 0;           ///< closed chains of open edges
  Vec3d open_at{};                      ///< somewhere on the longest of them
  std::size_t non_manifold_edges = 0;   ///< used by more than two triangles
  std::size_t flipped_edges = 0;        ///< whose two triangles wind in opposite senses
  std::size_t components = 0;
  bool inside_out = false;              ///< negative volume: all triangles were flipped
  Bounds bounds;
  std::vector<std::string> notes;       ///< one sentence for each thing that was mended or looks suspicious
};

/// Reads a mesh through assimp (OBJ, STL, PLY, OFF, glTF, ...), with node transforms applied in double and equal positions
/// welded. Throws Error: file_not_found, bad_format, empty_input, not_finite.
Mesh readMesh(const std::string& path, const MeshOptions& options = {});

/// Judges a mesh, mends what is safe (welds, drops degenerate triangles, turns an inside-out mesh), and makes it a solid
/// with exact distances. Throws Error not_a_solid if it does not bound a volume and repair was not asked for; the message
/// names the defect, its place and the way out. `report` may be null.
std::unique_ptr<Solid> makeSolid(Mesh mesh, const std::string& name, const MeshOptions& options = {},
                                 MeshReport* report = nullptr);

}  // namespace innersphere
