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

  /// Throws Error bad_argument if the bounds are not finite or out of range, no_sphere_fits if they are empty
  /// or too far away for double precision.
  explicit Container(const Solid& solid);

  const Solid& solid() const { return solid_; }
  double side() const { return side_; }  ///< metres per unit

  /// The origin of the packing's frame (see Packing::origin).
  const Vec3d& origin() const { return origin_; }

  Nearest closest(const Point& x, double cutoff) const;
  bool contains(const Point& x) const { return solid_.contains(toWorld(x)); }

  Vec3d toWorld(const Point& x) const;
  Point fromWorld(const Vec3d& p) const;

  /// More than the rounding error of a distance.
  double margin() const { return margin_; }

  /// The largest ball inside this one that a Sphere can be, less a margin, so that whoever computes distances
  /// in double agrees that it is inside. Single precision comes in here, after all decisions, so that these
  /// are the same for all sizes and places.
  Ball rounded(const Ball& ball) const;

  /// A radius is at most this much smaller than before rounding, and a relative 1e-7.
  double coarseness() const { return coarseness_; }

  /// The ball as it is stored, in the packing's frame; exact for rounded ones.
  Sphere toSphere(const Ball& ball) const;

  /// The mesh as it is stored.
  Surface toSurface(const Mesh& mesh) const;

 private:
  Vec3d inFrame(const Point& x) const;
  Point fromFrame(const Vec3d& p) const;

  const Solid& solid_;
  Vec3d origin_{};
  Vec3d corner_{};  // of the unit cube, in the packing's frame
  double side_ = 1;
  double margin_ = 0;
  double coarseness_ = 0;
};

}  // namespace innersphere
