// Handles shapes with one nearest point: convex ones, planes and distance fields.
#pragma once

#include <BulletCollision/CollisionShapes/btConvexShape.h>

#include "narrow_phase/shapes/facets.hpp"
#include "narrow_phase/shapes/shape_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Finds near spheres of a shape by its distance from a point.
class DistanceSurface : public ShapeSurface {
 public:
  void findNearSpheres(const PlacedPacking& body, const btTransform& world,
                       std::vector<NearSphere>& near_spheres) override;
  bool updateNearSpheres(const PlacedPacking& body, const btTransform& world,
                         std::vector<NearSphere>& near_spheres) final;
  bool distanceOf(const PlacedPacking& body, const btTransform& world, const btVector3& place,
                  btScalar& distance) final;
  bool nearestTo(const PlacedPacking& body, const btTransform& world, const btVector3& place,
                 NearSphere& near_sphere) final;
  btScalar meets(const PlacedPacking& body, const btTransform& world, const btVector3& from,
                 const btVector3& way) final;
  bool facets(const PlacedPacking& body, const btTransform& world, SharpEdges& solid) final;
  bool line(const PlacedPacking& body, const btTransform& world, const btVector3& direction,
            btVector3 (&ends)[2]) final;

 protected:
  struct Nearest {
    btScalar distance;            ///< [m], negative inside
    btVector3 normal;             ///< unit, outwards
    btScalar curvature = 0;       ///< [1/m]
    btVector3 straight{0, 0, 0};  ///< see NearSphere
    btScalar along_straight = 0;
    /// The shape, if it may have an edge or a corner there.
    const btConvexShape* edged = nullptr;
    btScalar edge_curvature = 0;  ///< of that edge [1/m]; 0 if it is a face, or not known
  };
  /// Finds the nearest point, in the frame of the shape. Returns false where the distance is unknown; the
  /// point is then taken as far away.
  virtual bool nearest(const btVector3& p, Nearest& nearest) const = 0;
  /// Returns at most the distance of p, and cheaper; only its comparison with a radius matters.
  virtual btScalar lowerBound(const btVector3& p) const;
  /// Returns true if it is known to be convex.
  virtual bool isConvex() const { return true; }
  /// Finds the ends of the straight line on it that is furthest out along `direction`, in the frame of the
  /// shape. Returns false if there is none.
  virtual bool lineTowards(const btVector3&, btVector3 (&)[2]) const { return false; }
  /// Returns the shape as a polyhedron, or null if it is none.
  virtual const btPolyhedralConvexShape* polyhedron() const { return nullptr; }
  /// Returns true if the bounding box of a shape is what it was at the last call. What moves less than the
  /// box shows is not noticed before the bodies move.
  bool boxIsAsBefore(const btCollisionShape& shape);
  /// Returns the distance of p from the bounding box of a shape [m].
  static btScalar boxDistance(const btCollisionShape& shape, const btVector3& p);

  Facets facets_;  ///< of the polyhedron, once they were needed

 private:
  bool updateNearSphere(const PlacedPacking& body, const btTransform& world, const btTransform& to_shape,
                        NearSphere& near_sphere) const;

  btVector3 box_min_{0, 0, 0};
  btVector3 box_max_{0, 0, 0};
};

// One maker for each kind.
std::unique_ptr<ShapeSurface> makePlaneSurface(const btCollisionShape& shape);
std::unique_ptr<ShapeSurface> makeSphereSurface(const btCollisionShape& shape);
std::unique_ptr<ShapeSurface> makeBoxSurface(const btCollisionShape& shape);
std::unique_ptr<ShapeSurface> makeCapsuleSurface(const btCollisionShape& shape);
std::unique_ptr<ShapeSurface> makeCylinderSurface(const btCollisionShape& shape);
std::unique_ptr<ShapeSurface> makeConeSurface(const btCollisionShape& shape);
std::unique_ptr<ShapeSurface> makeMultiSphereSurface(const btCollisionShape& shape);
std::unique_ptr<ShapeSurface> makeConvexSurface(const btCollisionShape& shape);
/// Makes a surface of a distance field. Returns null if the shape is no btSdfCollisionShape.
std::unique_ptr<ShapeSurface> makeSdfSurface(const btCollisionShape& shape);
std::unique_ptr<ShapeSurface> makeTriangleSurface(const btCollisionShape& shape);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
