// Probes the surfaces of a packing and of a shape of another kind at the spheres near it.
#pragma once

#include <array>
#include <vector>

#include "narrow_phase/contact_normal.hpp"
#include "narrow_phase/edge_contacts.hpp"
#include "narrow_phase/sample_selection.hpp"
#include "narrow_phase/shapes/shape_surface.hpp"
#include "narrow_phase/solid_corner.hpp"
#include "narrow_phase/surface_probe.hpp"
#include "narrow_phase/surface_rays.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Probes a packing, A, and another shape. Of the other shape, B, only the nearest point of each sphere is
/// known, with a normal that does not come from triangles. `near_spheres` are parallel to the contacts.
class ShapeProbe final : public SurfaceProbe, public EdgeProbe, public FaceExtents, public ContactSpheres {
 public:
  /// Takes what it probes, all of which must outlive it. `world` is where the other shape is.
  ShapeProbe(const PlacedPacking& a, ShapeSurface& other, const btTransform& world,
             const std::vector<NearSphere>& near_spheres)
      : a_(a), other_(other), world_(world), near_spheres_(near_spheres) {}

  /// Probes a sample for the first time, towards the nearest point of the other shape. Returns false if the
  /// line does not leave A.
  bool probe(ProbedSample& sample) const;
  /// Probes a sample again, where the nearest point is now. Returns false as probe() does.
  bool probeAgain(const Samples::Line& line, ProbedSample& sample) const;

  bool probeLine(std::size_t index, const btVector3& direction, const btVector3& shift,
                 OpposedPoints& points) const override;
  /// Of spheres over curved shapes. Over edges lines do not start at spheres, see toMiddleOfBend(), and over
  /// planes the tops that were missed are of no use.
  btScalar reach(std::size_t index) const override {
    return near_spheres_[index].curvature == 0 ? btScalar(0) : surfaceDistance(near_spheres_[index]);
  }
  btVector3 lineDirection(const ProbedSample& sample) const override { return sample.points.normal_b; }
  btVector3 lineStart(std::size_t index) const override {
    return a_.centreOf(near_spheres_[index].sphere) + near_spheres_[index].aside;
  }
  bool nearest(std::size_t index, btVector3& direction, OpposedPoints& points) const override;
  bool nearestWall(bool of_a, const btVector3& place, btScalar max_distance,
                   SurfaceQueries::Nearest& nearest) const override {
    if (!of_a) return nearestOfB(place, max_distance, nearest);
    if (!a_.nearest(place, max_distance + a_.margin, nearest)) return false;
    nearest.distance -= a_.margin;
    return true;
  }
  btScalar meets(bool of_a, const btVector3& from, const btVector3& way) const override {
    return of_a ? meetSolid(a_, from, way) : other_.meets(a_, world_, from, way);
  }
  Bend bend(bool of_a, const OpposedPoints& points, const Across& axes) const override;
  void corners(std::size_t index, const OpposedPoints& points, const btVector3& normal, bool of_a,
               std::vector<std::uint32_t>& vertices, std::vector<EdgeContact>& corners) const override;
  /// Appends the corners in which what sticks through a mesh ends, however far from it. `points` are those of
  /// a line that leaves A by the side of that part. `vertices` is room to work in.
  void tips(const OpposedPoints& points, std::vector<std::uint32_t>& vertices,
            std::vector<EdgeContact>& tips) const;
  bool hasEnds(bool of_a) const override;
  bool crossing(const OpposedPoints& points, const btVector3& direction,
                EdgeContact& crossing) const override;
  bool edgeOnFace(const OpposedPoints& points, bool of_a, const btVector3& normal,
                  std::vector<EdgeContact>& ends) const override;
  FaceEnd overEdge(const OpposedPoints& points, bool of_a, const btVector3& to_top,
                   EdgeContact& edge) const override;
  void lineEnds(const OpposedPoints& points, std::vector<EdgeContact>& ends) const override;
  void overlap(const OpposedPoints& points, const btVector3& normal, FaceOverlaps& overlaps,
               std::vector<EdgeContact>& crossings) const override;
  /// Returns what tells where faces end, or null where B's faces are not known.
  const FaceExtents* extents() const {
    SharpEdges b;
    return other_.facets(a_, world_, b) ? this : nullptr;
  }
  EdgeDistances edgeDistances(const OpposedPoints& points, const btVector3& towards) const override;
  bool hasEdges() const override { return other_.isFaceted(); }
  btVector3 toMiddleOfBend(const ProbedSample& sample) const override;
  bool isOnFaceOfB(const OpposedPoints& points) const override;
  std::uint64_t id(std::size_t index) const override { return near_spheres_[index].sphere; }
  Protrusion protrusion(std::size_t index, const btVector3& normal) const override;
  bool isOfPacking(std::size_t index) const override { return !a_.isFeeler(near_spheres_[index].sphere); }
  /// Returns how deep the sphere itself is in the other shape, negative if it is outside [m].
  btScalar depth(std::size_t index) const {
    const NearSphere& near_sphere = near_spheres_[index];
    return a_.ownRadius(near_sphere.sphere) + a_.margin - near_sphere.distance;
  }

 private:
  /// Probes along the line to the nearest point. Returns false if that goes on through A from a valley.
  bool probeDirectly(ProbedSample& sample) const;
  /// Finds the same of B where that knows the nearest point of any place.
  bool nearestOfB(const btVector3& place, btScalar max_distance, SurfaceQueries::Nearest& nearest) const {
    NearSphere seen;
    if (!other_.nearestTo(a_, world_, place, seen) || seen.distance > max_distance) return false;
    nearest = {seen.distance, seen.normal, OpposedPoints::kNone, false};
    return true;
  }
  /// Finds what a sphere at `from` would see, beside where one of ours is. Returns false if that is not
  /// known.
  bool nearestBeside(const NearSphere& near_sphere, const btVector3& from, const btVector3& shift,
                     NearSphere& near_place) const;
  /// Returns how far away the solid of a sphere may end [m].
  btScalar surfaceDistance(const NearSphere& near_sphere) const {
    return a_.ownRadius(near_sphere.sphere) + a_.search_margin;
  }
  /// Finds the face of B that is nearest to a point of it. Returns false if its faces are not known.
  bool faceOfB(const OpposedPoints& points, SharpEdges& b, std::size_t& triangle) const;
  /// Returns how the surface bends that a mesh was cut from, where it is hollow: what glides over its facets
  /// comes to the next one in the step. Where it is convex, the next facet falls away.
  Bend bendOfFacets(const OpposedPoints& points, const Across& axes) const;
  /// Returns true if the plane that a sphere is nearest to is still the surface of B at `place` of it.
  bool goesOn(const NearSphere& near_sphere, const btVector3& place) const;
  /// Holds the near spheres that know a face, as columns, in the packing's frame. Probes of one thread share
  /// the memory.
  struct FaceSpheres {
    const ShapeProbe* probe = nullptr;  ///< whose they are; another one may have been at the same place
    std::vector<const NearSphere*> spheres;
    std::vector<btScalar> x, y, z;
    std::vector<btScalar> size2;      ///< square of surfaceDistance()
    std::vector<btScalar> distance2;  ///< from a corner
  };
  void findFaceSpheres(FaceSpheres& found) const;
  /// Returns the sphere nearest to a corner that knows the face under it, or null if there is none.
  const NearSphere* sphereOver(const btVector3& corner, const btVector3& normal) const;

  /// This is a corner of A, seen along a normal.
  struct Corner {
    std::uint32_t vertex = 0;
    btVector3 normal{0, 0, 0};  ///< from A to B
    SolidCorner of_a;
    bool is_over = false;  ///< a face of B; if so, the others are as in OpposedPoints
    btVector3 on_b{0, 0, 0}, normal_b{0, 0, 0};
  };
  /// Finds one. Many samples ask for the same.
  const Corner& cornerOf(std::uint32_t vertex, const btVector3& normal) const;

  const PlacedPacking& a_;
  ShapeSurface& other_;
  const btTransform& world_;
  const std::vector<NearSphere>& near_spheres_;
  mutable std::array<Corner, 8> corners_;  ///< those that were asked for last: a face seldom has more
  mutable std::size_t corner_count_ = 0;   ///< that were asked for
  mutable bool has_face_spheres_ = false;  ///< found for the first corner
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
