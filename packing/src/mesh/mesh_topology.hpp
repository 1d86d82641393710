// Finds out how the triangles of a mesh hang together.
#pragma once

#include <vector>

#include "innersphere/mesh.hpp"

namespace innersphere {

/// This is a side of a triangle, as the triangle runs along it.
struct HalfEdge {
  std::uint32_t from, to;
  std::uint32_t triangle;

  std::uint32_t low() const { return from < to ? from : to; }
  std::uint32_t high() const { return from < to ? to : from; }
};

/// Counts the edges of a mesh by how its triangles use them.
struct Topology {
  std::size_t open_edges = 0;
  std::size_t non_manifold_edges = 0;
  std::size_t flipped_edges = 0;
  /// The edges that are run along more often in one direction than in the other, once for each surplus. None
  /// is left where the mesh bounds a volume: only then is its winding number an integer everywhere.
  std::vector<HalfEdge> unbalanced;
  std::size_t loops = 0;             ///< connected sets of unbalanced edges
  std::vector<std::uint32_t> loop;   ///< of each unbalanced edge, 0 to loops - 1
  std::vector<std::uint32_t> shell;  ///< of each triangle, connected over edges
  std::size_t shells = 0;
};

/// Returns all half-edges, those of one edge together, otherwise in an order that depends on the mesh only.
std::vector<HalfEdge> sortedHalfEdges(const Mesh& mesh);

/// Returns the topology of a mesh.
Topology topologyOf(const Mesh& mesh);

/// Turns triangles so that neighbours wind alike, keeping the majority of each connected part. Returns how
/// many were turned; where that is impossible (a Moebius strip) flipped edges remain.
std::size_t orientAlike(Mesh& mesh);

}  // namespace innersphere
