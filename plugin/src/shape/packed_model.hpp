// Holds what all shapes of one collision model share.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>

#include "common/lazy.hpp"
#include "innersphere/collision_model.hpp"
#include "shape/feelers.hpp"
#include "shape/principal_frame.hpp"
#include "shape/shape_frame.hpp"
#include "shape/sphere_bvh.hpp"
#include "shape/support_bounds.hpp"
#include "surface/surface_queries.hpp"
#include "surface/vertex_hill_climb.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

class PackedModel;

/// Holds the first spheres of a packing, and the feelers where these leave its surface out. Lengths are for
/// scale 1 [m].
class Prefix {
 public:
  /// The model must outlive it.
  Prefix(const PackedModel& model, std::size_t count);

  const SphereBvh& tree() const;
  bool hasTree() const { return tree_.made(); }
  /// Returns how far the spheres may end inside of the surface; 0 if the packing has none.
  btScalar inset() const;
  /// Returns the balls that feel where no sphere is near the surface: none where spheres are near it
  /// everywhere. Call it only if the packing has a surface.
  const Feelers& feelers() const;
  /// Returns those that searches among packings need: where the solid is thinner than its gaps spheres would
  /// be enlarged through walls, and lines from them not lead to where walls meet. Most solids have none, and
  /// inset() then is theirs.
  const Feelers& searchFeelers() const;
  /// Returns the tree of the spheres and, counted on from there, the feelers.
  const SphereBvh& feelingTree() const;

  /// Returns the model of the spheres, then searchFeelers(), enlarged, see searchSpheres(). Call it only if
  /// the packing has a surface.
  const CollisionModel& searchModel() const;

  /// Tells the log, once for each packing, if parts of the surface have no sphere near them. For spheres that
  /// a user chose.
  void warnOnce() const;

  const std::size_t count;
  const VolumeTrueRadii* const volume_true;  ///< the longest list that is not longer, or null
  const btScalar largest_overshoot;          ///< largest of them minus the sphere's own radius; 0 if none
  const btScalar median_radius;
  const btScalar largest_radius;  ///< half as thick as the solid is where it is thickest

 private:
  Feelers feelersIn(FeelerPlaces where) const;

  const PackedModel& model_;
  Lazy<SphereBvh> tree_;
  Lazy<btScalar> inset_;
  Lazy<Feelers> feelers_, search_feelers_;
  Lazy<SphereBvh> feeling_tree_;
  Lazy<CollisionModel> search_model_;
  mutable std::once_flag warned_;
};

/// Holds what a model's shapes share. Trees are built when they are first asked for. Const members are safe
/// to call from several threads at once.
class PackedModel {
 public:
  explicit PackedModel(std::shared_ptr<const CollisionModel> collision_model);
  /// Returns the one of a model: the same as long as somebody holds it.
  static std::shared_ptr<const PackedModel> of(std::shared_ptr<const CollisionModel> model);

  const Packing& packing() const { return model->packing(); }
  bool hasSurface() const { return !packing().surface.triangles.empty(); }
  /// Returns the first `count` spheres, from 1 to all of them. It stays valid as long as this object.
  const Prefix& prefix(std::size_t count) const;
  /// Returns the shortest of 64, 128, 256, ... spheres, fewer than `most`, that are nowhere further than
  /// `gap` [m] from the surface; `most` if there is none, or no surface.
  const Prefix& prefixWithin(btScalar gap, const Prefix& most) const;
  /// Returns the searches on the surface, in the packing's frame. Call it only if hasSurface().
  const SurfaceQueries& surfaceQueries() const {
    return surface_queries_.get([this] { return std::make_unique<SurfaceQueries>(packing().surface); });
  }
  /// Returns the triangle that is nearest to the centre of a sphere. Call it only if hasSurface().
  std::size_t triangleNear(std::size_t sphere) const;
  const VertexHillClimb& vertexHillClimb() const;
  /// Returns how far the solid reaches, in its principal frame.
  const SupportBounds& bounds() const;
  /// Tells what has been built so far.
  struct Built {
    bool sphere_bvh, surface_queries, vertex_hill_climb;
  };
  Built built() const;

  const std::shared_ptr<const CollisionModel> model;
  const PrincipalFrame principal;
  const ShapeFrame in_principal;  ///< for shapes in that frame: most

 private:
  mutable std::mutex mutex_;
  mutable std::map<std::size_t, Prefix> prefixes_;
  Lazy<SurfaceQueries> surface_queries_;
  /// Holds the nearest triangle of each sphere, plus one; 0 until it is asked for.
  using Triangles = std::unique_ptr<std::atomic<std::uint32_t>[]>;
  Lazy<Triangles> triangles_near_;
  Lazy<VertexHillClimb> vertex_hill_climb_;
  Lazy<SupportBounds> bounds_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
