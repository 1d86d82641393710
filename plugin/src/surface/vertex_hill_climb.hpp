// Finds the corners of a triangulated surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <LinearMath/btVector3.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/geometry.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Walks from triangle to triangle. The surface must outlive it. Const members are safe to call from several
/// threads at once.
class VertexHillClimb {
 public:
  explicit VertexHillClimb(const Surface& surface);

  /// Appends the vertex that is furthest along `direction` (unit) among its neighbours, uphill from a
  /// triangle and no further than `max_distance` from `start`, and the other ends of edges that are level
  /// with it, wherever they are: those of an edge that lies on a face, say. Appends nothing and returns false
  /// if no vertex is near. Else it returns true if the surface does not rise on beyond `max_distance`.
  bool from(std::size_t triangle, const btVector3& direction, const btVector3& start, btScalar max_distance,
            std::vector<std::uint32_t>& vertices) const;

  /// Returns the triangles around a vertex.
  std::span<const std::uint32_t> around(std::uint32_t vertex) const {
    return {around_.data() + first_[vertex], around_.data() + first_[vertex + 1]};
  }

 private:
  const Surface& surface_;
  std::vector<std::uint32_t> first_;  ///< triangles around vertex v: around_[first_[v]] to first_[v + 1]
  std::vector<std::uint32_t> around_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
