// Shows the solid to be packed in the packer's own coordinates.
#pragma once

#include "innersphere/solid.hpp"
#include "packer/ball.hpp"
#include "packer/reporter.hpp"

namespace innersphere {

class MeshSolid;
class Triangle;

/// Maps the bounding cube of a solid to the unit cube, so that size and place of a solid do not influence its
/// packing.
class Container {
 public:
  struct Nearest {
    double distance = 0;  ///< infinity beyond the cutoff
    Point point;
    const Triangle* triangle = nullptr;  ///< that the point lies on, if the solid is a mesh
  };

  /// Maps a solid, which must outlive the container, as must the reporter if there is one. Throws Error:
  /// bad_argument if the bounds are not finite or out of range, no_sphere_fits if they are empty or too far
  /// away for double precision.
  explicit Container(const Solid& solid, const Reporter* reporter = nullptr);

  const Solid& solid() const { return solid_; }
  double side() const { return side_; }  ///< metres per unit

  /// Returns the origin of the packing's frame [m] (see Packing::origin).
  const Vec3d& origin() const { return origin_; }

  /// Throws Error cancelled if the user wants the work to end (see Reporter). So do closest() and
  /// contains().
  void goOn() const {
    if (reporter_) reporter_->goOn();
  }

  /// Returns the nearest point of the surface. Throws Error not_finite if the solid gives no number.
  Nearest closest(const Point& x, double cutoff) const;

  /// Returns a ball without surface inside that all but touches the surface at `wall`, on this side of it
  /// (unit vector): its radius is from `least` to `most`, as large as may be, or 0 if there is none.
  Ball emptyBall(const Point& wall, const Point& side, double least, double most) const;

  bool contains(const Point& x) const {
    goOn();
    return solid_.contains(toWorld(x));
  }
  /// The same, cheaper where the nearest point of the surface is known.
  bool contains(const Point& x, const Nearest& nearest) const;

  Vec3d toWorld(const Point& x) const;
  Point fromWorld(const Vec3d& p) const;

  /// Returns more than the rounding error of a distance, in units of the cube.
  double margin() const { return margin_; }

  /// Returns the largest ball inside this one that a Sphere can be, less a margin, so that whoever computes
  /// distances in double agrees that it is inside. Single precision comes in here, after all decisions, so
  /// that these are the same for all sizes and places.
  Ball rounded(const Ball& ball) const;

  /// Returns by how much a radius is smaller after rounding, at most, beside a relative 1e-7.
  double coarseness() const { return coarseness_; }

  /// Returns the ball as it is stored, in the packing's frame [m]; it is exact for rounded ones.
  Sphere toSphere(const Ball& ball) const;

  /// Returns the mesh as it is stored, in the packing's frame [m].
  Surface toSurface(const Mesh& mesh) const;

 private:
  Vec3d inFrame(const Point& x) const;
  Point fromFrame(const Vec3d& p) const;

  const Solid& solid_;
  const Reporter* const reporter_;
  Vec3d origin_{};
  Vec3d corner_{};               // of the unit cube, in the packing's frame
  const MeshSolid* const mesh_;  // the solid, if it is a mesh
  double side_ = 1;
  double margin_ = 0;
  double coarseness_ = 0;
};

}  // namespace innersphere
