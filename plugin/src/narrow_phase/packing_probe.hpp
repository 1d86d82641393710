// Probes the surfaces of two packings at the spheres in contact.
#pragma once

#include <vector>

#include "narrow_phase/contact_normal.hpp"
#include "narrow_phase/edge_contacts.hpp"
#include "narrow_phase/sample_selection.hpp"
#include "narrow_phase/surface_probe.hpp"
#include "shape/placed_packing.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Probes two packings. Of the contacts the first `count_a` are of A's spheres, the others of B's. `foretold`
/// is the part of A's search margin that lies beyond its surface [m], where that is more than a body is
/// thick; else 0.
class PackingProbe final : public SurfaceProbe, public EdgeProbe, public FaceExtents, public ContactSpheres {
 public:
  PackingProbe(const PlacedPacking& a, const PlacedPacking& b, const std::vector<SphereContact>& contacts,
               std::size_t count_a, bool thin = false, btScalar foretold = 0)
      : a_(a), b_(b), contacts_(contacts), count_a_(count_a), thin_(thin), foretold_(foretold) {}

  /// Probes a sample for the first time: towards the nearest point of the other surface, or, where the
  /// surfaces do not oppose each other there, in the direction of the patch. Where both bend, and the nearest
  /// point is further than `separation` [m] from where the line leaves its own solid, so is all of the other
  /// surface: no other line is drawn. Returns false if the line met no surfaces.
  bool probe(const btVector3& patch_normal, btScalar separation, ProbedSample& sample) const;
  /// Probes a sample towards the nearest point of the other surface alone, between flat faces. Returns false
  /// as probe() does, or if that lies aside of the patch.
  bool probeNearest(const btVector3& patch_normal, ProbedSample& sample) const;
  /// Probes a sample where it was probed before, or, where that line misses the surfaces now, anew. Returns
  /// false as probe() does.
  bool probeAgain(const btVector3& patch_normal, btScalar separation, const Samples::Line& line,
                  ProbedSample& sample) const;

  bool probeLine(std::size_t index, const btVector3& direction, const btVector3& shift,
                 OpposedPoints& points) const override;
  btVector3 lineStart(std::size_t index) const override;
  btScalar reach(std::size_t index) const override { return surfaceDistance(index); }
  bool nearest(std::size_t index, btVector3& direction, OpposedPoints& points) const override;
  bool nearestWall(bool of_a, const btVector3& place, btScalar max_distance,
                   SurfaceQueries::Nearest& nearest) const override {
    const PlacedPacking& body = of_a ? a_ : b_;
    const btVector3 at = of_a ? place : place - apart();
    if (!body.nearest(at, max_distance + body.margin, nearest)) return false;
    nearest.distance -= body.margin;
    return true;
  }
  btScalar meets(bool of_a, const btVector3& from, const btVector3& way) const override;
  Bend bend(bool of_a, const OpposedPoints& points, const Across& axes) const override;
  void corners(std::size_t index, const OpposedPoints& points, const btVector3& normal, bool of_a,
               std::vector<std::uint32_t>& vertices, std::vector<EdgeContact>& corners) const override;
  bool hasEnds(bool of_a) const override;
  bool crossing(const OpposedPoints& points, const btVector3& direction,
                EdgeContact& crossing) const override;
  void overlap(const OpposedPoints& points, const btVector3& normal, FaceOverlaps& overlaps,
               std::vector<EdgeContact>& crossings) const override;
  bool edgeOnFace(const OpposedPoints& points, bool of_a, const btVector3& normal,
                  std::vector<EdgeContact>& ends) const override;
  FaceEnd overEdge(const OpposedPoints& points, bool of_a, const btVector3& to_top,
                   EdgeContact& edge) const override;
  EdgeDistances edgeDistances(const OpposedPoints& points, const btVector3& towards) const override;
  std::uint64_t id(std::size_t index) const override;
  Protrusion protrusion(std::size_t index, const btVector3& normal) const override;
  bool isOfPacking(std::size_t index) const override {
    return !(index < count_a_ ? a_ : b_).isFeeler(contacts_[index].sphere);
  }

 private:
  /// Returns true if a line goes in its own solid along one of its faces, and meets what has sunk in there by
  /// far less than by the line: all that it tells is how far that face goes on.
  bool runsBelowFace(const ProbedSample& sample) const;
  /// Returns true if one of the solids is thin there.
  bool isThinAt(const OpposedPoints& points) const;
  btVector3 apart() const { return b_.origin() - a_.origin(); }
  /// Returns how far away the solid of a contact's sphere may end [m].
  btScalar surfaceDistance(std::size_t index) const {
    const PlacedPacking& own = index < count_a_ ? a_ : b_;
    return own.ownRadius(contacts_[index].sphere) + own.search_margin;
  }
  /// Returns how far a line goes in the solid of its sphere at most [m]: spheres that look far see surfaces
  /// along a thin wall, too, and lines to them leave it only at its rim. Each part of the surface is no
  /// further from some sphere than this.
  btScalar longestInSolid(std::size_t index, btScalar length) const {
    if (foretold_ == 0) return length;
    return surfaceDistance(index) - (index < count_a_ ? foretold_ : btScalar(0));
  }
  /// Returns true if the line of a sample leaves the solid of its sphere no further away than that may end.
  bool leavesNear(const ProbedSample& sample) const {
    const btVector3& left = sample.index < count_a_ ? sample.points.on_a : sample.points.on_b;
    const btScalar most = surfaceDistance(sample.index);
    return left.distance2(lineStart(sample.index)) <= most * most;
  }
  /// Returns true if the line of a sample went on through the solid of its sphere from a valley: see
  /// isPastValley().
  bool isPastValley(const ProbedSample& sample) const;
  /// Draws the line again along the normal that the surfaces show.
  void align(ProbedSample& sample) const;

  const PlacedPacking& a_;
  const PlacedPacking& b_;
  const std::vector<SphereContact>& contacts_;
  std::size_t count_a_;
  bool thin_;
  btScalar foretold_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
