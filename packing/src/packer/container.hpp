// The solid to be packed, in the packer's own coordinates.
#pragma once

#include "innersphere/solid.hpp"
#include "packer/ball.hpp"

namespace innersphere {

/// Maps the bounding cube of a solid to the unit cube, so that size and place of a solid do not influence its
/// packing.
class Container {
 public:
  struct Nearest {
    double distance = 0;  ///< infinity beyond the cutoff
    Point point;
  };

  /// Throws Error bad_argument if the bounds are not finite, no_sphere_fits if they are empty.
  explicit Container(const Solid& solid);

  const Solid& solid() const { return solid_; }
  double side() const { return side_; }  ///< metres per unit

  Nearest closest(const Point& x, double cutoff) const;
  bool contains(const Point& x) const { return solid_.contains(toWorld(x)); }

  Vec3d toWorld(const Point& x) const;
  Point fromWorld(const Vec3d& p) const;

  /// More than the rounding error of a distance.
  double margin() const { return margin_; }

  /// snap() moves a point by at most this.
  double coarseness() const { return coarseness_; }

  /// The nearest point that a Sphere can have as its centre.
  Point snap(const Point& x) const;

  /// The largest ball about a snapped point that fits into `room` and has a radius in single precision. A
  /// rounding margin is taken off first, so that whoever computes distances in double agrees that it fits.
  Ball fit(const Point& snapped, double room) const;

  /// The ball as it is stored; exact for balls made by fit().
  Sphere toSphere(const Ball& ball) const;

 private:
  const Solid& solid_;
  Vec3d origin_{};
  double side_ = 1;
  double margin_ = 0;
  double coarseness_ = 0;
};

}  // namespace innersphere
