// Places spheres where the surface is farthest from all others.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "packer/clearance_cache.hpp"
#include "packer/container.hpp"
#include "packer/sphere_grid.hpp"
#include "packer/surface_samples.hpp"

namespace innersphere {

/// Covers a surface with spheres inside the solid: each goes to the sample that is farthest from the spheres
/// so far (Gonzalez, Clustering to minimize the maximum intercluster distance, 1985). Of the balls that touch
/// no other and are centred within half of that distance it is the largest that a pattern search finds, so
/// that walls get spheres of their thickness, and edges and corners one after the other, into their tips.
class Cover {
 public:
  /// Places no sphere smaller than `min_radius`. Samples, and the placed balls, have to outlive this object.
  Cover(const Container& container, const SurfaceSamples& samples, const SphereGrid& placed,
        double min_radius);

  /// Calls insert(ball), which is to put the ball into the grid, until no sample is farther than `gap` from a
  /// sphere, except where none comes nearer. Ends and returns true if insert() does. There has to be a ball.
  bool upTo(double gap, const std::function<bool(const Ball&)>& insert);

 private:
  struct Far {
    double gap;
    std::uint32_t sample;
    bool operator<(const Far& other) const {
      return gap != other.gap ? gap < other.gap : sample > other.sample;
    }
  };

  void update();
  void settle();
  Ball largestNear(const Point& p, const Point& inwards, double reach);
  double room(const Point& x, double enough, double wall);
  std::size_t cellOf(const Point& x, int axis) const;

  const Container& container_;
  const SurfaceSamples& samples_;
  const SphereGrid& placed_;
  const double min_radius_;
  ClearanceCache clearances_;
  std::size_t known_ = 0;  // balls that the gaps take into account
  std::vector<double> gaps_;
  std::vector<Far> heap_;
  std::vector<std::uint32_t> order_, begins_;  // samples by cells of a lattice
};

}  // namespace innersphere
