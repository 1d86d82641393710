// Declares what can be packed: anything with a distance to its surface.
#pragma once

#include <limits>
#include <memory>
#include <string>

#include "innersphere/geometry.hpp"

namespace innersphere {

/// This is the point of a solid's surface that is nearest to a query point.
struct ClosestPoint {
  double distance = 0;  ///< The unsigned distance [m].
  Vec3d point{};        ///< The nearest point [m].
};

/// This is a bounded solid with a distance to its surface. Implementations are immutable and safe to query
/// from several threads at once. Only distances from the inside need to be exact; outside, a lower bound is
/// enough.
class Solid {
 public:
  virtual ~Solid() = default;

  /// Returns the nearest point of the surface. Beyond `cutoff` [m] the distance is infinity; a small cutoff
  /// is cheaper.
  virtual ClosestPoint closestPoint(const Vec3d& p,
                                    double cutoff = std::numeric_limits<double>::infinity()) const = 0;

  /// Returns true strictly inside.
  virtual bool contains(const Vec3d& p) const = 0;

  /// Returns a box around the solid. Tight boxes make packing faster.
  virtual Bounds bounds() const = 0;

  /// Returns the mass properties, exact where the representation allows it.
  virtual MassProperties massProperties() const = 0;

  /// Returns a triangle surface for drawing, ray tests and measuring gaps, wound counter-clockwise seen from
  /// outside.
  virtual Mesh surface() const = 0;

  /// Returns a name for messages and provenance.
  virtual std::string name() const = 0;

  /// Returns a hash of the geometry, hexadecimal: the same for the same solid on every machine. Empty if
  /// unknown.
  virtual std::string hash() const { return {}; }
};

}  // namespace innersphere
