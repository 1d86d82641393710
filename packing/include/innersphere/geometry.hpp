// Declares plain value types that every part of InnerSphere exchanges. No library types appear here, so that
// a simulation can include the query and the plug-in without Eigen, assimp or CUDA.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "innersphere/vec3.hpp"

namespace innersphere {

/// This is a 3x3 matrix, row-major: element (i, j) is m[3 * i + j].
using Mat3d = std::array<double, 9>;

/// This is an axis-aligned box [m]. It is empty when min > max on any axis.
struct Bounds {
  Vec3d min{};  ///< The lower corner.
  Vec3d max{};  ///< The upper corner.
};

/// This is a ball in single precision: centre and radius [m], in the frame of its packing. It takes sixteen
/// bytes, so that a GPU thread reads it with one load.
struct alignas(16) Sphere {
  float x = 0;       ///< The centre, along x.
  float y = 0;       ///< The centre, along y.
  float z = 0;       ///< The centre, along z.
  float radius = 0;  ///< The radius.
};

/// Tells a rigid body what it needs to know of a homogeneous solid, for unit density: a body of density rho
/// has mass rho * volume and inertia rho * inertia.
struct MassProperties {
  double volume = 0;  ///< The volume [m^3].
  /// The centre of mass [m], in the frame of the solid or of the packing that holds this.
  Vec3d centre_of_mass{};
  Mat3d inertia{};  ///< The inertia [m^5] about the centre of mass, along the axes of the solid.
};

/// This is a triangle mesh in double precision: vertices [m], and three indices of vertices for each
/// triangle.
struct Mesh {
  std::vector<Vec3d> vertices;                          ///< The positions [m].
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices into vertices.
};

/// This is a closed triangle surface, wound counter-clockwise seen from outside. It serves drawing, ray tests
/// and convex sweeps, and gives the depth of contacts, which the spheres find.
struct Surface {
  std::vector<std::array<float, 3>> vertices;           ///< The vertices [m].
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices into vertices.
};

}  // namespace innersphere
