// Reads and judges a user's triangle mesh, mends it where that is safe, and turns it into a solid.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "innersphere/geometry.hpp"
#include "innersphere/solid.hpp"

namespace innersphere {

/// Says how meshes are read and judged.
struct MeshOptions {
  /// The factor by which readMesh() multiplies all coordinates: 0.001 for a file in millimetres. It must be
  /// positive. makeSolid() uses it only to see whether coordinates came in single precision.
  double scale = 1;
  /// Whether makeSolid() accepts a mesh that does not bound a volume. Vertices on open edges that are within
  /// 1e-4 of the diagonal are then welded, within less if that closes the mesh: a mesh whose triangles share
  /// no vertices, or was written with few digits. Of what is open still, a rim around one other in its plane,
  /// as at the end of a pipe, is closed with a ring, any other with a flat fan. A point is inside where the
  /// winding number exceeds 1/2. Distances near a hole are to what closes it, so the fill is only as good as
  /// that guess.
  bool repair = false;
  /// Whether readMesh() lets assimp work in a forked child process of its own, which may take 1 GB of memory,
  /// and 4 s and a second more for each megabyte of the file: a file that makes assimp crash or hang is then
  /// an error. OBJ, STL, PLY and OFF need none. False where a program must not fork: such a file then ends
  /// the program. If another thread holds a lock of the C or C++ library while the child is made, the child
  /// may wait for it in vain until its time is over; calling again helps.
  bool own_process = true;
};

/// Tells what was found in a mesh.
struct MeshReport {
  std::size_t vertices = 0;    ///< The number of vertices after equal positions were welded.
  std::size_t triangles = 0;   ///< The number of triangles without the degenerate ones.
  std::size_t degenerate = 0;  ///< The number of triangles with two equal corners, which were removed.
  /// The number of triangles with the corners of an earlier one, which were removed.
  std::size_t duplicates = 0;
  std::size_t open_edges = 0;          ///< The number of edges that only one triangle uses.
  std::size_t open_loops = 0;          ///< The number of connected chains of open edges.
  Vec3d open_at{};                     ///< A corner of the longest chain of open edges [m].
  std::size_t non_manifold_edges = 0;  ///< The number of edges that more than two triangles use.
  std::size_t flipped_edges = 0;       ///< The number of edges whose two triangles wind in opposite senses.
  std::size_t cuts = 0;                ///< The number of pairs of triangles that pass through each other.
  Vec3d cut_at{};                      ///< A corner of such a triangle [m].
  std::size_t components = 0;          ///< The number of components that are connected over edges.
  bool inside_out = false;         ///< Whether the volume was negative, so that all triangles were flipped.
  Bounds bounds;                   ///< The box around all vertices [m].
  std::vector<std::string> notes;  ///< A sentence for each thing that was mended or looks suspicious.
};

/// Reads a mesh and welds equal positions. The ending of the path names the format. OBJ, STL, PLY and OFF, as
/// text or binary, are read by checked readers of the project, in double: memory and time follow from the
/// size of the file, whatever it says. They may be compressed by gzip (.obj.gz), to at most 1 GiB. All
/// other formats (glTF, ...) go through assimp, with node transforms
/// applied in double; assimp keeps coordinates in single precision: what is far from its origin is read
/// coarsely, and makeSolid() notes it. Polygons are cut into triangles along their dents. Throws Error, with
/// the line or the byte where the file has one: file_not_found, bad_format, empty_input, not_finite (also for
/// numbers beyond single precision), bad_argument (the scale). COLLADA and 3MF files name their unit,
/// millimetres in most 3MF files: they come in metres, times the scale. `notes` may be null; it gets a
/// sentence for what was left out, bytes behind the last triangle of a binary STL file, and for the unit of a
/// 3MF file if that is not metres.
Mesh readMesh(const std::string& path, const MeshOptions& options = {},
              std::vector<std::string>* notes = nullptr);

/// Judges a mesh and makes it a solid with exact distances. It mends what is safe and notes it: it welds
/// equal positions, and within 1e-7 of the diagonal those on open edges; it drops
/// degenerate triangles and those that are there twice, winds triangles like their neighbours, turns shells
/// that are inside-out, and drops shells inside solid material that face outwards. A shell inside another
/// that faces inwards stays: a cavity. Shells may cut themselves and each other: inside is where the winding
/// number exceeds 1/2, mass properties count each point once (by sampling 64 cells along the longest side),
/// and distances are to the nearest triangle, so that spheres keep away from inner ones too.
///
/// Throws Error: not_a_solid if the mesh does not bound a volume and repair was not asked for, with the
/// defect, its place and the way out; empty_input, not_finite, bad_argument (a triangle names a vertex that
/// is not there). `report` may be null; it is filled in also when not_a_solid is thrown.
std::unique_ptr<Solid> makeSolid(Mesh mesh, const std::string& name, const MeshOptions& options = {},
                                 MeshReport* report = nullptr);

/// Returns the bodies of a surface that a solid gives, in the order of their first triangles: each shell that
/// faces outwards, with the cavities right inside it. A file with several bodies is so packed body by body.
std::vector<Mesh> splitBodies(const Mesh& surface);

}  // namespace innersphere
