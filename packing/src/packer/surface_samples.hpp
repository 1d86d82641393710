// Samples points on the surface, to see how near the spheres come to it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "innersphere/packing.hpp"
#include "packer/container.hpp"
#include "packer/sphere_grid.hpp"

namespace innersphere {

/// Holds points spread over a triangle surface, equally dense everywhere and the same on every run.
class SurfaceSamples {
 public:
  /// Samples a surface in metres; there are no points if it has no area.
  SurfaceSamples(const Mesh& surface, const Container& container);

  bool empty() const { return points_.empty(); }
  const std::vector<Point>& points() const { return points_; }
  const std::vector<Point>& inwards() const { return inwards_; }  ///< unit normals at the points

  /// Returns true if a ball of this radius lies in the solid and touches its surface at one of the points.
  bool touchedByBall(const Container& container, double radius) const;

  /// Returns true if no point is farther than `gap` from a ball. Starts at point `first` and moves it to the
  /// first that is too far, so that asking again after more balls were added costs little.
  bool covered(const SphereGrid& grid, double gap, std::size_t& first) const;

  /// Returns how many of the first balls leave no point farther than `gap` from a ball; nothing if all
  /// together do not.
  std::optional<std::size_t> prefixWithin(const SphereGrid& grid, double gap) const;

  /// Returns how near prefixes of the balls come to the points, in units of the unit cube: for each of
  /// `counts`, which rise, the distances' mean, 95th percentile and maximum, and the part of the points that
  /// is farther than `distance`. Runs in the current TBB arena.
  std::vector<Coverage> coverage(std::span<const Ball> balls, std::span<const std::size_t> counts,
                                 double distance) const;

 private:
  std::vector<Point> points_;
  std::vector<Point> inwards_;
};

}  // namespace innersphere
