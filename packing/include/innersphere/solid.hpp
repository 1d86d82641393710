// What can be packed: anything with a distance to its surface.
#pragma once

#include <limits>
#include <memory>
#include <string>

#include "innersphere/geometry.hpp"

namespace innersphere {

/// The point of a solid's surface that is nearest to a query point.
struct ClosestPoint {
  double distance = 0;  ///< [m], unsigned
  Vec3d point{};        ///< [m]
};

/// A bounded solid. Implementations are immutable and safe to query from several threads at once. Only
/// distances from the inside need to be exact; outside, a lower bound is enough.
class Solid {
 public:
  virtual ~Solid() = default;

  /// Nearest point of the surface. A caller that does not care for surface farther than `cutoff` [m] says so
  /// and gets distance = infinity there, which is cheaper.
  virtual ClosestPoint closestPoint(const Vec3d& p,
                                    double cutoff = std::numeric_limits<double>::infinity()) const = 0;

  /// True strictly inside.
  virtual bool contains(const Vec3d& p) const = 0;

  /// A box around the solid; tight boxes make packing faster.
  virtual Bounds bounds() const = 0;

  /// Exact where the representation allows it, in double.
  virtual MassProperties massProperties() const = 0;

  /// A triangle surface for drawing, ray tests and measuring gaps, wound counter-clockwise seen from outside.
  virtual Mesh surface() const = 0;

  /// Name for messages and provenance.
  virtual std::string name() const = 0;

  /// Hash of the geometry, hexadecimal: the same for the same solid on every machine. Empty if unknown.
  virtual std::string hash() const { return {}; }
};

}  // namespace innersphere
