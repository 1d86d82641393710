// Turns the triangles of a Bullet program into a model for PackingShape. A program that calls modelFrom() has
// to link InnerSphere::packer, which the plug-in itself does not need.
#pragma once

#include <memory>
#include <string>

#include <BulletCollision/CollisionShapes/btStridingMeshInterface.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/collision_model.hpp"
#include "innersphere/pack_mesh.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Returns the triangles of all sub-parts as one mesh [m], scaled by getScaling(). Vertices may be PHY_FLOAT
/// or PHY_DOUBLE, indices PHY_INTEGER, PHY_SHORT or PHY_UCHAR, which are unsigned, as everywhere in Bullet.
/// Throws Error bad_argument for another type, a sub-part without arrays, or an index beyond its number of
/// vertices.
Mesh meshFrom(const btStridingMeshInterface& triangles);

/// Packs the triangles and returns the model, or reads what an earlier start of the program has packed, if
/// options.cache_folder is set: see packMesh(). The frame of the model is that of the triangles; see
/// PackingShape for what that means for bodies. Where a body was scaled before, scale either the triangles,
/// on each axis as you like, or, by one factor, the shape. Throws what meshFrom() and packMesh() throw.
///
///     innersphere::PackMeshOptions options;
///     options.cache_folder = innersphere::defaultCacheFolder();
///     innersphere::PackingShape shape(innersphere::modelFrom(triangles, "bunny", options));
inline std::shared_ptr<const CollisionModel> modelFrom(const btStridingMeshInterface& triangles,
                                                       const std::string& name,
                                                       const PackMeshOptions& options = {},
                                                       const Progress& progress = {}) {
  return std::make_shared<const CollisionModel>(
      std::make_shared<const Packing>(packMesh(meshFrom(triangles), name, options, progress)));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
