// Places a packing in the world, for one collision.
#pragma once

#include "common/bullet_vectors.hpp"
#include "innersphere/contact_options.hpp"
#include "innersphere/placement.hpp"
#include "shape/packing_shape_impl.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

struct PlacedPacking {
  /// `search_margin` [m] is how far beyond its radius and the shape's margin a sphere looks for contacts.
  /// `prefix` says which spheres to use, null for those the shape uses; with Estimator::volume_true as many
  /// of them as there are such radii for.
  PlacedPacking(const PackingShape& packing_shape, const btTransform& body, Estimator estimator,
                btScalar search_margin, const Prefix* prefix = nullptr);

  const PackingShape::Impl& shape() const { return *impl; }
  std::size_t count() const { return prefix->count; }
  const SphereBvh& sphereBvh() const { return feelers == nullptr ? prefix->tree() : prefix->feelingTree(); }
  btScalar scale() const { return impl->scaling.x(); }
  const btVector3& origin() const { return world.getOrigin(); }

  /// Has feelers from now on: spheres from count() on, which bear no volume. Call it only if the packing has
  /// a surface.
  void addFeelers() { feelers = &prefix->feelers(); }
  /// The same for searches among packings.
  void addSearchFeelers() { feelers = &prefix->searchFeelers(); }
  bool isFeeler(std::size_t i) const { return i >= count(); }
  /// Returns sphere i, in the packing's frame and its lengths.
  const Sphere& sphere(std::size_t i) const {
    return isFeeler(i) ? feelers->balls[i - count()] : impl->packing().spheres[i];
  }
  /// Returns the sphere that a feeler is nearest to.
  std::size_t sphereBeside(std::size_t feeler) const { return feelers->spheres[feeler - count()]; }
  /// Returns a triangle near sphere i. Call it only if the packing has a surface.
  std::size_t triangleNear(std::size_t i) const {
    return isFeeler(i) ? feelers->triangles[i - count()] : impl->solid->triangleNear(i);
  }

  /// Returns the centre of sphere i relative to origin(), in axes of the world [m].
  btVector3 centreOf(std::size_t i) const { return world.getBasis() * (centre(sphere(i)) * scale()); }
  /// Returns the sphere's own radius [m].
  btScalar ownRadius(std::size_t i) const { return btScalar(sphere(i).radius) * scale(); }
  /// Returns the sphere's radius for the estimator [m].
  btScalar radiusOf(std::size_t i) const {
    return radii == nullptr || isFeeler(i) ? ownRadius(i) : btScalar(radii[i]) * scale();
  }
  /// Returns how close to the other surface its centre must be to be reported [m].
  btScalar searchRadius(std::size_t i) const { return radiusOf(i) + margin + search_margin; }
  /// Returns how far any sphere reaches beyond its own radius, at most [m].
  btScalar largestExcess() const { return search_margin + margin + excess; }

  Placement placement() const;

  /// Finds the nearest point of the solid's surface, without the margin. `place` is relative to origin(), in
  /// axes of the world, and so is the normal of the result. Returns false if the surface is further away than
  /// `max_distance` [m].
  bool nearest(const btVector3& place, btScalar max_distance, SurfaceQueries::Nearest& nearest) const;

  const PackingShape::Impl* impl;
  const Prefix* prefix;
  const Feelers* feelers = nullptr;  ///< null if they are not used
  btTransform world;                 ///< from the packing's frame, scaled, to the world
  const float* radii = nullptr;      ///< volume-true radii, or null for the spheres' own
  btScalar margin;                   ///< of the shape: the solid is this much larger on all sides [m]
  btScalar search_margin;
  btScalar excess = 0;  ///< largest volume-true radius minus own radius [m]
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
