// Packs triangles in memory, and keeps the packing on disk so that the next start of a program reads it.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "innersphere/geometry.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing.hpp"
#include "innersphere/progress.hpp"

namespace innersphere {

/// Makes a mesh from arrays: three coordinates [m] a vertex, three indices a triangle, both without gaps.
/// Scalar is float or double, Index any integer type. Indices are not checked here, but by makeSolid().
template <typename Scalar, typename Index>
Mesh meshFrom(const Scalar* coordinates, std::size_t vertex_count, const Index* indices,
              std::size_t triangle_count) {
  Mesh mesh;
  mesh.vertices.resize(vertex_count);
  mesh.triangles.resize(triangle_count);
  for (std::size_t i = 0; i < 3 * vertex_count; ++i) mesh.vertices[i / 3][i % 3] = double(coordinates[i]);
  for (std::size_t i = 0; i < 3 * triangle_count; ++i)
    mesh.triangles[i / 3][i % 3] = static_cast<std::uint32_t>(indices[i]);
  return mesh;
}

/// Returns what a simulation needs of a packing when it starts: `spheres` of them. 256 are enough for
/// contacts, whose depth is measured on the surface; overlap volumes and solids with thin walls need
/// thousands. Errors of overlap volumes are not measured, which halves the time: BoundedOverlap::error is NaN
/// for such packings.
PackOptions startUpOptions(std::size_t spheres = 256);

/// Says how packMesh() packs, and where it keeps the result.
struct PackMeshOptions {
  /// When to stop, and how greedy to be; startUpOptions() by default.
  PackOptions pack = startUpOptions();
  /// Whether a mesh is accepted that does not bound a volume, see MeshOptions::repair. Off by default: such a
  /// mesh is an Error.
  bool repair = false;
  /// The folder of the cache; it is made where there is none. Files in it are never deleted by InnerSphere
  /// and may be deleted at any time. Empty, the default: every call packs. defaultCacheFolder() names a good
  /// place.
  std::string cache_folder;
  /// Receives one sentence, without a line break, for everything that is wrong with the cache: a damaged
  /// file, a folder that cannot be written to. None of these is an error: the mesh is packed, only the time
  /// is lost, in the next start too. Null, the default, writes to the standard error stream.
  std::function<void(const std::string& message)> notice;
};

/// Packs a mesh: makeSolid() and pack(). What makeSolid() mended comes first in the packing's warnings.
///
/// With a cache folder the function reads the packing from there if the same mesh has been packed with the
/// same options by the same version of InnerSphere. The mesh counts by its numbers, bit for bit, in their
/// order; `name` and the number of threads do not count. A file that is damaged or belongs to other input is
/// replaced. A file appears under its name only when it is complete, so any number of processes can share a
/// folder. A packing from the cache has the same bits as one that was just packed.
///
/// `name` stands for the mesh in messages and in the packing's provenance. Throws Error: what makeSolid() and
/// pack() throw.
Packing packMesh(const Mesh& mesh, const std::string& name, const PackMeshOptions& options = {},
                 const Progress& progress = {});

/// Returns $XDG_CACHE_HOME/innersphere, or else $HOME/.cache/innersphere. Returns an empty string, which is
/// no cache, if neither variable is set.
std::string defaultCacheFolder();

}  // namespace innersphere
