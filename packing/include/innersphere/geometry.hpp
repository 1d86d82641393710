// Plain value types that every part of InnerSphere exchanges. No library types appear here, so that a
// simulation can include the query and the plug-in without Eigen, assimp or CUDA.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace innersphere {

/// A point or vector [m]: x, y, z.
using Vec3d = std::array<double, 3>;

/// A 3x3 matrix, row-major: element (i, j) is m[3 * i + j].
using Mat3d = std::array<double, 9>;

/// An axis-aligned box [m]. Empty when min > max on any axis.
struct Bounds {
  Vec3d min{};  ///< The lower corner.
  Vec3d max{};  ///< The upper corner.
};

/// A ball in single precision: centre and radius [m], in the frame of its packing. Sixteen bytes, so that a
/// GPU thread reads it with one load.
struct alignas(16) Sphere {
  float x = 0;       ///< The centre, along x.
  float y = 0;       ///< The centre, along y.
  float z = 0;       ///< The centre, along z.
  float radius = 0;  ///< The radius.
};

/// What a rigid body needs to know of a homogeneous solid, for unit density: a body of density rho has mass
/// rho * volume and inertia rho * inertia.
struct MassProperties {
  double volume = 0;       ///< [m^3]
  Vec3d centre_of_mass{};  ///< [m], in the frame of the solid, or of the packing that holds this
  Mat3d inertia{};         ///< [m^5] about the centre of mass, along the axes of the solid
};

/// Vertices [m] and triangles, in double.
struct Mesh {
  std::vector<Vec3d> vertices;                          ///< Places [m].
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices into vertices.
};

/// A closed triangle surface, wound counter-clockwise seen from outside. It serves drawing, ray tests and
/// convex sweeps; collisions are decided by the spheres.
struct Surface {
  std::vector<std::array<float, 3>> vertices;           ///< [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into vertices
};

}  // namespace innersphere
