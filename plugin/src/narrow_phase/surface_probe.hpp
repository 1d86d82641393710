// Probes the depth of contact on the surfaces of the solids.
//
// Spheres find a contact, but they end a little inside of the surface, or, with volume-true radii, stand out
// of it. So the depth at a contact is found along a line: where it leaves A and where it enters B.
#pragma once

#include <cstddef>
#include <cstdint>

#include <LinearMath/btVector3.h>

#include "innersphere/bullet_precision.hpp"
#include "narrow_phase/hill.hpp"
#include "surface/surface_queries.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds two opposed points of the surfaces. Axes are those of the world, positions are relative to the
/// origin of A's packing.
struct OpposedPoints {
  btVector3 on_a{0, 0, 0};
  btVector3 on_b{0, 0, 0};
  btVector3 normal_a{0, 0, 0};  ///< unit, out of A
  btVector3 normal_b{0, 0, 0};  ///< unit, into B: equal to normal_a where flat faces meet
  btScalar curvature_a = 0;     ///< [1/m], positive where A is convex, 0 where it is flat
  btScalar curvature_b = 0;
  /// Unit, along which B is curved less: of a cylinder. 0 if it is round, or a packing.
  btVector3 straight_b{0, 0, 0};
  btScalar along_straight_b = 0;   ///< its curvature along that [1/m]
  std::size_t triangle_a = kNone;  ///< of A's surface
  std::size_t triangle_b = kNone;  ///< of B's, if B is a packing

  static constexpr std::size_t kNone = ~std::size_t(0);

  /// Returns how deep the solids are in each other along a unit vector from A to B [m].
  btScalar depthAlong(const btVector3& direction) const { return (on_a - on_b).dot(direction); }
  /// Returns true if both surfaces are flat there.
  bool areFlat() const { return curvature_a == 0 && curvature_b == 0; }
};

/// This is a sphere in contact that was chosen as a sample, with what was found along its line.
struct ProbedSample {
  OpposedPoints points;
  btVector3 direction{0, 0, 0};  ///< of the line, unit, from A to B
  std::size_t index = 0;         ///< of the contact
  std::uint64_t id = 0;          ///< of the sphere
  bool starts_ascent = false;    ///< an ascent to a deepest point began here
  bool is_top = false;           ///< an ascent ended here, at the top of its hill
  /// How much deeper the surfaces are at the top of the hill that an ascent from here would reach, by their
  /// slope and bend [m]. 0 where that is not known: where faces are flat, fit together, or are steep.
  btScalar below_top = 0;

  /// Returns true if the surfaces bend and are too far apart for a contact along the line. All that can be
  /// near is then the top of their hill.
  bool isFar(btScalar separation) const {
    return !points.areFlat() && points.depthAlong(direction) < -separation;
  }
  /// Returns true if that holds, and neither has a corner there.
  bool isFarFromBend(btScalar separation) const {
    return points.curvature_a != 0 && points.curvature_b != 0 && isFar(separation);
  }
};

/// Finds opposed points along lines through the spheres in contact. `index` is that of a contact in the list
/// that the probe was made for.
class SurfaceProbe {
 public:
  virtual ~SurfaceProbe() = default;
  /// Probes along `direction` from A to B (a shape that is no packing chooses its own), with its start
  /// moved by `shift` [m]. Returns false if the line does not pass both surfaces near there. The triangles
  /// that `points` comes with, or those around them, are taken if the line passes them; all are looked at
  /// only where they are kNone, or missed. Where B is no packing, `points` then holds a face of A all the
  /// same: that by which the line leaves A sideways, or one near the sphere.
  virtual bool probeLine(std::size_t index, const btVector3& direction, const btVector3& shift,
                         OpposedPoints& points) const = 0;
  /// Returns where lines start that are not moved sideways: the middle of the sphere [m].
  virtual btVector3 lineStart(std::size_t index) const = 0;
  /// Returns how far beside there a line may start [m].
  virtual btScalar reach(std::size_t index) const = 0;
  /// Returns the direction of the line that was drawn for a sample.
  virtual btVector3 lineDirection(const ProbedSample& sample) const { return sample.direction; }
  /// Returns true if B may have edges, at which the slope of the depth falls suddenly.
  virtual bool hasEdges() const { return false; }
  /// Returns the way back along a sample's line to where ascents do better to start; zero by default [m].
  virtual btVector3 toMiddleOfBend(const ProbedSample&) const { return {0, 0, 0}; }
  /// Finds the direction from A to B in which the sphere is nearest to the other solid's surface. Returns
  /// false if it is too far away to tell. Leaves the triangles near the sphere in `points`.
  virtual bool nearest(std::size_t index, btVector3& direction, OpposedPoints& points) const = 0;
  /// Finds the nearest point of A's surface, or of B's. Returns false if it is further from `place` than
  /// `max_distance` [m], or not known, as by default.
  virtual bool nearestWall(bool, const btVector3&, btScalar, SurfaceQueries::Nearest&) const { return false; }
  /// Finds where a point that goes along `way` [m] comes from outside to A's surface, or to B's: the part of
  /// the way, 0 to 1; 2 if it does not; -1 if that is not known.
  virtual btScalar meets(bool of_a, const btVector3& from, const btVector3& way) const = 0;
  /// Returns how A's surface, or B's, bends at opposed points. By default it is round.
  virtual Bend bend(bool of_a, const OpposedPoints& points, const Across&) const {
    return Bend::round(of_a ? points.curvature_a : points.curvature_b);
  }
  struct Bends {
    Bend a, b;
  };
  /// Returns the same of both.
  Bends bends(const OpposedPoints& points, const Across& axes) const {
    return {bend(true, points, axes), bend(false, points, axes)};
  }
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
