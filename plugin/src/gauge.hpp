// Depth of contact, measured on the surfaces of the solids.
//
// Spheres find a contact, but they end a little inside of the surface, or, with volume-true radii, bulge out
// of it. So the depth at a contact is measured along a line: where it leaves A and where it enters B.
#pragma once

#include <vector>

#include "innersphere/overlap.hpp"
#include "packing_body.hpp"
#include "surfaces/other_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Two opposed points of the surfaces. Axes of the world, positions relative to the origin of A's packing.
struct Gap {
  btVector3 on_a{0, 0, 0};
  btVector3 on_b{0, 0, 0};
  btVector3 normal_a{0, 0, 0};  ///< unit, out of A
  btVector3 normal_b{0, 0, 0};  ///< unit, into B: equal to normal_a where flat faces meet
};

/// Gauge::id() never returns this.
constexpr std::uint64_t kClimbedId = ~std::uint64_t(0);

class Gauge {
 public:
  virtual ~Gauge() = default;
  /// At contact `index` of the list that the gauge was made for, roughly along `direction` from A to B. False
  /// if there is no surface where it is expected.
  virtual bool measure(std::size_t index, const btVector3& direction, Gap& gap) const = 0;
  /// The same at another point between the bodies. Only a gauge of two packings can do it.
  virtual bool measureAt(const btVector3& p, const btVector3& direction, Gap& gap) const = 0;
  /// Of the sphere behind a contact: the same from step to step.
  virtual std::uint64_t id(std::size_t index) const = 0;
  /// The normals of B do not come from triangles.
  virtual bool exactB() const = 0;
};

/// Contacts of a packing with a shape of another kind; `touches` are parallel to the contacts.
class SurfaceGauge : public Gauge {
 public:
  SurfaceGauge(const PackingBody& a, const std::vector<Touch>& touches) : a_(a), touches_(touches) {}
  bool measure(std::size_t index, const btVector3& direction, Gap& gap) const override;
  bool measureAt(const btVector3&, const btVector3&, Gap&) const override { return false; }
  std::uint64_t id(std::size_t index) const override { return touches_[index].sphere; }
  bool exactB() const override { return true; }

 private:
  const PackingBody& a_;
  const std::vector<Touch>& touches_;
};

/// Contacts of two packings: those of the first `count_a` are of A's spheres, the others of B's.
class PackingGauge : public Gauge {
 public:
  PackingGauge(const PackingBody& a, const PackingBody& b, const std::vector<SphereContact>& contacts,
               std::size_t count_a);
  bool measure(std::size_t index, const btVector3& direction, Gap& gap) const override;
  bool measureAt(const btVector3& p, const btVector3& direction, Gap& gap) const override;
  std::uint64_t id(std::size_t index) const override;
  bool exactB() const override { return false; }

 private:
  struct Side {
    const PackingBody* body;
    btVector3 offset;  ///< of its origin from the origin of A
    std::size_t first;
    std::size_t last;
  };
  std::size_t sphereOn(const Side& side, const btVector3& p, const btVector3& direction) const;
  bool measure(std::size_t i, std::size_t j, const btVector3& p, const btVector3& direction, Gap& gap) const;

  const std::vector<SphereContact>& contacts_;
  Side a_;
  Side b_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
