#include "innersphere/bullet_mesh.hpp"

#include <cstring>

#include "innersphere/error.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// The arrays of a sub-part for as long as it lives.
class Part {
 public:
  Part(const btStridingMeshInterface& triangles, int index) : triangles_(triangles), index_(index) {
    triangles_.getLockedReadOnlyVertexIndexBase(&vertices_, vertex_count_, scalar_, vertex_stride_, &indices_,
                                                index_stride_, triangle_count_, index_type_, index_);
  }
  ~Part() { triangles_.unLockReadOnlyVertexBase(index_); }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  void appendTo(Mesh& mesh) const {
    if (vertex_count_ < 0 || triangle_count_ < 0 || (vertex_count_ > 0 && vertices_ == nullptr) ||
        (triangle_count_ > 0 && indices_ == nullptr))
      fail("has no arrays");
    const std::size_t first = mesh.vertices.size();
    const btVector3& scaling = triangles_.getScaling();
    for (int v = 0; v < vertex_count_; ++v) {
      Vec3d& vertex = mesh.vertices.emplace_back();
      for (int k = 0; k < 3; ++k) vertex[k] = coordinate(v, k) * double(scaling[k]);
    }
    for (int t = 0; t < triangle_count_; ++t) {
      auto& triangle = mesh.triangles.emplace_back();
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t vertex = indexOf(t, k);
        if (vertex >= static_cast<std::uint32_t>(vertex_count_))
          fail("has a triangle with vertex " + std::to_string(vertex) + ", but only " +
               std::to_string(vertex_count_) + " vertices");
        triangle[k] = static_cast<std::uint32_t>(first + vertex);
      }
    }
  }

 private:
  double coordinate(int vertex, int k) const {
    const unsigned char* at = vertices_ + std::ptrdiff_t(vertex) * vertex_stride_;
    if (scalar_ == PHY_FLOAT) return read<float>(at, k);
    if (scalar_ == PHY_DOUBLE) return read<double>(at, k);
    fail("has vertices that are neither PHY_FLOAT nor PHY_DOUBLE");
  }

  std::uint32_t indexOf(int triangle, int k) const {
    const unsigned char* at = indices_ + std::ptrdiff_t(triangle) * index_stride_;
    if (index_type_ == PHY_INTEGER) return read<std::uint32_t>(at, k);
    if (index_type_ == PHY_SHORT) return read<std::uint16_t>(at, k);
    if (index_type_ == PHY_UCHAR) return read<std::uint8_t>(at, k);
    fail("has indices that are none of PHY_INTEGER, PHY_SHORT and PHY_UCHAR");
  }

  /// Strides may leave it anywhere in memory.
  template <typename T>
  static T read(const unsigned char* at, int k) {
    T value;
    std::memcpy(&value, at + std::size_t(k) * sizeof(T), sizeof(T));
    return value;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::bad_argument, "Sub-part " + std::to_string(index_) + " of the triangles " + what +
                                             "; check what the mesh interface was given.");
  }

  const btStridingMeshInterface& triangles_;
  const int index_;
  const unsigned char* vertices_ = nullptr;
  const unsigned char* indices_ = nullptr;
  int vertex_count_ = 0, vertex_stride_ = 0, triangle_count_ = 0, index_stride_ = 0;
  PHY_ScalarType scalar_ = PHY_FLOAT, index_type_ = PHY_INTEGER;
};

}  // namespace

Mesh meshFrom(const btStridingMeshInterface& triangles) {
  Mesh mesh;
  for (int part = 0; part < triangles.getNumSubParts(); ++part) Part(triangles, part).appendTo(mesh);
  return mesh;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
