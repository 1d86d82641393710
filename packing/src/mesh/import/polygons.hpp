// Gathers the vertices and polygons of a file and makes triangles of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "innersphere/error.hpp"
#include "innersphere/geometry.hpp"

namespace innersphere {

/// Holds what a mesh file says, before its faces are looked at: they may name vertices that come later.
class Polygons {
 public:
  std::vector<Vec3d> vertices;

  /// Adds a vertex. The cursor fails, with its place, unless the vertex is finite in single precision too:
  /// that is what packings are stored in.
  template <class Cursor>
  void addVertex(const Vec3d& p, const Cursor& cursor) {
    const std::string fault = faultOf(p);
    if (!fault.empty()) cursor.fail(fault, ErrorCode::not_finite);
    vertices.push_back(p);
  }

  /// Adds a corner to the polygon that is being read: a vertex, counted from 0. The cursor fails if the
  /// number cannot be one.
  template <class Cursor>
  void addCorner(std::int64_t vertex, const Cursor& cursor) {
    if (vertex < 0 || vertex >= UINT32_MAX) cursor.fail("there is no vertex with the number of this corner");
    corners_.push_back(static_cast<std::uint32_t>(vertex));
  }
  /// Ends the polygon of the corners since the last one; `place` is its line or byte.
  void endFace(std::size_t place);

  /// Returns the triangles, in the order of the polygons. Polygons that are not convex are cut by their ears;
  /// one that crosses itself becomes a fan. A face of one or two corners becomes a triangle with equal ones.
  /// Throws Error bad_format: a face uses a vertex that is not there, with `unit` ("line", "byte") and place.
  Mesh triangulate(const std::string& path, const char* unit) &&;

 private:
  struct Face {
    std::size_t end;    // behind its last corner
    std::size_t place;  // in the file
  };

  std::string faultOf(const Vec3d& p) const;

  std::vector<std::uint32_t> corners_;
  std::vector<Face> faces_;
};

}  // namespace innersphere
