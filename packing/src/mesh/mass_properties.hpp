// Finds volume, centre of mass and inertia of what a mesh encloses or a function says is inside.
#pragma once

#include <functional>

#include "innersphere/geometry.hpp"
#include "innersphere/mesh.hpp"

namespace innersphere {

/// Holds the moments of a region of unit density about `origin`: they add up over regions.
struct Moments {
  Vec3d origin{};
  double volume = 0;               ///< [m^3]
  Vec3d first{};                   ///< integral of x [m^4]
  std::array<double, 6> second{};  ///< integrals of xx, yy, zz, xy, yz, zx [m^5]

  /// Adds a box of this density.
  void addBox(const Bounds& box, double density);
  /// Adds moments about the same origin.
  void add(const Moments& other);
  /// Returns what a rigid body needs, with the inertia about the centre of mass.
  MassProperties massProperties() const;
};

/// Returns the integrals over a mesh by the divergence theorem, exact but for rounding, about the middle of
/// the mesh so that no digits are lost far from the origin. Of a mesh that is not closed the result means
/// nothing.
Moments momentsOf(const Mesh& mesh);

/// Tells what a function is at a point, and how far around it keeps that value.
struct Probe {
  double value = 0;
  double constant_within = 0;  ///< [m]
};

/// Integrates a piecewise constant function over `box`: cells are halved until the function is constant in
/// them or they are 1 / resolution of the box's longest side (rounded down to a power of two), where the
/// middle decides. `probe` gets the middle of a cell, its half diagonal and its longest side.
Moments integrate(const Bounds& box, int resolution,
                  const std::function<Probe(const Vec3d& middle, double reach, double side)>& probe);

}  // namespace innersphere
