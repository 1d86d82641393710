// Depth of contact, measured on the surfaces of the solids.
//
// Spheres find a contact, but they end a little inside of the surface, or, with volume-true radii, bulge out
// of it. So the depth at a contact is measured along a line: where it leaves A and where it enters B.
#pragma once

#include <vector>

#include "innersphere/overlap.hpp"
#include "narrow_phase/shapes/shape_surface.hpp"
#include "shape/placed_packing.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Two opposed points of the surfaces. Axes of the world, positions relative to the origin of A's packing.
struct OpposedPoints {
  btVector3 on_a{0, 0, 0};
  btVector3 on_b{0, 0, 0};
  btVector3 normal_a{0, 0, 0};  ///< unit, out of A
  btVector3 normal_b{0, 0, 0};  ///< unit, into B: equal to normal_a where flat faces meet
  btScalar curvature_a = 0;     ///< [1/m], positive where A is convex, 0 where it is flat
  btScalar curvature_b = 0;
  std::size_t triangle_a = kNone;  ///< of A's surface
  std::size_t triangle_b = kNone;  ///< of B's, if B is a packing

  static constexpr std::size_t kNone = ~std::size_t(0);
};

/// Measures along a line through the centre of a sphere in contact.
class SurfaceProbe {
 public:
  virtual ~SurfaceProbe() = default;
  /// At contact `index` of the list that the probe was made for, along `direction` from A to B (a shape that
  /// is no packing chooses its own), with the line moved sideways by `shift`. False if the line does not pass
  /// both surfaces near there. The triangles that `gap` comes with, or those around them, are taken if the
  /// line passes them; all are looked at only where they are kNone, or missed. Where B is no packing, the gap
  /// then holds a face of A all the same: that by which the line leaves A sideways, or one near the sphere.
  virtual bool measure(std::size_t index, const btVector3& direction, const btVector3& shift,
                       OpposedPoints& gap) const = 0;
  /// The direction from A to B in which the sphere of a contact is nearest to the other solid's surface.
  /// False if it is too far away to tell. Leaves the triangles near the sphere in `gap`.
  virtual bool nearest(std::size_t index, btVector3& direction, OpposedPoints& gap) const = 0;
  /// How far the faces at a gap go on in direction `towards` (unit), until they end in a sharp edge [m].
  struct Reach {
    btScalar a;
    btScalar b;
  };
  virtual Reach reach(const OpposedPoints& gap, const btVector3& towards) const = 0;
  /// Appends the corners near a gap where A (or else B) reaches furthest along `normal` (from A to B) and
  /// that are over the face of the other solid; also the far end of an edge that is level. Each with the
  /// point of the face that it is over.
  struct Corner {
    OpposedPoints gap;
    std::uint64_t id = 0;   ///< no sphere has it
    bool is_peak = true;    ///< the surface does not rise on from it
    bool is_alone = false;  ///< a crossing, and the gap that it was found from lies at an edge of B: its
                            ///< corners are over no face
  };
  virtual void corners(std::size_t index, const OpposedPoints& gap, const btVector3& normal, bool of_a,
                       std::vector<Corner>& corners) const = 0;
  /// Where, not far from a gap between two flat faces, an edge of A crosses one of B, and both solids have
  /// nothing further out along the normal to both nearby. False if none is found. `direction`: about that in
  /// which the solids are in contact, from A to B.
  virtual bool crossing(const OpposedPoints& gap, const btVector3& direction, Corner& crossing) const = 0;
  /// How far the sphere of a contact stands out of its solid along `normal` (from A to B), or, where that is
  /// known, towards the other surface. Only differences between spheres of one solid matter [m].
  struct Forward {
    bool of_a;
    btScalar distance;
  };
  virtual Forward forward(std::size_t index, const btVector3& normal) const = 0;
  /// Of the sphere behind a contact: the same from step to step.
  virtual std::uint64_t id(std::size_t index) const = 0;
  /// The normals of B do not come from triangles.
  virtual bool exactB() const = 0;
};

/// Contacts of a packing with a shape of another kind; `near spheres` are parallel to the contacts.
class ShapeProbe : public SurfaceProbe {
 public:
  /// `world`: where the other shape is.
  ShapeProbe(const PlacedPacking& a, ShapeSurface& other, const btTransform& world,
             const std::vector<NearSphere>& near_spheres)
      : a_(a), other_(other), world_(world), near_spheres_(near_spheres) {}
  bool measure(std::size_t index, const btVector3& direction, const btVector3& shift,
               OpposedPoints& gap) const override;
  bool nearest(std::size_t index, btVector3& direction, OpposedPoints& gap) const override;
  /// Of the other shape only its distance is known: it is taken as large.
  Reach reach(const OpposedPoints&, const btVector3&) const override { return {0, BT_LARGE_FLOAT}; }
  void corners(std::size_t index, const OpposedPoints& gap, const btVector3& normal, bool of_a,
               std::vector<Corner>& corners) const override;
  bool crossing(const OpposedPoints& gap, const btVector3& direction, Corner& crossing) const override;
  Forward forward(std::size_t index, const btVector3& normal) const override;
  std::uint64_t id(std::size_t index) const override { return near_spheres_[index].sphere; }
  bool exactB() const override { return true; }

 private:
  /// Whether the plane of a touch is still the surface of B at `place` of it.
  bool goesOn(const NearSphere& near_sphere, const btVector3& place) const;

  const PlacedPacking& a_;
  ShapeSurface& other_;
  const btTransform& world_;
  const std::vector<NearSphere>& near_spheres_;
};

/// Contacts of two packings: the first `count_a` are of A's spheres, the others of B's.
class PackingProbe : public SurfaceProbe {
 public:
  PackingProbe(const PlacedPacking& a, const PlacedPacking& b, const std::vector<SphereContact>& contacts,
               std::size_t count_a)
      : a_(a), b_(b), contacts_(contacts), count_a_(count_a) {}
  bool measure(std::size_t index, const btVector3& direction, const btVector3& shift,
               OpposedPoints& gap) const override;
  bool nearest(std::size_t index, btVector3& direction, OpposedPoints& gap) const override;
  Reach reach(const OpposedPoints& gap, const btVector3& towards) const override;
  void corners(std::size_t index, const OpposedPoints& gap, const btVector3& normal, bool of_a,
               std::vector<Corner>& corners) const override;
  bool crossing(const OpposedPoints& gap, const btVector3& direction, Corner& crossing) const override;
  Forward forward(std::size_t index, const btVector3& normal) const override;
  std::uint64_t id(std::size_t index) const override;
  bool exactB() const override { return false; }

 private:
  btVector3 apart() const { return b_.origin() - a_.origin(); }
  /// How far away the solid of a contact's sphere may end [m].
  btScalar reachOf(std::size_t index) const {
    const PlacedPacking& own = index < count_a_ ? a_ : b_;
    return own.ownRadius(contacts_[index].sphere) + own.search_margin;
  }

  const PlacedPacking& a_;
  const PlacedPacking& b_;
  const std::vector<SphereContact>& contacts_;
  std::size_t count_a_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
